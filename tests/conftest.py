"""What tests of several folders share."""

import os

import pytest

from cosim.cli import main

LONGEST = 600  #: a test of the ordinary suite [s]
#: before numpy is loaded, for workers and what tests start too: threads of linear algebra wait for each other's turn
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
#: commands of tests compile kernels as they come to them; for the whole suite that is done before
os.environ.setdefault("COSIM_COMPILE_AHEAD", "0")


@pytest.hookimpl(tryfirst=True)
def pytest_sessionstart(session):
    """Kernels are compiled side by side before the workers of the whole suite start, which would all compile them."""
    config = session.config
    whole = config.args_source is pytest.Config.ArgsSource.TESTPATHS
    if not whole or hasattr(config, "workerinput") or not getattr(config.option, "numprocesses", 0):
        return
    from cosim.warming import PARTS, compile_parts, missing

    if parts := missing(list(PARTS)):
        compile_parts(parts, os.cpu_count() or 1, lambda part: print("compiled", *part, flush=True))


def pytest_collection_modifyitems(items):
    """A test that hangs fails and shows where, instead of holding up the whole suite."""
    for item in items:
        if item.get_closest_marker("slow") is None:
            item.add_marker(pytest.mark.timeout(LONGEST))


@pytest.fixture
def cosim(capsys):
    """cosim(*arguments) -> (exit code, stdout, stderr)"""

    def call(*arguments):
        with pytest.raises(SystemExit) as stop:
            main([str(a) for a in arguments])
        out = capsys.readouterr()
        return stop.value.code, out.out, out.err

    return call
