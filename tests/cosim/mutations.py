"""Recordings damaged by chance, and what must hold for each of them."""

from __future__ import annotations

import contextlib
import io
import json
import random
from pathlib import Path
from typing import Any

import numpy as np

from cosim.cli import main
from cosim.errors import InputError
from cosim.recording.reader import read_run

FOREIGN = (b"", b"\x89MCAP0\r\n", b"\x89PNG\r\n\x1a\n" + bytes(99), b"PK\x03\x04" + bytes(99), b"hello", bytes(4096))


def flip(data: bytearray, chance: random.Random) -> None:
    """One bit."""
    data[chance.randrange(len(data))] ^= 1 << chance.randrange(8)


def flip_some(data: bytearray, chance: random.Random) -> None:
    """A few bits near each other."""
    at = chance.randrange(len(data))
    for _ in range(chance.randint(2, 8)):
        data[min(at + chance.randrange(16), len(data) - 1)] ^= 1 << chance.randrange(8)


def truncate(data: bytearray, chance: random.Random) -> None:
    """The end is missing."""
    del data[chance.randrange(len(data)) :]


def truncate_and_flip(data: bytearray, chance: random.Random) -> None:
    """The end is missing, and a bit is wrong."""
    del data[chance.randrange(1, len(data)) :]
    flip(data, chance)


def remove(data: bytearray, chance: random.Random) -> None:
    """A piece is missing."""
    at = chance.randrange(len(data))
    del data[at : at + chance.randint(1, 400)]


def repeat(data: bytearray, chance: random.Random) -> None:
    """A piece stands there twice."""
    at = chance.randrange(len(data))
    data[at:at] = data[at : at + chance.randint(1, 400)]


def insert(data: bytearray, chance: random.Random) -> None:
    """Bytes of something else."""
    at = chance.randrange(len(data) + 1)
    data[at:at] = chance.randbytes(chance.randint(1, 60))


def overwrite(data: bytearray, chance: random.Random) -> None:
    """Bytes of something else in place of some."""
    at = chance.randrange(len(data))
    end = min(at + chance.randint(1, 60), len(data))
    data[at:end] = chance.randbytes(end - at)


def large_number(data: bytearray, chance: random.Random) -> None:
    """A length, a stamp or a value becomes as large as can be."""
    at = chance.randrange(max(len(data) - 8, 1))
    data[at : at + 8] = chance.choice((b"\xff" * 8, b"\xff" * 7 + b"\x7f", bytes(8), (2**31).to_bytes(8, "little")))


def foreign(data: bytearray, chance: random.Random) -> None:
    """Something else altogether, perhaps with a recording behind it."""
    data[: chance.choice((0, len(data)))] = chance.choice(FOREIGN) + chance.randbytes(chance.randrange(300))


MUTATIONS = (
    flip,
    flip_some,
    truncate,
    truncate_and_flip,
    remove,
    repeat,
    insert,
    overwrite,
    large_number,
    foreign,
)


def call(*arguments: Any) -> tuple[int, str, str]:
    """Exit code, standard output and error of a command."""
    out, err, code = io.StringIO(), io.StringIO(), 0
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            main([str(a) for a in arguments])
        except SystemExit as stop:
            code = stop.code
    return code, out.getvalue(), err.getvalue()


def check(path: Path, whole: Any, command: tuple[Any, ...]) -> None:
    """A command answers a damaged file with one line, or with what the whole one says up to some time."""
    before = path.read_bytes()
    code, out, err = call(*command)
    assert path.read_bytes() == before
    assert "Traceback" not in out + err
    assert "cosim: unexpected" not in err, err
    assert err.count("\n") <= 1, err
    assert code in (0, 2), err
    if code:
        assert err.startswith("cosim: "), err
        assert out == ""
    try:
        run = read_run(path)
    except InputError:
        assert code == 2 or command[0] == "recover"
        return
    n = len(run.t_ns)
    assert np.array_equal(run.load, whole.load[:n])
    assert np.array_equal(run.t_ns, whole.t_ns[:n])
    assert run.metadata == whole.metadata
    assert run.texts == whole.texts
    assert run.events == whole.events[: len(run.events)]
    assert (run.remark == "") == (before == whole.bytes)
    if "--json" in command and code == 0:
        assert json.loads(out).get("remark") == (run.remark or None)
