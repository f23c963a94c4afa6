"""Errors with one line for people. The command line turns them into exit codes; nothing else exits."""

from __future__ import annotations


class InputError(ValueError):
    """Bad input (exit 2): the message names what is wrong, which value, and what to do."""


class FailedError(RuntimeError):
    """Good input, but it did not work (exit 1): the message says what to do."""


def explain(error: Exception) -> tuple[str, int]:
    """The line and the exit code of an error; an unexpected one is named as such."""
    from coupling.interface import SimulationError  # numpy comes with it: not for `--help`

    if isinstance(error, InputError):
        return str(error), 2
    if isinstance(error, FailedError | SimulationError):
        return str(error), 1
    if hasattr(error, "format_message"):  # the argument parser's own
        return f"{error.format_message()} (`cosim --help` shows the commands)", 2
    if isinstance(error, OSError) and error.filename:
        return f"{error.filename}: {error.strerror}; check the path", 2
    if isinstance(error, OSError):  # files are named by whoever writes them
        return f"standard output: {error.strerror or error}; what it leads to takes no more", 1
    return f"unexpected {type(error).__name__}: {error}; set COSIM_TRACEBACK=1 to see where, and report it", 1
