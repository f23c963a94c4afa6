"""Tables as CSV and Parquet. A column's name carries its unit: ``fx [N]``; pandas reads both by themselves."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from cosim.analysis.run_data import RunData
from cosim.export.tables import TABLES, TIME

if TYPE_CHECKING:
    import pandas as pd


def with_units(run: RunData, table: str) -> pd.DataFrame:
    """A table of `TABLES` whose columns are named with their units, the time among them."""
    found = TABLES[table](run)
    units = found.attrs["units"]
    if found.index.name == TIME:
        found = found.reset_index()
    return found.rename(columns={name: f"{name} [{unit}]" if unit else name for name, unit in units.items()})


def write_csv(run: RunData, table: str, out: Path) -> None:
    """Text, numbers with all their digits."""
    with_units(run, table).to_csv(out, index=False, lineterminator="\n")


def write_parquet(run: RunData, table: str, out: Path) -> None:
    """Columns, compressed."""
    with_units(run, table).to_parquet(out, engine="pyarrow", index=False)
