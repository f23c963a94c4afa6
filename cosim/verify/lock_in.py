"""Case `lock-in`: a tower before the narrow cone, its first frequency swept over the frequency at which ice breaks.

The ice, cone and drift of `scenarios/narrow_cone` on a coarse mesh. First the cone stands still: its load breaks at
f_b, one over the mean time between peaks of its mean over `SMOOTH`. Then it stands on one mode of frequency f_1 = r
f_b, the stiffness k at the waterline being the same for every r and the mass k / (2 pi f_1)^2. Beside each coupled run
stands the answer of the same mode to the load of the cone that stood still: the difference is what the motion does to
the ice. With ``draws`` all of it is done again in other ice: its strength varies from cell to cell by ``variation``
(deviation over mean) over ``correlation`` [m], each draw with a seed of its own. f_b is the mean over the
draws, of which the cone at rest has at least ``rests``; a run is set beside the cone at rest in the same ice.

Amplifications are over k^-1 F of the cone that stood still; for a sine of frequency f_b its deviation grows by
1 / sqrt((1 - (1/r)^2)^2 + (2 zeta / r)^2) (Chopra, Dynamics of Structures, 3.2), which the measure itself must give.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from cosim.analysis.levels import peaks_of
from cosim.scenario.loading import load_scenario
from cosim.simulation import RunResult, run_scenario
from cosim.verify.case import CaseResult, Figure, Quantity, at_most, near, value
from cosim.verify.lock_in_figure import draw, ratio_of, told
from coupling.interface import Array
from coupling.structure.motion import LinearMotion, modal

PARAMETERS: dict[str, Any] = {
    "ratios": [1.0],
    "stiffness": 5.0e5,
    "damping": 0.03,
    "seconds": 8.0,
    "skip": 1.5,
    "size": [16.0, 14.0],
    "nodes": [25, 22],
    "drift": 0.8,
    "window": 0.04,
    "rubble": True,
    "added_mass": 0.0,
    "draws": 1,
    "rests": 1,
    "variation": 0.0,
    "correlation": 2.0,
    "scenario": "narrow_cone",
}
SURGE = np.array([[1.0, 0.0, 0.0, 0.0, 0.0, 0.0]])
SINE = "Chopra, Dynamics of Structures, 3.2"
SMOOTH = 0.4  #: over which the load is averaged before its peaks are counted [s]
DENSE = np.geomspace(0.4, 4.5, 61)  #: ratios of the answers to the load of the cone that stood still


@dataclass(frozen=True)
class Answer:
    """Of one run, after its beginning."""

    deviation: float  #: of the displacement [m]
    largest: float  #: displacement [m]
    load_deviation: float  #: of the mean over the averaging time [N]
    load_largest: float  #: of the same [N]
    load_mean: float  #: of the same [N]
    breaking: float  #: frequency of the peaks of the load [Hz]; 0: fewer than two
    speed: float = 0.0  #: largest of the structure [m/s]
    residual: float = 0.0  #: of the structure's books, as part of what it received


def tower(p: dict[str, Any], frequency: float) -> LinearMotion:
    """One mode in surge of the stiffness at the waterline."""
    mass = p["stiffness"] / (2.0 * np.pi * frequency) ** 2
    return modal(np.array([frequency]), np.array([p["damping"]]), np.array([mass]), SURGE)


def run_of(p: dict[str, Any], frequency: float | None, draw: int = 0) -> RunResult:
    """The run with the tower of this frequency in the ice of a draw; None: the cone stands still."""
    length, width = p["size"]
    texts = [f"sheet.length='{length} m'", f"sheet.width='{width} m'", f"sheet.nodes={p['nodes']}"]
    texts += [f"scenario.duration='{p['seconds']} s'", f"drift.velocity='{p['drift']} m/s'"]
    texts += [f"coupling.window='{p['window']} s'", f"rubble.enabled={str(p['rubble']).lower()}"]
    texts += [f"scenario.seed={draw + 1}", f"water.added_mass={p['added_mass']}"]
    if p["variation"]:
        field = f"{{variation={p['variation']}, correlation_length='{p['correlation']} m'}}"
        texts += [f"ice.strength_field={field}"]
    if frequency is not None:
        omega = 2.0 * np.pi * frequency
        mass, damping = p["stiffness"] / omega**2, 2.0 * p["damping"] * p["stiffness"] / omega
        surge = f"{{mass='{mass} kg', stiffness='{p['stiffness']} N/m', damping='{damping} N*s/m'}}"
        texts += ["structure.motion.kind=spring", f"structure.motion.surge={surge}"]
    return run_scenario(load_scenario(p["scenario"], texts))


def answer_to(motion: LinearMotion, t: Array, load: Array) -> Array:
    """Surge at times (n,) [m] of a structure that bears the load (n,) [N] of one that rests."""
    out, before = [], 0.0
    for now, fx in zip(t, load, strict=True):
        motion.advance(before, now - before, np.array([fx, 0.0, 0.0, 0.0, 0.0, 0.0]))
        before = now
        out.append(motion.displacement[0])
    return np.array(out)


def measured(p: dict[str, Any], result: RunResult) -> Answer:
    """What a run came to."""
    data, books = result.data, result.ledger
    after = data.t > p["skip"]
    load = data.lasting.component("fx")[after]
    way = data.motion["surge"][after] if data.motion else np.zeros(1)
    speed = float(np.abs(data.motion["surge_rate"]).max()) if data.motion else 0.0
    places, _, step = peaks_of(data, "fx", p["skip"], 0.2, SMOOTH)
    span = step * float(places[-1] - places[0]) if len(places) > 1 else 0.0
    residual = 0.0
    if data.motion:
        residual = books["structure_energy_residual"] / books["structure_interface_exchanged"]
    return Answer(
        float(way.std()),
        float(way.max()),
        float(load.std()),
        float(load.max()),
        float(load.mean()),
        (len(places) - 1) / span if span else 0.0,
        speed,
        residual,
    )


def sine_amplification(p: dict[str, Any], ratio: float) -> tuple[float, float]:
    """Of the deviation under a sine of 1 Hz, by `answer_to` over its last periods and by the formula."""
    t = np.linspace(0.02, 160.0, 8000)
    way = answer_to(tower(p, ratio), t, np.sin(2.0 * np.pi * (t - 0.01)))[-1000:]
    formula = 1.0 / np.hypot(1.0 - ratio**-2, 2.0 * p["damping"] / ratio)
    return float(way.std() * p["stiffness"] * np.sqrt(2.0)), float(formula)


@dataclass(frozen=True)
class Draw:
    """All that was run in one ice."""

    still: Answer
    found: list[Answer]  #: one for each ratio
    alone: Array  #: (r, 2) deviation and largest displacement [m] under the load of the cone that stood still
    curves: Array  #: (c, 3) ratio, and the same


def drawn(p: dict[str, Any], rest: RunResult, f_b: float, draw: int) -> Draw:
    """The sweep in the ice in which the cone stood still."""
    load, after = rest.data.component("fx"), rest.data.t > p["skip"]
    ways = np.array([answer_to(tower(p, r * f_b), rest.data.t, load)[after] for r in (*p["ratios"], *DENSE)])
    both, n = np.column_stack((ways.std(axis=1), ways.max(axis=1))), len(p["ratios"])
    found = [measured(p, run_of(p, r * f_b, draw)) for r in p["ratios"]]
    return Draw(measured(p, rest), found, both[:n], np.column_stack((DENSE, both[n:])))


def run(p: dict[str, Any], quick: bool) -> CaseResult:
    """The cone that stands still, and the sweep, in each draw; ``quick``: one ratio, 3 s, one draw."""
    if quick:
        p = {**p, "ratios": p["ratios"][:1], "seconds": 3.0, "skip": 0.5, "draws": 1, "rests": 1}
    rests = [run_of(p, None, k) for k in range(max(p["draws"], p["rests"]))]
    breaking = [b for b in (measured(p, rest).breaking for rest in rests) if b]
    f_b = float(np.mean(breaking)) if breaking else 1.0
    draws = [drawn(p, rests[k], f_b, k) for k in range(p["draws"])]
    quantities = [*_checks(p, [a for d in draws for a in d.found]), *_values(p, f_b, breaking, draws)]
    figure = Figure("sweep", "A tower before ice that breaks", lambda sheet: draw(sheet, p, f_b, draws))
    return CaseResult("lock-in", p, quantities, [figure])


def _checks(p: dict[str, Any], found: list[Answer]) -> list[Quantity]:
    """The measure under a sine, and the books of the structure."""
    sines = np.array([sine_amplification(p, r) for r in (0.5, 1.0, 2.0)]).T
    residuals = [a.residual for a in found]
    return [
        near("amplification of a sine at 0.5, 1, 2", sines[0], "-", sines[1], 0.02, SINE),
        at_most("residual of the structure's books, part of the exchange", residuals, "-", 1e-9, "sum of the books"),
    ]


def _values(p: dict[str, Any], f_b: float, breaking: list[float], draws: list[Draw]) -> list[Quantity]:
    """What is told, without a reference: lists over the ratios, in each draw."""
    k = p["stiffness"]
    return [
        value("breaking frequency of the cone that stands still", f_b, "Hz"),
        value("the same in each draw that has two peaks", breaking, "Hz"),
        value("its load: deviation, largest", [[d.still.load_deviation, d.still.load_largest] for d in draws], "N"),
        value("ratio f_1 / f_b", p["ratios"], "-"),
        value("deviation of the displacement", told(draws, "deviation"), "m"),
        value("its amplification", k * ratio_of(draws, "deviation", "load_deviation"), "-"),
        value("the same under the load at rest", [d.alone[:, 0] * k / d.still.load_deviation for d in draws], "-"),
        value("largest displacement", told(draws, "largest"), "m"),
        value("its amplification, largest", k * ratio_of(draws, "largest", "load_largest"), "-"),
        value(
            "the same under the load at rest, largest", [d.alone[:, 1] * k / d.still.load_largest for d in draws], "-"
        ),
        value("amplification of the load's deviation", ratio_of(draws, "load_deviation"), "-"),
        value("amplification of the largest load", ratio_of(draws, "load_largest"), "-"),
        value("amplification of the mean load", ratio_of(draws, "load_mean"), "-"),
        value("breaking frequency of the coupled run", told(draws, "breaking"), "Hz"),
        value("largest speed", told(draws, "speed"), "m/s"),
    ]
