"""Times of a series in seconds: plain numbers with a unit, dates, clocks, dates and clocks in two columns."""

from __future__ import annotations

import re
from collections.abc import Callable
from datetime import datetime, timedelta

import numpy as np

from cosim.series.cells import CLOCK, DATE, STAMP, is_missing
from cosim.series.description import TimeColumn
from cosim.series.pick import pick
from cosim.series.table import Column, Table, factor
from cosim.series.told import Told
from coupling.interface import Array

DAY = 86400.0
NAMES = re.compile(r"t|time.*|zeit.*|temps|tiempo|tid|timestamp|date.*|datum.*|uhrzeit|clock", re.IGNORECASE)


def times_of(table: Table, given: TimeColumn, told: Told) -> Array:
    """(n,) [s]; nan where a row has none. Stamps count from the first one."""
    if given.step is not None:
        told.say(f"time: rows at a distance of {given.step:g} s, as set")
        return np.asarray(np.arange(len(table.columns[0].cells)) * given.step)
    column = pick(table, given.column, NAMES, "time", told)
    cells = column.cells
    if not isinstance(cells, list):
        return _stamps64(cells, told) if cells.dtype.kind in "Mm" else _plain(table, column, given, told)
    if given.format is not None:
        return _since_first(_parsed(cells, lambda c: datetime.strptime(c, str(given.format)), told), told)
    text = next((c for c in cells if not is_missing(c)), "")
    if table.dialect.is_number(text):
        return _plain(table, column, given, told)
    if DATE.fullmatch(text):
        cells = _joined(table, column, cells, told)
        text = next((c for c in cells if not is_missing(c)), "")
    if not STAMP.fullmatch(text):
        raise told.wrong(f"time: {text!r} in column {column.name!r} is no time; set time.column or time.format")
    if CLOCK.fullmatch(text):
        return _clocks(cells, told)
    return _since_first(_parsed(cells, _reader(cells, told), told), told)


def _plain(table: Table, column: Column, given: TimeColumn, told: Told) -> Array:
    unit = given.unit or column.unit
    if unit is None:
        raise told.wrong(f"time: column {column.name!r} says no unit; set time.unit, for example time.unit=s")
    told.say(f"time: column {column.name!r} in {unit}{', as set' if given.unit else ''}")
    return table.numbers(column) * factor(unit, "s", "time", told)


def _stamps64(cells: Array, told: Told) -> Array:
    ns = cells.astype("datetime64[ns]").astype(np.int64)
    out = np.where(np.isnat(cells), np.nan, (ns - ns[0]) / 1e9)
    told.say(f"time: stamps, counted from {cells[0]}")
    return out


def _joined(table: Table, date: Column, cells: list[str], told: Told) -> list[str]:
    """Dates with the clocks of the next column, if they are clocks."""
    columns = table.columns
    k = columns.index(date) + 1
    clock = columns[k].cells if k < len(columns) else []
    if not isinstance(clock, list) or not any(CLOCK.fullmatch(c) for c in clock[:5]):
        return cells
    told.say(f"time: date in column {date.name!r} and clock in column {columns[k].name!r}")
    return [f"{a} {b}" for a, b in zip(cells, clock, strict=True)]


def _reader(cells: list[str], told: Told) -> Callable[[str], datetime]:
    """A function that reads dates: the year first, or day and month in the order that the file proves."""
    dated = [cell for cell in cells if STAMP.fullmatch(cell) and not CLOCK.fullmatch(cell)]
    parts = [re.split(r"[-/.]", cell.split("T")[0].split()[0]) for cell in dated]
    if len(parts[0][0]) == 4:
        return lambda cell: _date(cell, (0, 1, 2))
    first = max(int(p[0]) for p in parts)
    second = max(int(p[1]) for p in parts)
    if first <= 12 and second <= 12 and "." not in dated[0].split()[0]:
        raise told.wrong(f"time: day or month first in {dated[0]!r}? set time.format, for example %d/%m/%Y %H:%M:%S")
    order = (2, 0, 1) if second > 12 else (2, 1, 0)
    told.say(f"time: dates with the {'month' if second > 12 else 'day'} first")
    return lambda cell: _date(cell, order)


def _date(cell: str, order: tuple[int, int, int]) -> datetime:
    day, _, clock = cell.replace("T", " ").partition(" ")
    numbers = [int(p) for p in re.split(r"[-/.]", day)]
    year, month, date = (numbers[k] for k in order)
    base = datetime(year + 2000 * (year < 100), month, date)
    return base + timedelta(seconds=_seconds(clock.strip()) if clock.strip() else 0.0)


def _seconds(clock: str) -> float:
    """A clock as seconds of the day; a zone is taken off them, so that all are in UTC."""
    found = re.fullmatch(r"([\d:.,]+)\s?([AaPp][Mm])?(Z|[+-]\d{2}:?\d{2})?", clock)
    if found is None:
        raise ValueError(clock)
    parts = [float(p.replace(",", ".")) for p in found[1].split(":")]
    hour = parts[0] % 12 + 12 * (found[2].lower() == "pm") if found[2] else parts[0]
    zone = (found[3] or "Z").replace(":", "")
    offset = 0.0 if zone == "Z" else (1 if zone[0] == "+" else -1) * (int(zone[1:3]) * 3600 + int(zone[3:]) * 60)
    return hour * 3600.0 + parts[1] * 60.0 + (parts[2] if len(parts) > 2 else 0.0) - offset


def _clocks(cells: list[str], told: Told) -> Array:
    """Clocks, past midnight as well: a step back by more than half a day is a new day."""
    out = np.array([_seconds(c) if CLOCK.fullmatch(c) else np.nan for c in cells])
    seen = np.flatnonzero(np.isfinite(out))
    days = np.cumsum(np.diff(out[seen], prepend=out[seen[0]]) < -DAY / 2)
    out[seen] += DAY * days
    told.say(f"time: clock, counted from {cells[seen[0]]}" + (f", past midnight {days[-1]} times" * bool(days[-1])))
    return np.asarray(out - out[seen[0]])


def _parsed(cells: list[str], read: Callable[[str], datetime], told: Told) -> list[datetime | None]:
    out: list[datetime | None] = []
    for cell in cells:
        try:
            out.append(None if is_missing(cell) else read(cell))
        except (ValueError, IndexError, OverflowError):
            if not out:
                raise told.wrong(f"time: {cell!r} cannot be read; set time.format, as of strptime") from None
            out.append(None)
    return out


def _since_first(stamps: list[datetime | None], told: Told) -> Array:
    first = next((s for s in stamps if s is not None), None)
    if first is None:
        raise told.wrong("time: no stamp can be read; set time.format, as of strptime")
    told.say(f"time: stamps, counted from {first.isoformat(sep=' ')}")
    return np.array([np.nan if s is None else (s - first).total_seconds() for s in stamps])
