"""Variables with their units: motion of the structure into the ice, loads out of it; for a structure vice versa."""

from __future__ import annotations

from cosim.analysis.run_data import AXES, MOMENT_AXES, MOTION
from coupling.interface import FREEDOMS, PHASES

LOAD = (*AXES, *MOMENT_AXES)  #: of all phases, means over the step [N], [N m]
TIME = "time"  #: now [s]; FMI 3.0 wants it as a variable
BY_PHASE = tuple(f"{phase}_{name}" for phase in PHASES for name in LOAD)

#: units in SI, for masters that convert: exponents of kg, m, s, rad
UNITS: dict[str, dict[str, int]] = {
    "N": {"kg": 1, "m": 1, "s": -2},
    "N.m": {"kg": 1, "m": 2, "s": -2},
    "s": {"s": 1},
    "m": {"m": 1},
    "rad": {"rad": 1},
    "m/s": {"m": 1, "s": -1},
    "rad/s": {"rad": 1, "s": -1},
}


def unit_of(name: str) -> str:
    """Of a variable: N, N.m, s, m, rad, m/s or rad/s, as FMI writes them."""
    if name == TIME:
        return "s"
    bare = name.removesuffix("_rate")
    if bare in FREEDOMS:
        return ("m" if FREEDOMS.index(bare) < 3 else "rad") + ("/s" if bare != name else "")
    return "N.m" if name.split("_")[-1] in MOMENT_AXES else "N"


def about(name: str) -> str:
    """One line for the description of a variable."""
    if name == TIME:
        return "end of the last step"
    if name in MOTION:
        what = "velocity" if name.endswith("_rate") else "displacement"
        return f"{what} of the structure's waterline point, {name.removesuffix('_rate')}"
    *phase, axis = name.split("_")
    kind = "moment about the waterline point where it is" if axis in MOMENT_AXES else "force"
    return (
        f"{kind} of the ice on the structure along {axis[1]}, {phase[0] if phase else 'all phases'}; mean of the step"
    )
