"""Case `first-encounter`: the 165 m floe of the basin meets the cone, with the rubble as a steady lift under its edge.

The campaign's sheet, contact and cone (`scenarios/basin_2010_floe_165m`), but in place of blocks the lift of 3000 m3
of rubble, as of a heap that falls evenly from 13 m from the axis to nothing at 35 m. Beside it two calculations with
the same lift that share no code with this one: rigid plates with finite rotations and fibres across their interfaces,
and a prototype of the same law of cracks on the same lattice. Compared are peaks of the mean over half a second, and
the rise of the load: with an edge that crushes and a sheet that holds the basin's own Fz went 1.7, 4, 6, 9.5, 11.8 MN
in steps of 0.2 m of drift.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from cosim.build import build
from cosim.scenario.loading import load_scenario
from cosim.verify.case import CaseResult, Figure, Quantity, near, value
from coupling.interface import NS, SheetForces
from coupling.rubble_port import NoRubble
from coupling.scheduler import Scheduler
from coupling.sheet_port import SheetPort
from lattice.grid import Array

PARAMETERS: dict[str, Any] = {"volume": 3000.0, "from": 13.0, "to": 35.0, "seconds": 16.0, "nodes": 60}
MEAN = 0.5  #: over which loads are averaged [s]
RISE = (1.7e6, 4.0e6, 6.0e6, 9.5e6, 11.8e6)  #: Fz after each 0.2 m of drift [N]
STEP = 2.0  #: time of 0.2 m of drift [s]
SOURCE_PLATES, SOURCE_PROTOTYPE = "rigid plates with fibres", "lattice prototype"


@dataclass(frozen=True)
class Variant:
    """A sheet, and the largest Fx and Fz of others [MN], nan where they have none."""

    name: str
    lift: bool
    overrides: tuple[str, ...]
    prototype: tuple[float, float]
    plates: tuple[float, float]


FREE, BRITTLE = "sheet.sides='free'", ("fracture.fracture_energy='0 J/m^2'", "ice.beam_test.concentration=1.29")
UNKNOWN = (np.nan, np.nan)
OPEN = ("fracture.cracks='open'", "ice.tensile_strength='967 kPa'", "ice.flexural_strength='967 kPa'")
VARIANTS = (
    Variant("sides held, rubble", True, (), (16.1, 13.3), (17.0, 14.0)),
    Variant("sides held", False, (), (14.2, 11.7), (13.2, 10.9)),
    Variant("sides free, rubble", True, (FREE,), (12.5, 10.3), (14.3, 11.8)),
    Variant("sides free, brittle", False, (FREE, *BRITTLE), (9.6, 7.9), (9.7, 8.0)),
    Variant("sides free, rubble, cracks that carry nothing", True, (FREE, *OPEN), (7.8, 6.4), UNKNOWN),
    Variant("sides held, rubble, brittle", True, BRITTLE, UNKNOWN, (15.0, 12.4)),
    Variant("sides held, rubble, 100 J/m2", True, ("fracture.fracture_energy='100 J/m^2'",), UNKNOWN, (14.8, 12.2)),
    Variant(
        "sides held, rubble, 1000 J/m2", True, ("fracture.fracture_energy='1000 J/m^2'",), (18.1, 14.9), (20.1, 16.6)
    ),
)


class SteadyLift(NoRubble):
    """Rubble that does nothing but press upwards on some nodes of the sheet."""

    def __init__(self, lift: SheetForces) -> None:
        super().__init__()
        self._lift = lift

    def forces_on_sheet(self) -> SheetForces:
        """The same for ever."""
        return self._lift


@dataclass(frozen=True)
class Loads:
    """Of a run, means over `MEAN`."""

    t: Array  #: middle of each mean [s]
    fx: Array  #: [N]
    fz: Array  #: [N]

    @property
    def peak(self) -> tuple[float, float, float]:
        """Largest Fx with its time, and largest Fz [N], [s], [N]."""
        k = int(np.argmax(self.fx))
        return float(self.fx[k]), float(self.t[k]), float(self.fz.max())


def scheduler_of(p: dict[str, Any], variant: Variant) -> Scheduler:
    """The coupled run without blocks, in equilibrium with the lift."""
    scenario = load_scenario(
        "basin_2010_floe_165m",
        [
            "rubble.enabled=false",
            "rubble.initial_volume='0 m^3'",
            f"sheet.nodes=[{p['nodes']}, {p['nodes']}]",
            f"scenario.duration='{p['seconds']} s'",
            *variant.overrides,
        ],
    )
    scheduler = build(scenario)
    if variant.lift:
        port = scheduler.sheet
        if not isinstance(port, SheetPort):
            raise TypeError(f"the sheet is a {type(port).__name__}, whose nodes are not known")
        ice, grid = port.sheet.ice, port.sheet.grid
        at = np.hypot(*port.motion.position(np.arange(grid.nodes))[:, :2].T)
        heap = np.clip((p["to"] - at) / (p["to"] - p["from"]), 0.0, 1.0) * grid.area
        under = np.flatnonzero(heap > 0.0)
        lift = (ice.rho_w - ice.rho_i) * ice.g * p["volume"]
        force = np.zeros((len(under), 3))
        force[:, 2] = lift * heap[under] / heap.sum()
        rubble = SteadyLift(SheetForces(under, force))
        port.rest_under(rubble.forces_on_sheet())
        scheduler.rubble = rubble
    return scheduler


def loads_of(p: dict[str, Any], variant: Variant) -> Loads:
    """Runs a variant."""
    scheduler, rows = scheduler_of(p, variant), []
    while scheduler.t_ns < p["seconds"] * NS:
        frame = scheduler.macro_step()
        rows.append((frame.t_ns / NS, *frame.load.sum(axis=0)[[0, 2]]))
    t, fx, fz = np.array(rows).T
    n = max(1, round(MEAN / (t[1] - t[0])))
    kernel = np.full(n, 1.0 / n)
    return Loads(*(np.convolve(x, kernel, "valid") for x in (t, fx, fz)))


def run(p: dict[str, Any], quick: bool) -> CaseResult:
    """All variants; ``quick``: the rise of the first one on a mesh of 30 x 30."""
    if quick:
        p = {**p, "seconds": 4.5, "nodes": 30}
    variants = VARIANTS[:1] if quick else VARIANTS
    found = [loads_of(p, v) for v in variants]
    steps = np.arange(1, len(RISE) + 1) * STEP
    steps = steps[steps + MEAN <= p["seconds"]]
    rise, basin = np.interp(steps, found[0].t, found[0].fz), np.array(RISE[: len(steps)])
    quantities: list[Quantity] = [
        near("Fz after each 0.2 m of drift", rise, "N", basin, 0.25, "basin, first encounter")
    ]
    for variant, loads in zip(variants, found, strict=True):
        fx, at, fz = loads.peak
        pair = np.array((fx, fz))
        for others, share, source in (
            (variant.prototype, 0.10, SOURCE_PROTOTYPE),
            (variant.plates, 0.20, SOURCE_PLATES),
        ):
            known = not quick and np.isfinite(others).all()
            reference = 1e6 * np.array(others) if known else None
            quantities.append(near(f"{variant.name}: Fx, Fz beside {source}", pair, "N", reference, share, source))
        quantities.append(value(f"{variant.name}: time of the peak", at, "s"))
    return CaseResult("first-encounter", p, quantities, [_figure(variants, found)])


def _figure(variants: tuple[Variant, ...], found: list[Loads]) -> Figure:
    def draw(figure: Any) -> None:
        axes = figure.subplots()
        for variant, loads in zip(variants, found, strict=True):
            (line,) = axes.plot(loads.t, 1e-6 * loads.fx, label=variant.name)
            axes.axhline(variant.plates[0], color=line.get_color(), ls=":", lw=0.8)
        axes.set(xlabel="t [s]", ylabel="Fx, mean over 0.5 s [MN]", ylim=(0, None))
        axes.legend(fontsize=7)

    return Figure("loads", "First encounter with steady lift; dotted: peaks of the plates", draw)
