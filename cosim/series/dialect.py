"""Delimiter and decimal point of a text, found from its rows of numbers and told; what is open is asked for.

A delimiter is not found without the decimal point, ``1,5;2,5`` is one thing and ``1.5,2.5`` another: the pair is taken
that reads the most lines as rows of numbers and stamps of one width. Two that read the same lines to different widths
are an error and no guess.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime
from itertools import product

from cosim.series.cells import STAMP, Dialect, is_missing
from cosim.series.description import Text, TimeColumn
from cosim.series.told import Told

DELIMITERS = ("\t", ";", ",", "|", " ")
NAMES = {"\t": "tab", " ": "white space", ";": "semicolon", ",": "comma", "|": "|"}
SAMPLE = 200  #: lines at the beginning, and as many in the middle


@dataclass(frozen=True)
class Found:
    """A dialect and the rows of numbers that it reads in the sample."""

    dialect: Dialect
    width: int  #: fields of a row
    rows: int


def row_like(dialect: Dialect, time: TimeColumn) -> Callable[[list[str]], bool]:
    """Whether fields are numbers, stamps and missing values, with at least one number."""

    def is_row(fields: list[str]) -> bool:
        numbers = [dialect.is_number(cell) for cell in fields]
        return any(numbers) and all(
            number or is_missing(cell) or _is_stamp(cell, time.format)
            for cell, number in zip(fields, numbers, strict=True)
        )

    return is_row


def _is_stamp(cell: str, form: str | None) -> bool:
    if form is None:
        return STAMP.fullmatch(cell) is not None
    try:
        datetime.strptime(cell, form)
    except ValueError:
        return False
    return True


def find(lines: list[str], given: Text, time: TimeColumn, told: Told) -> Found:
    """Dialect of the lines; a row has a time and a load, or a load alone where the time has a step."""
    least = 2 if time.step is None else 1
    sample = [line for line in lines[:SAMPLE] + lines[len(lines) // 2 :][:SAMPLE] if line.strip()]
    delimiters = (_delimiter(given.delimiter, told),) if given.delimiter else DELIMITERS
    decimals = (given.decimal,) if given.decimal else (".", ",")
    found = [
        look
        for delimiter, decimal in product(delimiters, decimals)
        if delimiter != given.thousands and decimal != given.thousands
        for look in _looked(sample, Dialect(delimiter, decimal, given.thousands), time, least)
    ]
    if not found:
        raise told.wrong(_no_rows(sample, least))
    best = max(found, key=lambda look: look.rows)
    for other in found:
        if other.rows == best.rows and other.width != best.width:
            a, b = (
                f"{NAMES.get(d, d)} ({w} columns)"
                for d, w in ((best.dialect.delimiter, best.width), (other.dialect.delimiter, other.width))
            )
            raise told.wrong(f"can be read with {a} or {b}; set text.delimiter and text.decimal")
    if not given.delimiter or not given.decimal:
        d = best.dialect
        between = NAMES.get(d.delimiter, d.delimiter) if best.width > 1 else "nothing"
        point = NAMES.get(d.decimal, "point")
        told.say(f"read with {between} between fields and decimal {point}")
    return best


def _looked(sample: list[str], dialect: Dialect, time: TimeColumn, least: int) -> list[Found]:
    is_row = row_like(dialect, time)
    rows = [fields for fields in map(dialect.fields, sample) if len(fields) >= least and is_row(fields)]
    if not rows:
        return []
    width, count = Counter(map(len, rows)).most_common(1)[0]
    return [Found(dialect, width, count)]


def _delimiter(name: str, told: Told) -> str:
    known = {"space": " ", "tab": "\t", "\\t": "\t"}
    delimiter = known.get(name, name)
    if len(delimiter) != 1:
        raise told.wrong(f'text.delimiter = {name!r}: give one character, "tab" or "space"')
    return delimiter


def _no_rows(sample: list[str], least: int) -> str:
    grouped = next((line for line in sample if _is_grouped(line)), None)
    if grouped is not None:
        return f"digits are grouped in {grouped.strip()[:60]!r}; set text.thousands and text.decimal"
    last = sample[-1].strip()[:60] if sample else ""
    return f"no row with at least {least} numbers, {last!r} is none; give a table of numbers, with times or time.step"


def _is_grouped(line: str) -> bool:
    """Whether a line is a row once grouped digits are allowed."""
    return any(
        len(dialect.fields(line)) > 1 and row_like(dialect, TimeColumn.model_validate({}))(dialect.fields(line))
        for delimiter in ("\t", ";", "|", ",")
        for decimal, thousands in ((",", "."), (".", ","), (".", "'"), (",", " "))
        if delimiter != decimal
        for dialect in (Dialect(delimiter, decimal, thousands),)
    )
