"""Scenario files read as tables, each on top of its base, and which file every key stands in."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from cosim.errors import InputError
from cosim.scenario.errors import ScenarioError, short

LARGEST = 1_000_000  #: bytes of a text file that is read
DEEPEST = 20  #: files in a chain of bases


@dataclass(frozen=True)
class ReadFile:
    """Text and tables of a file and its bases."""

    text: str  #: of the base first, as written
    table: dict[str, Any]
    files: dict[str, str] = field(default_factory=dict)  #: which file has which key, ``a.b``


def read_toml(file: Path, wrong: type[InputError]) -> tuple[str, dict[str, Any]]:
    """Text and tables of one TOML file in UTF-8, also with a byte order mark; else ``wrong`` with one line."""
    try:
        data = file.read_bytes()
    except OSError as error:
        raise wrong(f"{file}: cannot be read: {error.strerror}; check the path and its permissions") from None
    if len(data) > LARGEST:
        raise wrong(f"{file}: {len(data) / 1e6:.1f} MB is no scenario or reference; give a text file below 1 MB")
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise wrong(f"{file}: not in UTF-8 ({_encoding(data, error)}); save it as UTF-8") from None
    return text, parse_toml(text, str(file), wrong)


def is_file(path: Path) -> bool:
    """Whether there is such a file; also of names that no file can have."""
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False


def parse_toml(text: str, origin: str, wrong: type[InputError]) -> dict[str, Any]:
    """Tables of a text; what the parser cannot take, too deep a nesting included, is one line."""
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise wrong(f"{origin}: not valid TOML: {error}; correct that line") from None
    except (RecursionError, ValueError) as error:
        what = "nested too deeply" if isinstance(error, RecursionError) else str(error)
        raise wrong(f"{origin}: not valid TOML: {what}; correct it") from None


def _encoding(data: bytes, error: UnicodeDecodeError) -> str:
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return "it looks like UTF-16"
    line = data[: error.start].count(b"\n") + 1
    return f"byte 0x{data[error.start]:02x} in line {line}"


def read_file(file: Path, inner: tuple[Path, ...] = ()) -> ReadFile:
    """A file on top of its ``base``, a path beside it: for what cases have in common."""
    if file.resolve() in inner:
        raise ScenarioError(f"{file}: is its own base; leave the key base out of one of the files")
    if len(inner) >= DEEPEST:
        raise ScenarioError(f"{file}: is the base of a base of a base, {DEEPEST} times; put them together")
    text, raw = read_toml(file, ScenarioError)
    base = raw.pop("base", None)
    own = dict.fromkeys(_leaves(raw), str(file))
    if base is None:
        return ReadFile(text, raw, own)
    under = file.parent / base if isinstance(base, str) else file.parent
    if not is_file(under):
        raise ScenarioError(f"{file}: base = {short(base)} is no file; give a path from the folder of this file")
    common = read_file(under, (*inner, file.resolve()))
    return ReadFile(
        f"{common.text}\n# ---- {file.name} ----\n{text}", _merged(common.table, raw), {**common.files, **own}
    )


def _leaves(table: dict[str, Any], prefix: str = "") -> Iterator[str]:
    """Names of all values, with their sections; of an empty section its own."""
    for key, value in table.items():
        if isinstance(value, dict) and value:
            yield from _leaves(value, f"{prefix}{key}.")
        else:
            yield prefix + key


def _merged(under: dict[str, Any], over: dict[str, Any]) -> dict[str, Any]:
    """Tables of ``under`` with the keys of ``over`` in their place."""
    out = dict(under)
    for key, value in over.items():
        old = out.get(key)
        out[key] = _merged(old, value) if isinstance(old, dict) and isinstance(value, dict) else value
    return out
