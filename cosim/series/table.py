"""A file as named columns: the head with titles, names and units, and the rows under it."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from cosim.scenario.units import Unit, si_of, to_si
from cosim.series.cells import Dialect, is_missing
from cosim.series.description import Description
from cosim.series.dialect import find, row_like
from cosim.series.told import Told, count
from coupling.interface import Array

REMARKS = ("#", "%", "//", "!")
MOST_ABOVE = 2  #: rows of numbers above the names
MOST_LOST = 0.2  #: share of the rows that may be left out
_NAMED = re.compile(r"(.*?)\s*(?:\[\s*([^\]]*?)\s*\]|\(\s*([^)]*?)\s*\)|\s/\s*(\S+)|\bin\s+(\S+))")


@dataclass(frozen=True)
class Column:
    """One column as it stands in the file."""

    name: str
    unit: str | None  #: that the file says
    cells: list[str] | Array  #: texts, numbers, or stamps as datetime64


@dataclass(frozen=True)
class Table:
    """All columns, of one length."""

    columns: tuple[Column, ...]
    dialect: Dialect

    def numbers(self, column: Column) -> Array:
        """(n,) values of a column; nan for none."""
        cells = column.cells
        return self.dialect.numbers(cells) if isinstance(cells, list) else np.asarray(cells, dtype=float)


def read_text(text: str, description: Description, told: Told) -> Table:
    """Table of a text. Lines that are no rows are left out and told; too many of them are an error."""
    lines, given = text.splitlines(), description.text
    if lines and (match := re.fullmatch(r'"?sep=(.)"?', lines[0].strip())):
        told.say(f"line 1 names the delimiter {match[1]!r} for a spreadsheet")
        given = given if given.delimiter else given.model_copy(update={"delimiter": match[1]})
        lines[0] = ""
    marks = (given.comment,) if given.comment else REMARKS
    remark = [line.lstrip().startswith(marks) for line in lines]
    found = find([line for line, r in zip(lines, remark, strict=True) if not r], given, description.time, told)
    dialect, width = found.dialect, found.width
    rows = [[] if r else dialect.fields(line) for line, r in zip(lines, remark, strict=True)]
    first = _first(rows, width, row_like(dialect, description.time), told)
    names, units = _head(lines[:first], dialect, width, marks, told)
    kept = _kept(rows, remark, first, width, told)
    columns = []
    for k in range(width):
        cells = [row[k] for row in kept]
        if not names[k] and k == width - 1 and all(is_missing(cell) for cell in cells):
            told.say("the last column is empty, its delimiter ends the lines: left out")
            continue
        columns.append(Column(names[k] or f"column {k + 1}", units[k], cells))
    return Table(tuple(columns), dialect)


def _first(rows: list[list[str]], width: int, is_row: Callable[[list[str]], bool], told: Told) -> int:
    """Line of the first row: it and the next two that are not empty are rows of this width."""
    at = [k for k, row in enumerate(rows) if any(row)]
    good = [len(rows[k]) == width and is_row(rows[k]) for k in at]
    first = next((i for i in range(len(at)) if all(good[i : i + 3])), good.index(True))
    if sum(good[:first]) > MOST_ABOVE:
        line = at[good.index(False, good.index(True))] + 1
        raise told.wrong(
            f"lines with and without {width} numbers alternate, the first without is line {line}; correct it"
        )
    return at[first]


def _kept(rows: list[list[str]], remark: list[bool], first: int, width: int, told: Told) -> list[list[str]]:
    """Rows of the right width; the others are told."""
    kept, odd, remarks = [], [], 0
    for k in range(first, len(rows)):
        row = rows[k]
        if len(row) == width and any(row):
            kept.append(row)
        elif remark[k]:
            remarks += 1
        elif any(row):
            odd.append((k + 1, len(row)))
    if remarks:
        told.say(f"{count(remarks, 'remark')} among the rows: passed over")
    if odd:
        text = f"{count(len(odd), 'line')} without {width} fields, the first is line {odd[0][0]} with {odd[0][1]}"
        if len(odd) > MOST_LOST * (len(kept) + len(odd)):
            raise told.wrong(f"{text}; correct the file, or set text.delimiter")
        told.say(f"{text}: left out")
    return kept


def _head(
    lines: list[str], dialect: Dialect, width: int, marks: tuple[str, ...], told: Told
) -> tuple[list[str], list[str | None]]:
    """Names and units of the columns from the lines above the rows; empty where there are none."""
    bare = [(line.lstrip().lstrip("".join(marks)), line) for line in lines if line.strip()]
    heads = [(fields, line) for text, line in bare if len(fields := _padded(dialect.fields(text), width)) == width]
    if not heads:
        told.say(f"no names above the {width} columns: they go by number")
        if any(len(dialect.fields(text)) > 1 and not line.lstrip().startswith(marks) for text, line in bare[-1:]):
            names_there = len(dialect.fields(bare[-1][0]))
            raise told.wrong(f"{names_there} names stand over {width} columns; set text.delimiter and text.decimal")
        return [""] * width, [None] * width
    units: list[str | None] = [None] * width
    names = heads[-1][0]
    if all(_as_unit(cell) is not None or is_missing(_bare(cell)) for cell in names) and len(heads) > 1:
        units = [_as_unit(cell) for cell in names]
        names = heads[-2][0]
        told.say("units stand in a row of their own under the names")
    extra = len(bare) - 1 - any(unit is not None for unit in units)
    if extra > 0:
        told.say(f"{count(extra, 'line')} above the names: passed over")
    split = [_name_and_unit(name) for name in names]
    return [name for name, _ in split], [unit or own for unit, (_, own) in zip(units, split, strict=True)]


def _padded(fields: list[str], width: int) -> list[str]:
    """Names without that of an empty last column."""
    return [*fields, ""] if len(fields) == width - 1 and width > 2 else fields


def _name_and_unit(name: str) -> tuple[str, str | None]:
    found = _NAMED.fullmatch(name)
    unit = _as_unit(next(filter(None, found.groups()[1:]), "")) if found else None
    return (found[1].strip(), unit) if found and unit else (name, None)


def _bare(cell: str) -> str:
    return cell.strip("[]() \t")


def _as_unit(cell: str) -> str | None:
    """A cell as unit of a time or a force; None if it is none."""
    text = _bare(cell)
    try:
        si_of(f"1 {text}")
    except Exception:  # whatever the registry has against it
        return None
    return text


def factor(text: str, si: str, where: str, told: Told) -> float:
    """How many SI units a unit has."""
    try:
        return to_si(f"1 {_bare(text)}", Unit(si, f"1 {si}"))
    except ValueError:
        raise told.wrong(
            f"{where}: {text!r} is no unit of {'time' if si == 's' else 'force'}; set {where}.unit"
        ) from None
