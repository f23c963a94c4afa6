"""Bytes of a file as text: byte order marks, UTF-16 without one, older encodings. What was found is told."""

from __future__ import annotations

import codecs
from pathlib import Path

from charset_normalizer import from_bytes

from cosim.series.told import SeriesError, Told

LARGEST = 2_000_000_000  #: bytes of a file that is read
SAMPLE = 200_000  #: bytes by which an encoding is found
#: byte order marks, the longer ones first
MARKS = (
    (codecs.BOM_UTF32_LE, "utf-32"),
    (codecs.BOM_UTF32_BE, "utf-32"),
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)
#: first bytes of files that are no text: what they are
BINARY = {
    b"PK\x03\x04": "a spreadsheet or archive (zip)",
    b"\xd0\xcf\x11\xe0": "an old spreadsheet (.xls)",
    b"\x1f\x8b": "compressed (gzip)",
    b"TDSm": "a TDMS file",
    b"\x89HDF": "an HDF5 file",
    b"MATLAB": "a MATLAB file",
    b"\x89MCAP": "a recording",
    b"PAR1": "a Parquet file",
}


def read_bytes(path: Path) -> bytes:
    """Content of a file of sensible size."""
    try:
        size = path.stat().st_size
        if path.is_dir():
            raise SeriesError(f"{path}: is a folder; name the file in it")
        if size > LARGEST:
            raise SeriesError(f"{path}: has {size / 1e9:.1f} GB; give a file below {LARGEST / 1e9:g} GB")
        return path.read_bytes()
    except OSError as error:
        raise SeriesError(f"{path}: cannot be read: {error.strerror}; check the path") from None


def text_of(data: bytes, encoding: str | None, told: Told) -> str:
    """The text, without its byte order mark."""
    if not data.strip():
        raise told.wrong("is empty; give a file with a series")
    for mark, what in BINARY.items():
        if data.startswith(mark):
            raise told.wrong(f"is {what} and no text; export the series as CSV or Parquet")
    if encoding is None:
        encoding = _encoding(data, told)
    try:
        text = data.decode(encoding).removeprefix("\ufeff")
    except LookupError:
        raise told.wrong(f"text.encoding = {encoding!r} is not known; use for example utf-8, utf-16, cp1252") from None
    except UnicodeError as error:
        raise told.wrong(f"cannot be read as {encoding}: {error}; set text.encoding") from None
    if "\0" in text:
        raise told.wrong("holds NUL characters and is no text; export the series as CSV or Parquet")
    return text


def _encoding(data: bytes, told: Told) -> str:
    for mark, name in MARKS:
        if data.startswith(mark):
            told.say(f"encoding: {name.removesuffix('-sig').upper()}, by its byte order mark")
            return name
    sample = data[:SAMPLE]
    for offset, name in ((1, "utf-16-le"), (0, "utf-16-be")):
        if sample[offset::2].count(0) > 0.4 * len(sample[offset::2]) and not sample[1 - offset :: 2].count(0):
            told.say(f"encoding: {name.upper()}, by every other byte being zero")
            return name
    try:
        data.decode("utf-8")
    except UnicodeDecodeError:
        found = None if b"\0" in data else from_bytes(sample).best()
        if found is None:
            raise told.wrong("is no text in a known encoding; set text.encoding, or export as CSV in UTF-8") from None
        told.say(f"encoding: not UTF-8; taken as {found.encoding} by its characters (text.encoding says otherwise)")
        return str(found.encoding)
    return "utf-8"
