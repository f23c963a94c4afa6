"""Errors with one line for people. The command line turns them into exit codes; nothing else exits."""

from __future__ import annotations


class InputError(ValueError):
    """Bad input (exit 2): the message names what is wrong, which value, and what to do."""


class FailedError(RuntimeError):
    """Good input, but it did not work (exit 1): the message says what to do."""
