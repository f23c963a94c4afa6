"""A measured series from its file: CSV and its kin, Parquet, or another recording."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from cosim.recording.reader import read_run
from cosim.series.cells import Dialect
from cosim.series.description import Description, LoadColumn
from cosim.series.pick import pick
from cosim.series.sensor import at_run_scale, without_zero
from cosim.series.series import Series, as_series
from cosim.series.table import MOST_LOST, Column, Table, factor, read_text
from cosim.series.text import read_bytes, text_of
from cosim.series.times import times_of
from cosim.series.told import Told, count
from coupling.interface import Array

COMPONENTS = ("fx", "fy", "fz", "f")
GAP = 5.0  #: a distance of rows of so many usual ones is a gap
FEWEST = 8  #: values of a series


def read_series(path: Path, description: Description) -> Series:
    """The series at the scale of the run, its zero taken off; what was done is in ``told``."""
    told = Told(path.name)
    if path.suffix.lower() == ".mcap":
        told.say("another run: its loads are constant in each window")
        series = as_series(read_run(path))
        if not series.loads:
            raise told.wrong("no load in this recording; give one in which ice meets the structure")
    else:
        table = _table(path, description, told)
        t, loads = _columns(table, description, told)
        series = Series(path.name, *_in_order(t, loads, told))
    series = at_run_scale(without_zero(series, description, told), description, told)
    return replace(series, told=tuple(told.lines))


def _table(path: Path, description: Description, told: Told) -> Table:
    data = read_bytes(path)
    if data.startswith(b"PAR1"):
        return _parquet(path, told)
    return read_text(text_of(data, description.text.encoding, told), description, told)


def _parquet(path: Path, told: Told) -> Table:
    """Columns of a Parquet file; a unit stands in the metadata of its field or in the name."""
    try:
        table = pq.read_table(path)
    except (pa.ArrowException, OSError) as error:
        raise told.wrong(f"Parquet cannot be read: {str(error).splitlines()[0]}; write the file again") from None
    columns = []
    for field in table.schema:
        values = table.column(field.name).combine_chunks()
        kind = field.type
        if pa.types.is_timestamp(kind):
            cells: list[str] | Array = values.cast(pa.timestamp("ns")).to_numpy(zero_copy_only=False)
        elif pa.types.is_floating(kind) or pa.types.is_integer(kind) or pa.types.is_decimal(kind):
            cells = values.cast(pa.float64()).to_numpy(zero_copy_only=False)
        else:
            continue
        known = {key.decode().lower(): value.decode() for key, value in (field.metadata or {}).items()}
        found = re.fullmatch(r"(.*?)\s*[\[(](.*)[\])]", field.name)
        unit = known.get("unit") or known.get("units") or (found[2] if found else None)
        columns.append(Column(found[1] if found else field.name, unit, cells))
    if not columns or not table.num_rows:
        raise told.wrong("no column of numbers; give a table with a time and a load")
    return Table(tuple(columns), Dialect(",", "."))


def _columns(table: Table, description: Description, told: Told) -> tuple[Array, dict[str, Array]]:
    """Times [s] and loads [N] of all rows, nan where there are none."""
    t = times_of(table, description.time, told)
    wanted = {name: getattr(description, name) for name in COMPONENTS}
    if not any(wanted.values()):
        wanted = {
            name: LoadColumn() for name in COMPONENTS if any(_usual(name).fullmatch(c.name) for c in table.columns)
        }
        if not wanted:
            names = ", ".join(c.name for c in table.columns)
            raise told.wrong(f"which column is a load? set fx.column to a name or number; there are {names}")
    loads = {}
    for name, given in wanted.items():
        if given is None:
            continue
        column = pick(table, given.column, _usual(name), name, told)
        unit = given.unit or column.unit
        if unit is None:
            raise told.wrong(
                f"{name}: column {column.name!r} says no unit; set {name}.unit, for example {name}.unit=kN"
            )
        sign = ", sign turned" if given.sign < 0 else ""
        told.say(f"{name}: column {column.name!r} in {unit}{', as set' if given.unit else ''}{sign}")
        with np.errstate(over="ignore"):  # what is too large for a number is left out as no number
            loads[name] = given.sign * factor(unit, "N", name, told) * table.numbers(column)
    return t, loads


def _usual(name: str) -> re.Pattern[str]:
    """Usual names of a component."""
    axis = name[1:]
    words = r"f|force|load|kraft|last|total"
    return re.compile(rf"(?:{words})[ _.-]?{axis}|{axis}[ _.-](?:{words})" if axis else words, re.IGNORECASE)


def _in_order(t: Array, loads: dict[str, Array], told: Told) -> tuple[Array, dict[str, Array]]:
    """Rows with a time and all values, sorted, each time once; what is done about the others is told."""
    values = np.stack(list(loads.values()), axis=1)
    good = np.isfinite(t) & np.isfinite(values).all(axis=1)
    if lost := int(np.count_nonzero(~good)):
        text = f"{lost} of {count(len(t), 'row')} without a time or a value, the first is row {int(good.argmin()) + 1}"
        if lost > MOST_LOST * len(t):
            raise told.wrong(f"{text}; correct the file or choose other columns")
        told.say(f"{text}: left out")
    t, values = t[good], values[good]
    if back := int(np.count_nonzero(np.diff(t) < 0)):
        told.say(f"times go back at {count(back, 'place')}: rows sorted by time")
        order = np.argsort(t, kind="stable")
        t, values = t[order], values[order]
    once, where, times = np.unique(t, return_inverse=True, return_counts=True)
    if more := len(t) - len(once):
        first = once[times > 1][0]
        told.say(f"{count(more, 'row')} with a time that was there before, the first at {first:g} s: means are taken")
        values = np.stack([np.bincount(where, column) / times for column in values.T], axis=1)
    if len(once) < FEWEST:
        raise told.wrong(f"{count(len(once), 'value')}: no series; give at least {FEWEST}")
    step = np.diff(once)
    wide = np.flatnonzero(step > GAP * np.median(step))
    if len(wide):
        k = int(wide[step[wide].argmax()])
        where_to = f"the longest of {step[k]:.3g} s after {once[k]:.6g} s"
        told.say(f"{count(len(wide), 'gap')}, {where_to}: bridged by straight lines")
    return once, dict(zip(loads, values.T, strict=True))
