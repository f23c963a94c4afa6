"""Designs: from the values that may vary to the variants that run.

one-at-a-time: the base, then each value on its own. grid: the base, then every combination. random: points drawn evenly
from the ranges. sobol: Saltelli's points for first-order and total indices, ``samples`` (keys + 2) of them
(Saltelli et al. 2010, by SALib). Each variant runs with every seed.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from cosim.errors import InputError
from cosim.study.variants import SEED, Axis, Range, Variant
from coupling.interface import Array

Name = Literal["one-at-a-time", "grid", "random", "sobol"]
SAMPLED = ("random", "sobol")  #: designs that draw from ranges
MOST = 1_000_000  #: variants of one sweep


@dataclass(frozen=True)
class Design:
    """What a sweep runs."""

    name: Name = "one-at-a-time"
    samples: int = 64  #: of random; of sobol, of which it makes ``samples`` (keys + 2) points
    draw: int = 0  #: seed of the drawing of points; not that of the runs
    seeds: int | None = None  #: how many seeds each variant runs with, from that of the scenario on; None: its own

    def check(self, axes: Sequence[Axis | Range]) -> None:
        """InputError where axes and design do not go together."""
        keys = [axis.key for axis in axes]
        if len(set(keys)) < len(keys):
            raise InputError(f"--vary: {max(keys, key=keys.count)} is given twice; put all its values into one --vary")
        if not axes and (self.seeds is None or self.name in SAMPLED):
            raise InputError("nothing varies; give --vary section.key=value,value or --seeds 32")
        if self.seeds is not None and SEED in keys:
            raise InputError(f"--seeds and --vary {SEED} exclude each other; give one of them")
        for axis in axes:
            if self.name in SAMPLED and isinstance(axis, Axis):
                raise InputError(
                    f"--vary {axis.key}: --design {self.name} draws from a range; write {axis.key}=low..high"
                )
            if self.name not in SAMPLED and isinstance(axis, Range):
                raise InputError(f"--vary {axis.key}: a range needs --design random or --design sobol; or list values")
        if self.name == "sobol" and self.samples & (self.samples - 1):
            raise InputError(f"--samples {self.samples}: the points of sobol come in powers of 2; use 64 or 128")

    def variants(self, axes: Sequence[Axis | Range], seed: int) -> list[Variant]:
        """All of them; ``seed`` is that of the base."""
        self.check(axes)
        bare = [Variant(changes) for changes in self._changes(axes)]
        count = len(bare) * (self.seeds or 1)
        if count > MOST:
            raise InputError(f"{count} variants are more than {MOST}; take fewer samples, values or seeds")
        if self.seeds is None:
            return bare
        return [Variant((*v.changes, (SEED, str(seed + k)))) for v in bare for k in range(self.seeds)]

    def _changes(self, axes: Sequence[Axis | Range]) -> list[tuple[tuple[str, str], ...]]:
        ranges = [axis for axis in axes if isinstance(axis, Range)]
        if self.name in SAMPLED:
            rows = self.points(ranges).tolist()
            return [tuple((r.key, r.text(x)) for r, x in zip(ranges, row, strict=True)) for row in rows]
        choices = [[(axis.key, value) for value in axis.values] for axis in axes if isinstance(axis, Axis)]
        if self.name == "grid" and choices:
            return [(), *itertools.product(*choices)]
        return [(), *((change,) for choice in choices for change in choice)]

    def points(self, ranges: Sequence[Range]) -> Array:
        """What a sampled design draws, (points, ranges) [SI]."""
        if self.name == "sobol":
            from SALib.sample import sobol

            return np.asarray(sobol.sample(problem(ranges), self.samples, calc_second_order=False, seed=self.draw))
        share = np.random.default_rng(self.draw).random((self.samples, len(ranges)))
        low, high = np.array([(r.low, r.high) for r in ranges]).T
        return np.asarray(low + share * (high - low))


def problem(ranges: Sequence[Range]) -> dict[str, Any]:
    """Ranges as SALib takes them."""
    return {"num_vars": len(ranges), "names": [r.key for r in ranges], "bounds": [[r.low, r.high] for r in ranges]}
