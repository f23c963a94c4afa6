"""Cells of a text table: lines into fields, fields into numbers."""

from __future__ import annotations

import csv
import re
from dataclasses import dataclass
from functools import cache

import numpy as np

from coupling.interface import Array

#: what stands for no value, without regard to case
MISSING = frozenset(
    ("", "nan", "na", "n/a", "#n/a", "#nv", "null", "none", "-", "--", "inf", "-inf", "+inf", "-nan", "1.#qnan", "---")
)
_DATE = r"\d{4}[-/.]\d{1,2}[-/.]\d{1,2}|\d{1,2}[-/.]\d{1,2}[-/.]\d{2,4}"
_CLOCK = r"\d{1,2}:\d{2}(?::\d{2}(?:[.,]\d+)?)?(?:\s?[AaPp][Mm])?(?:Z|[+-]\d{2}:?\d{2})?"
CLOCK = re.compile(_CLOCK)
DATE = re.compile(_DATE)
STAMP = re.compile(rf"(?:{_DATE})(?:[ T]\s*{_CLOCK})?|{_CLOCK}")


@dataclass(frozen=True)
class Dialect:
    """How fields are told apart and numbers are written."""

    delimiter: str  #: a character; a blank stands for any white space
    decimal: str
    thousands: str | None = None

    def fields(self, line: str) -> list[str]:
        """Fields of a line, without blanks and quotes around them."""
        if self.delimiter == " ":
            return [part.strip('"') for part in line.split()]
        parts = next(csv.reader([line], delimiter=self.delimiter)) if '"' in line else line.split(self.delimiter)
        return [part.strip() for part in parts]

    def is_number(self, cell: str) -> bool:
        """Whether a cell is one number."""
        return _number(self.decimal, self.thousands).fullmatch(cell) is not None

    def number(self, cell: str) -> float:
        """A cell as number; nan for none, and for what is no number."""
        if not self.is_number(cell):
            return float("nan")
        if self.thousands:
            cell = cell.replace(self.thousands, "")
        return float(cell.replace("\u2212", "-").replace(self.decimal, ".").translate(_EXPONENT))

    def numbers(self, cells: list[str]) -> Array:
        """(n,) numbers, nan where there is none."""
        letters = set().union(*cells)
        if self.thousands or not letters <= set("0123456789+-eE" + self.decimal):
            return np.array([self.number(cell) for cell in cells])
        try:  # a column of plain numbers, quickly
            return np.array([cell.replace(self.decimal, ".") for cell in cells], dtype=float)
        except ValueError:
            return np.array([self.number(cell) for cell in cells])


_EXPONENT = str.maketrans("dD", "ee")


@cache
def _number(decimal: str, thousands: str | None) -> re.Pattern[str]:
    whole = r"\d+" if thousands is None else rf"(?:\d{{1,3}}(?:{re.escape(thousands)}\d{{3}})+|\d+)"
    point = re.escape(decimal)
    return re.compile(rf"[-+\u2212]?(?:{whole}(?:{point}\d*)?|{point}\d+)(?:[eEdD][-+]?\d{{1,3}})?")


def is_missing(cell: str) -> bool:
    """Whether a cell says that there is no value."""
    return cell.lower() in MISSING
