"""Which column is meant: by name or number, or the one whose name says so. Two of them are refused."""

from __future__ import annotations

import re

from cosim.nearest import hint
from cosim.series.table import Column, Table
from cosim.series.told import Told


def pick(table: Table, wanted: str | int | None, usual: re.Pattern[str], what: str, told: Told) -> Column:
    """The column of a quantity; without a wish the only one with a usual name."""
    columns = table.columns
    if isinstance(wanted, int) or (isinstance(wanted, str) and wanted.isdigit()):
        number = int(wanted)
        if not 1 <= number <= len(columns):
            raise told.wrong(f"{what}.column = {number}: there are columns 1 to {len(columns)}")
        return columns[number - 1]
    if wanted is None:
        found = [c for c in columns if usual.fullmatch(c.name.strip())]
        return _only(found[:1] if what == "time" else found, table, what, told)
    found = [c for c in columns if c.name.casefold() == wanted.strip().casefold()]
    if not found:
        names = [c.name for c in columns]
        raise told.wrong(f"{what}.column = {wanted!r}: no such column; {hint(wanted, names)}")
    return _only(found, table, what, told)


def _only(found: list[Column], table: Table, what: str, told: Told) -> Column:
    if len(found) > 1:
        numbers = " and ".join(str(table.columns.index(c) + 1) for c in found)
        raise told.wrong(f"{what}: columns {numbers} have the name {found[0].name!r}; set {what}.column to a number")
    if not found:
        names = ", ".join(c.name for c in table.columns)
        raise told.wrong(f"{what}: which column? set {what}.column to a name or number; there are {names}")
    return found[0]
