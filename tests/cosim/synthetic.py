"""A run without solvers: a drifting sheet that breaks at a cone, blocks that slide down it, plausible loads.

Nothing here is physics. It exercises recording, comparison and replay with the shapes that a real run has.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from cosim.observer import RunInfo
from cosim.scenario.scenario import Scenario
from coupling.interface import BlockTable, Event, Frame, Phase, SheetView

SPLIT, CIRCUMFERENTIAL, HAND_OVER = 4.0, 6.0, 6.0  #: times of the events [s]


def cone(radius: float = 15.0, neck: float = 9.0, top: float = 5.0, toe: float = 20.0, n: int = 48):
    """Mesh of a downward-breaking cone of 45 deg on a cylinder: points and outward triangles."""
    profile = [(-toe, neck), (neck - radius, neck), (0.0, radius), (top, radius + top)]
    angle = 2 * math.pi * np.arange(n) / n
    rings = [np.stack([r * np.cos(angle), r * np.sin(angle), np.full(n, z)], axis=1) for z, r in profile]
    points = np.concatenate([*rings, [(0, 0, -toe), (0, 0, top)]])
    a = np.arange(n)
    b = (a + 1) % n
    sides = [np.concatenate([np.stack([a, b, b + n], 1), np.stack([a, b + n, a + n], 1)]) + k * n for k in range(3)]
    low, high = np.full(n, 4 * n), np.full(n, 4 * n + 1)
    return points, np.concatenate([*sides, np.stack([b, a, low], 1), np.stack([a + 3 * n, b + 3 * n, high], 1)])


def run_info(scenario: Scenario) -> RunInfo:
    return RunInfo(
        scenario,
        cone(),
        tuple(scenario.sheet.nodes),
        scenario.sheet.spacing,
        scenario.duration_ns,
        scenario.window_ns,
    )


def frames(scenario: Scenario) -> Iterator[Frame]:
    """All windows of a run; events at fixed times, every value a function of time alone."""
    window = scenario.window_ns
    for k in range(1, scenario.duration_ns // window + 1):
        t = k * window / 1e9
        yield Frame(
            k * window,
            sheet(scenario, t),
            blocks(scenario, t),
            load(t),
            tuple(events(k * window, window)),
            {"mass_error": 1e-12 * t, "energy_residual": 2.0 * t, "rubble_mass": 8.46e5 * max(t - 6.0, 0.0)},
        )


def load(t: float) -> np.ndarray:
    """Breaking builds up to the events and drops, rotating follows, sliding rises and swings with 2.5 s."""
    breaking = 1.35e6 * t if t <= CIRCUMFERENTIAL else 2.0e6 * (1 + math.sin(2 * math.pi * t / 2.5))
    rotating = 4.0e6 * math.exp(-(((t - 8.0) / 1.2) ** 2))
    sliding = 3.0e6 * min(max(t - 7.0, 0.0) / 5.0, 1.0)
    direction = np.array([1.0, 0.02, 0.84])
    return np.outer([breaking, rotating, sliding], direction)


def events(t_ns: int, window: int) -> Iterator[Event]:
    for time, kind, cells, text in [
        (SPLIT, "split", 24, "the sheet falls into two parts"),
        (CIRCUMFERENTIAL, "circumferential", 31, "two pieces of 14 m break off"),
        (HAND_OVER, "hand_over", 0, "2 fragments become 18 blocks"),
    ]:
        at = round(time * 1e9)
        if t_ns - window < at <= t_ns:
            yield Event(at, kind, tuple(load(time).sum(axis=0)), cells, (-18.0, 0.0, 0.1), text)


def sheet(scenario: Scenario, t: float) -> SheetView:
    (nx, ny), d, h = scenario.sheet.nodes, scenario.sheet.spacing, scenario.ice.thickness
    row, column = np.divmod(np.arange(nx * ny), ny)
    x = -15.5 + scenario.drift.velocity * t * 5 - row * d
    y = column * d - scenario.sheet.axis
    reach = np.hypot(x, y)
    dip = -min(t, CIRCUMFERENTIAL) / CIRCUMFERENTIAL * np.exp(-np.maximum(reach - 15, 0) / 15)
    z = h * (0.5 - scenario.ice.density / scenario.water.density) + dip
    near = reach < (24.0 if t >= CIRCUMFERENTIAL else 15.0)
    cell_row, cell_column = np.divmod(np.arange((nx - 1) * (ny - 1)), ny - 1)
    crack = (cell_column == (ny - 1) // 2) & (cell_row < nx * max(t - SPLIT + 1, 0) / 4)
    corner = cell_row * ny + cell_column
    intact = ~crack & ~(near[corner] | near[corner + ny] | near[corner + 1] | near[corner + ny + 1])
    utilisation = np.clip(1.1 * np.exp(-np.maximum(reach - 16, 0) / 25) * min(t / CIRCUMFERENTIAL, 1), 0, 1)
    damage = np.where(np.isin(np.arange(nx * ny), np.concatenate([corner[crack], corner[crack] + 1])), 0.5, 0.0)
    return SheetView(np.stack([x, y, z], axis=1), damage, utilisation, ~near, intact, (nx, ny), (nx - 1, ny - 1))


def blocks(scenario: Scenario, t: float) -> BlockTable:
    """Two rows of blocks that slide down the cone, turned to its slope; the upper row still rotates."""
    if t < HAND_OVER:
        return BlockTable.empty()
    h, sections = scenario.ice.thickness, np.arange(-4, 5)
    s = 0.25 * (t - HAND_OVER)
    centre, angle, phase, outline = [], [], [], []
    for y in 5.6 * sections:
        surface = -math.sqrt(max(24.0**2 - y**2, 9.0)) + 6.0
        for k, (depth, turn) in enumerate([(2.5 + s, 0.35), (8.0 + s, math.pi / 4)]):
            c = np.array([surface - 3.0 + 0.8 * depth, -depth])
            box = np.array([(-3.5, -h / 2), (3.5, -h / 2), (3.5, h / 2), (-3.5, h / 2)])
            turned = box @ np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
            centre.append((c[0], y, c[1]))
            angle.append(-turn)
            phase.append(Phase.ROTATING if k == 0 else Phase.SLIDING)
            outline.append(turned + c)
    n = len(centre)
    zero = np.zeros((n, 3))
    return BlockTable(
        np.arange(n),
        np.rint((np.array(centre)[:, 1] + scenario.sheet.axis) / scenario.sheet.spacing).astype(np.int64),
        np.array(phase, np.int64),
        np.full(n, 7 * h * 5.2 * 846),
        np.full(n, 5.2),
        np.array(centre),
        np.array([(math.cos(a / 2), 0.0, -math.sin(a / 2), 0.0) for a in angle]),
        np.array(angle),
        zero,
        np.zeros(n),
        zero,
        np.full((n, 3), np.nan),
        np.concatenate(outline),
        4 * np.arange(n + 1),
    )
