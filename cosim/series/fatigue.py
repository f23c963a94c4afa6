"""Load cycles by rainflow counting (ASTM E1049-85), and the damage-equivalent load."""

from __future__ import annotations

import numpy as np
import rainflow

from coupling.interface import Array


def cycles(y: Array) -> tuple[Array, Array, Array]:
    """Ranges (m,) [N], means (m,) [N] and counts (m,), 0.5 or 1, of all cycles of ``y`` (n,).

    ASTM E1049-85 (2017), 5.4.4: what is not closed counts half. The package `rainflow` counts.
    """
    found = np.array([cycle[:3] for cycle in rainflow.extract_cycles(y)]).reshape(-1, 3)
    return found[:, 0], found[:, 1], found[:, 2]


def damage_equivalent_load(y: Array, duration: float, wohler: float, rate: float) -> float | None:
    """``(sum n_i S_i^m / (rate duration))^(1/m)`` [N]: the range that does the same damage ``rate`` times a second.

    Palmgren-Miner with an S-N curve of slope m = ``wohler`` (Freebody and Musial 2000, NREL/TP-500-27860). Range 0 and
    above. None without a cycle.
    """
    ranges, _, counts = cycles(y)
    if not len(ranges) or duration <= 0.0:
        return None
    largest = float(ranges.max())
    if largest == 0.0:
        return None
    damage = float(np.sum(counts * (ranges / largest) ** wohler)) / (rate * duration)
    return float(largest * damage ** (1.0 / wohler))


def cycle_rate(y: Array, duration: float, least: float) -> float:
    """Cycles per second with a range of at least ``least`` [N], half cycles as half [Hz]."""
    ranges, _, counts = cycles(y)
    return float(counts[ranges >= least].sum()) / duration
