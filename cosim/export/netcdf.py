"""A run as a data set of xarray, in a NetCDF file (HDF5) by the CF conventions 1.11.

Loads are means over windows: ``time`` is the end of each, ``time_bounds`` its two ends, and the cell method of every
load is ``time: mean``.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from cosim.analysis.run_data import RunData
from cosim.export.tables import events, unit_of_balance
from cosim.moments import attack_of
from coupling.interface import NS, PHASES

if TYPE_CHECKING:
    import xarray as xr

CONVENTIONS = "CF-1.11"
MEAN = {"cell_methods": "time: mean"}
AXES = ["x", "y", "z"]
FORCES = [f"f{axis}" for axis in AXES]


def dataset(run: RunData) -> xr.Dataset:
    """Forces and moments by phase, point of attack, balances, budget, events; coordinates time, phase, axis."""
    import xarray as xr

    by_phase = ("time", "phase", "axis")
    variables: dict[str, Any] = {
        "force": (by_phase, run.load, {"units": "N", "long_name": "force of the ice on the structure", **MEAN}),
        "time_bounds": (("time", "bound"), np.stack((run.begin_ns, run.t_ns), axis=1) / NS),
    }
    if run.moment is not None and run.weight is not None:
        about = "moment of the ice on the structure about moment_point"
        variables["moment"] = (by_phase, run.moment, {"units": "N m", "long_name": about, **MEAN})
        where = {"units": "m", "long_name": "point of attack: places weighed by the magnitude of their forces"}
        variables["attack"] = (("time", "axis"), attack_of(run.weight), where)
        variables["moment_point"] = (("axis",), np.array(run.moment_point), {"units": "m"})
    for name, values in run.ledger.items():
        variables[f"ledger_{name}"] = (("time",), values, {"units": unit_of_balance(name)})
    for name, values in run.budget.items():
        variables[f"budget_{name}"] = (("time",), values, {"units": "N", **MEAN})
    for k, (name, values) in enumerate(run.motion.items()):
        unit = ("m" if k % 6 < 3 else "rad") + ("/s" if k >= 6 else "")
        variables[f"structure_{name}"] = (("time",), values, {"units": unit})
    about_time = {"units": "s", "long_name": "simulated time, end of the window", "axis": "T", "bounds": "time_bounds"}
    coordinates = {
        "time": ("time", run.t, about_time),
        "phase": list(PHASES),
        "axis": AXES,
    }
    return xr.Dataset(variables | _events(run), coordinates, _attributes(run))


def _events(run: RunData) -> dict[str, Any]:
    table = events(run)
    units = table.attrs["units"]
    text = {name for name, unit in units.items() if not unit}
    about = {name: {"long_name": f"{name}, mean over event_averaging"} for name in FORCES}
    about |= {f"{name}_instant": {"long_name": f"{name} at the instant of the event"} for name in FORCES}
    return {
        f"event_{name}": (
            ("event",),
            table[name].to_numpy(object if name in text else None),
            ({"units": units[name]} if units[name] else {}) | about.get(name, {}),
        )
        for name in table.columns
    }


def _attributes(run: RunData) -> dict[str, str]:
    m = run.metadata
    return {
        "Conventions": CONVENTIONS,
        "title": m["title"],
        "source": f"Brash {m['version']}, commit {m['commit']}",
        "comment": "x in the drift direction of the ice, y to the left, z up from still water, fixed to the structure; "
        "loads are those of the ice on the structure",
        "scenario": m["scenario"],
        "scenario_toml": run.texts.get("scenario.toml", ""),
        "overrides": json.dumps(run.overrides),
        "averaging_s": m["averaging_s"],
        "ended": run.ended,
    }


def write_netcdf(run: RunData, out: Path) -> None:
    """One file; `xarray.open_dataset`, netCDF and HDF5 libraries read it."""
    out.write_bytes(dataset(run).to_netcdf(engine="h5netcdf", format="NETCDF4"))  # HDF5 would lock the file anew
