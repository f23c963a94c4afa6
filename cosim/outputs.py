"""Files that commands write: none destroys another, and each appears whole or not at all.

* A file is replaced by one of its own kind only, which is told from its first bytes: no input, whichever it is and
  however it is named, is written over.
* What was simulated (recordings, tables of a sweep) grows at its place and is kept; a recording unless the user says
  ``--force``.
* What can be drawn again (pages, pictures) is written under another name and then renamed.
* A log is appended to, if it is one; a recording is gone on with by the run that wrote it, `cosim resume`.
* A file that is being written is locked: a second writer is refused.
"""

from __future__ import annotations

import os
import stat
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO, Any

from cosim.errors import FailedError, InputError

fcntl: Any
try:
    import fcntl
except ImportError:  # Windows: a file that exists is refused there, two writers with --force are not told apart
    fcntl = None

ASLEEP = 60.0  #: where files are not locked: time without a window after which a run counts as gone [s]
#: how a file of a kind begins
MAGIC = {
    ".mcap": b"\x89MCAP0\r\n",
    ".rrd": b"RRF2",
    ".png": b"\x89PNG",
    ".html": b"<!doctype html",
    ".csv": b"variant,",
    ".parquet": b"PAR1",
    ".rows": b"# cosim rows",
    ".checkpoint": b"# cosim checkpoint\n",
    ".ice": b'"x","y","what"',
    ".table.csv": b"time [s],",
    ".nc": b"\x89HDF\r\n\x1a\n",
    ".pvd": b"<?xml",
    ".dat": b"# Brash",
    ".mp4": b"\0\0\0",
    ".log": b"# cosim log",
    ".fmu": b"PK\x03\x04",
    ".md": b"# Evidence of brash",
    ".bench.md": b"# Benchmarks of brash",
    ".json": b'{\n  "evidence"',
    ".pieces": b'{\n "format": "brash pieces',
}
#: kinds that hold what was simulated, and what a user may do about one that exists
GROWS = {
    ".mcap": "name another file, or give --force to write over it",
    ".csv": "name another file, or remove it",
    ".parquet": "name another file, or, for the table of a sweep that is to go on, give --resume",
}


def writable(path: Path, kind: str, inputs: Iterable[Path] = (), force: bool = False) -> Path:
    """Refuse a place that must not or cannot be written, before hours are simulated; ``kind`` is one of `MAGIC`."""
    if path.is_dir():
        raise InputError(f"{path}: is a folder; name a file in it")
    target = resolved(path)
    if not target.parent.is_dir():
        raise InputError(f"{path}: no such folder {target.parent}; create it or write elsewhere")
    if target.exists():
        for source in inputs:
            if source.exists() and target.samefile(source):
                raise InputError(f"{path}: does not overwrite its source {source}; name another file")
        if _is_regular(target):
            _replaceable(path, target, kind, force)
    if not os.access(target if target.exists() else target.parent, os.W_OK):
        raise InputError(f"{path}: no permission to write there; write elsewhere")
    return path


def resolved(path: Path) -> Path:
    """The file that is meant, behind links."""
    try:
        return path.resolve()
    except (OSError, RuntimeError) as error:
        raise InputError(f"{path}: {error}; name another file") from None


def _is_regular(target: Path) -> bool:
    return stat.S_ISREG(target.stat().st_mode)


def _replaceable(path: Path, target: Path, kind: str, force: bool) -> None:
    with target.open("rb") as file:
        begins = file.read(len(MAGIC[kind]))
    if begins and begins != MAGIC[kind]:
        raise InputError(f"{path}: exists and is no {kind} file, it is not written over; name another file")
    if kind in GROWS and not force:
        raise InputError(f"{path}: exists and is kept; {GROWS[kind]}")


def trouble(path: Path, error: OSError) -> FailedError:
    """The line for a file that cannot be written to its end."""
    return FailedError(f"{path}: {error.strerror or error}; free space or write elsewhere")


@contextmanager
def whole(path: Path, kind: str) -> Iterator[Path]:
    """A name to write to; what was written there takes the place of ``path`` at the end, unless something goes wrong.

    FailedError names the file if it cannot be written, InputError if another program is writing it.
    """
    target = resolved(path)
    if target.exists() and not _is_regular(target):  # a device or a pipe is written at its place
        try:
            yield path
        except OSError as error:
            raise trouble(path, error) from error
        return
    part = target.with_name(f".{target.stem}.part{kind}")
    try:
        lock = _locked(part, path)
        try:
            yield part
            os.fsync(lock)
            os.replace(part, target)
        finally:
            part.unlink(missing_ok=True)
            os.close(lock)
    except OSError as error:
        raise trouble(path, error) from error


def grow(path: Path, kind: str, force: bool = False, inputs: Iterable[Path] = ()) -> IO[bytes]:
    """Open a file that grows at its place, locked until it is closed; nothing is in it."""
    writable(path, kind, inputs, force)
    target = resolved(path)
    try:
        if target.exists() and not _is_regular(target):
            return target.open("wb")
        number = _locked(target, path)
        os.ftruncate(number, 0)
        return os.fdopen(number, "wb")
    except OSError as error:
        raise trouble(path, error) from error


def reopen(path: Path, kind: str) -> IO[bytes]:
    """Open a file that `grow` has opened once, to read and to write from its beginning, locked until it is closed."""
    writable(path, kind, force=True)
    try:
        return os.fdopen(_locked(resolved(path), path), "r+b")
    except OSError as error:
        raise trouble(path, error) from error


def append(path: Path, kind: str) -> IO[bytes]:
    """Open a file of lines at its end, locked and unbuffered until it is closed; a new one begins with its kind."""
    writable(path, kind)
    target = resolved(path)
    try:
        if target.exists() and not _is_regular(target):
            return target.open("wb", buffering=0)
        file = os.fdopen(_locked(target, path), "ab", buffering=0)
        if file.seek(0, os.SEEK_END) == 0:
            file.write(MAGIC[kind] + b"\n")
        return file
    except OSError as error:
        raise trouble(path, error) from error


def is_growing(path: Path) -> bool:
    """Whether somebody is writing a file that `grow` or `reopen` has opened."""
    if fcntl is None:
        return time.time() - path.stat().st_mtime < ASLEEP
    with path.open("rb") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
        except BlockingIOError:
            return True
    return False


def drop(path: Path) -> None:
    """Take a file away that `grow` has opened and that holds nothing; a device stays."""
    target = resolved(path)
    if _is_regular(target):
        target.unlink()


def rewrite(file: IO[bytes], content: bytes) -> None:
    """Put content in place of what a file holds that `grow` has opened, in one go."""
    if file.seekable():
        file.seek(0)
    file.write(content)
    file.flush()
    if file.seekable():
        file.truncate()


def _locked(file: Path, name: Path) -> int:
    """Descriptor of a file that nobody else is writing; InputError if somebody is."""
    while True:
        number = os.open(file, os.O_RDWR | os.O_CREAT | getattr(os, "O_BINARY", 0), 0o666)
        try:
            if fcntl is not None:
                fcntl.flock(number, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            os.close(number)
            raise InputError(f"{name}: is being written by another program; wait for it or name another file") from None
        with suppress(FileNotFoundError):  # renamed between the two lines above: try the new one
            if os.fstat(number).st_ino == file.stat().st_ino:
                return number
        os.close(number)
