"""A run: its loads, events and balances as tables, its curves, and how it shows itself in a notebook."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Iterator
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.figure import Figure

    from cosim.analysis.run_data import RunData
    from cosim.recording.pictures import Picture


class Run:
    """A recorded run. Tables are of pandas; ``table.attrs["units"]`` says in which unit each column is."""

    def __init__(self, path: Path, _kept: tempfile.TemporaryDirectory[str] | None = None) -> None:
        from cosim.recording.reader import read_run

        self.path = path  #: of the recording
        self.data: RunData = read_run(path)  #: arrays of all windows
        self._kept = _kept  # a folder that goes with this object

    # ---- numbers ----------------------------------------------------------------------------------------------

    @cached_property
    def loads(self) -> pd.DataFrame:
        """Forces [N], moments [N m] and point of attack [m] of every window, by its end [s]; totals, then by phase.

        ``fx``, ``fy``, ``fz``, ``f``, ``breaking_fx`` and so on; ``mx`` to ``mz`` and the overturning ``m``.
        """
        from cosim.export.tables import loads

        return loads(self.data)

    def averaged(self, over: float | None = None) -> pd.DataFrame:
        """The same as means over a time [s], by default the averaging time, whose largest values are the peaks."""
        from cosim.export.tables import loads

        return loads(self.data, self.data.averaging if over is None else over)

    @cached_property
    def events(self) -> pd.DataFrame:
        """All events: time [s], kind, load [N] as mean over ``averaging`` and at the instant, place [m]."""
        from cosim.export.tables import events

        return events(self.data)

    @cached_property
    def ledger(self) -> pd.DataFrame:
        """Balances of every window: masses [kg], energies [J]."""
        from cosim.export.tables import ledger

        return ledger(self.data)

    @cached_property
    def budget(self) -> pd.DataFrame:
        """What carries the load, of every window [N]."""
        from cosim.export.tables import budget

        return budget(self.data)

    @cached_property
    def motion(self) -> pd.DataFrame:
        """Displacement and velocity of a structure that moves, of every window [m], [rad]."""
        from cosim.export.tables import motion

        return motion(self.data)

    @cached_property
    def summary(self) -> dict[str, Any]:
        """What identifies the run, peaks, moments, lights and events, as ``cosim info --json`` prints it."""
        from cosim.analysis.summary import summary

        return summary(self.data)

    @cached_property
    def peaks(self) -> pd.DataFrame:
        """Largest means over the averaging time: ``value`` [N] and ``time`` [s], by phase and component."""
        import pandas as pd

        phases = {"total": self.summary["peaks"], **self.summary["peaks_by_phase"]}
        rows = {(phase, name): found for phase, peaks in phases.items() for name, found in peaks.items()}
        table = pd.DataFrame.from_dict(rows, orient="index")
        table.index.names = ["phase", "component"]
        table.attrs["units"] = {"value": "N", "time": "s"}
        return table

    @property
    def trust(self) -> dict[str, Any]:
        """``trustworthy``, ``because`` and all ``lights``."""
        found: dict[str, Any] = self.summary["trust"]
        return found

    @property
    def title(self) -> str:
        """Of the scenario."""
        return self.data.metadata["title"]

    @property
    def remark(self) -> str:
        """What to know of a run that is not whole; empty for one that is."""
        return self.data.remark

    @property
    def scenario(self) -> str:
        """The scenario as it ran, with every default (TOML)."""
        return self.data.texts["scenario.toml"]

    def dataset(self) -> xr.Dataset:
        """All numbers as a data set of xarray, with units."""
        from cosim.export.netcdf import dataset

        return dataset(self.data)

    def pictures(self) -> Iterator[Picture]:
        """Sheet, blocks and forces of the recorded frames, in order."""
        from cosim.recording.reader import recorded_pictures

        return recorded_pictures(self.path)

    # ---- what comes of it -------------------------------------------------------------------------------------

    def plot(self, over: float | None = None) -> Figure:
        """Fx and Fz over time by phase, with their peaks and events; means over a time [s], default as the peaks."""
        from cosim.show.curves import curves

        return curves(self.data, over)

    def export(self, out: str | Path, table: str | None = None) -> Path:
        """Write it in another form, by the ending: .csv, .parquet, .nc, .h5, .pvd (ParaView), .dat (OpenFAST)."""
        from cosim.export.write import export

        export(self.data, self.path, Path(out), table)
        return Path(out)

    def report(self, out: str | Path) -> Path:
        """Write the page (.html) of ``cosim report``."""
        from cosim.outputs import whole, writable
        from cosim.show.report import write_report

        with whole(writable(Path(out), ".html", [self.path]), ".html") as part:
            write_report(self.data, part, pictures=self.pictures())
        return Path(out)

    def save(self, out: str | Path, force: bool = False) -> Path:
        """Keep the recording at another place (.mcap)."""
        from cosim.outputs import grow

        with grow(Path(out), ".mcap", force) as target, self.path.open("rb") as source:
            shutil.copyfileobj(source, target)
        return Path(out)

    def __repr__(self) -> str:
        name = self.data.metadata["scenario"]
        return f"<cosim.Run {name}: {self.data.t[-1]:g} s, {len(self.data.t)} windows, {len(self.data.events)} events>"

    def _repr_html_(self) -> str:
        from cosim.show.run_html import run_html

        return run_html(self.data)
