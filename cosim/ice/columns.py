"""Tables of numbers about the ice of a sheet, by place: CSV or Parquet, with named columns."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.csv
import pyarrow.parquet

from cosim.errors import InputError
from coupling.interface import Array


def read_table(path: Path, columns: Sequence[str]) -> pa.Table:
    """The table, which has these columns, with at least one row; InputError with one line otherwise."""
    try:
        table = pa.parquet.read_table(path) if path.suffix == ".parquet" else pa.csv.read_csv(path)
    except FileNotFoundError:
        raise InputError(f"{path}: no such file; give a path from the folder of the scenario") from None
    except (pa.ArrowException, OSError) as error:
        reason = " ".join(str(error).split())[:200]
        raise InputError(f"{path}: cannot be read as a table ({reason}); give a .csv or .parquet") from None
    missing = [name for name in columns if name not in table.column_names]
    if missing:
        have = ", ".join(table.column_names)[:200]
        raise InputError(f"{path}: has no column {missing[0]}, it has {have}; name its columns {', '.join(columns)}")
    if not table.num_rows:
        raise InputError(f"{path}: holds no row; give at least one")
    return table


def numbers(path: Path, table: pa.Table, column: str) -> Array:
    """A column as numbers, (rows,); InputError names the row that holds none."""
    try:
        cast = pc.cast(table[column], pa.float64())
    except pa.ArrowException:
        raise InputError(f"{path}: column {column} holds what is no number; decimal points are points") from None
    values = np.asarray(cast.to_numpy(zero_copy_only=False), np.float64)
    bad = np.flatnonzero(~np.isfinite(values))
    if len(bad):
        raise InputError(f"{path}: row {bad[0] + 1} has no number in column {column}; fill it in or leave the row out")
    return values
