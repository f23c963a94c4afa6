"""What tests of several folders share."""

import pytest

from cosim.cli import main


@pytest.fixture
def cosim(capsys):
    """cosim(*arguments) -> (exit code, stdout, stderr)"""

    def call(*arguments):
        with pytest.raises(SystemExit) as stop:
            main([str(a) for a in arguments])
        out = capsys.readouterr()
        return stop.value.code, out.out, out.err

    return call
