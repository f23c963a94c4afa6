"""Design formulas beside a recorded run: peaks, and how much of them breaking takes."""

from __future__ import annotations

import tomllib
from typing import Any

from pydantic import ValidationError

from cosim.analysis.peaks import at_peak
from cosim.analysis.run_data import RunData
from cosim.baselines.methods import design_loads
from cosim.scenario.model import ScenarioModel


def beside(run: RunData) -> dict[str, Any]:
    """``{simulated, methods}``: peaks with their sign [N], breaking's share of the peak of Fx; per method the same.

    Methods have ``ratio_fx``, ``ratio_fz`` = simulated / design. ``refused`` stands in place of ``methods`` if the
    scenario cannot be read.
    """
    simulated = simulated_load(run)
    try:
        model = ScenarioModel.model_validate(tomllib.loads(run.texts.get("scenario.toml", "")))
    except (tomllib.TOMLDecodeError, ValidationError) as error:
        what = str(error).splitlines()[0]
        refused = f"the recorded scenario cannot be read by this version: {what}"
        return {"averaging_s": run.averaging, "simulated": simulated, "refused": refused}
    return {
        "averaging_s": run.averaging,
        "simulated": simulated,
        "methods": {name: _row(simulated, found) for name, found in design_loads(model).items()},
    }


def simulated_load(run: RunData) -> dict[str, float | None]:
    """Largest Fx and Fz in magnitude, and the share of breaking at the peak of Fx."""
    run = run.lasting
    k = at_peak(run, "fx")
    if k is None:
        return {"fx": None, "fz": None, "breaking_share": None}
    fx, low = float(run.component("fx")[k]), at_peak(run, "fz")
    share = float(run.component("fx", "breaking")[k]) / fx if fx else None
    return {"fx": fx, "fz": float(run.component("fz")[low]), "breaking_share": share}


def _row(simulated: dict[str, float | None], found: dict[str, Any]) -> dict[str, Any]:
    if "refused" in found:
        return found
    ratios = {
        f"ratio_{axis}": None if simulated[axis] is None else simulated[axis] / found[axis] for axis in ("fx", "fz")
    }
    return {**found, **ratios}
