"""Strength, thickness and Young's modulus of each cell over their values in the scenario.

A field is drawn as a Gaussian one with mean 0 and variance 1, at the middles of the cells, by the randomization method
(GSTools: Mueller et al. 2022), and each value is replaced by the one of the wanted distribution that is as likely not
to be exceeded. Mean and variation are those of the distribution: a sample of a sheet that is not much longer than the
correlation length has others. Each of the three has a seed of its own that follows from that of the scenario.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from scipy import optimize, stats
from scipy.interpolate import LinearNDInterpolator
from scipy.spatial import QhullError
from scipy.special import gamma

from cosim.errors import InputError
from cosim.ice.columns import numbers, read_table
from cosim.scenario.scenario import Scenario
from cosim.scenario.variation import FIELDS, FieldSection
from coupling.interface import Array
from lattice.grid import Grid
from lattice.varied import Varied

EDGE = 0.51  #: of a cell: a file may end so far from the middle of a cell outside of its points


def varied(scenario: Scenario, grid: Grid) -> Varied | None:
    """What the scenario says of the cells of its sheet; None: they are all alike."""
    if not any(getattr(scenario.ice, name) for name in FIELDS):
        return None
    return Varied(*(of_cells(scenario, name, grid) for name in FIELDS))


def of_cells(scenario: Scenario, name: str, grid: Grid) -> Array:
    """One field of `FIELDS` over its value in the scenario, (cells,)."""
    field: FieldSection | None = getattr(scenario.ice, name)
    if field is None:
        return np.ones(grid.cells)
    if field.file:
        return from_file((scenario.folder or Path()) / field.file, FIELDS[name], middles(grid), grid.d)
    return drawn(f"ice.{name}", field, middles(grid), seed_of(scenario.seed, list(FIELDS).index(name)))


def middles(grid: Grid) -> Array:
    """Middles of the cells from the rear corner y_min of the sheet, (cells, 2) [m]."""
    i, j = np.divmod(np.arange(grid.cells), grid.ny - 1)
    return np.column_stack((i + 0.5, j + 0.5)) * grid.d


def seed_of(seed: int, number: int) -> int:
    """Of the field of this number in `FIELDS`: another one for each, and for each seed of a scenario."""
    return int(np.random.SeedSequence([seed, number]).generate_state(1)[0])


def drawn(name: str, field: FieldSection, xy: Array, seed: int) -> Array:
    """A field of mean 1 at places xy (cells, 2) [m], (cells,)."""
    if field.variation is None or field.variation == 0.0:
        return np.ones(len(xy))
    values = DISTRIBUTIONS[field.distribution](gaussian(field, xy, seed), field.variation)
    if not values.min() > 0.0:
        raise InputError(
            f"{name}: a normal distribution of variation {field.variation:g} gives a cell {values.min():.2g} of the "
            "mean; use lognormal or weibull, or a smaller variation"
        )
    return values


def gaussian(field: FieldSection, xy: Array, seed: int) -> Array:
    """Mean 0, variance 1, correlated as the field says, (cells,)."""
    if field.correlation_length == 0.0:
        return np.random.default_rng(seed).standard_normal(len(xy))
    import gstools

    gstools.config.NUM_THREADS = 1
    kind = gstools.Exponential if field.correlation == "exponential" else gstools.Gaussian
    made: Any = gstools.SRF(kind(dim=2, var=1.0, len_scale=field.correlation_length), seed=seed)
    return np.asarray(made((xy[:, 0], xy[:, 1]), mesh_type="unstructured"), np.float64)


def _lognormal(z: Array, variation: float) -> Array:
    s2 = np.log1p(variation**2)
    return np.asarray(np.exp(np.sqrt(s2) * z - 0.5 * s2))


def _normal(z: Array, variation: float) -> Array:
    return np.asarray(1.0 + variation * z)


def _weibull(z: Array, variation: float) -> Array:
    shape = weibull_shape(variation)
    return np.asarray(stats.weibull_min.isf(stats.norm.sf(z), shape) / gamma(1.0 + 1.0 / shape))


def weibull_shape(variation: float) -> float:
    """Shape k with Gamma(1 + 2/k) / Gamma(1 + 1/k)^2 = 1 + variation^2."""

    def excess(k: float) -> float:
        return float(gamma(1.0 + 2.0 / k) / gamma(1.0 + 1.0 / k) ** 2 - 1.0 - variation**2)

    return float(optimize.brentq(excess, 0.5, 2000.0, xtol=1e-12))


DISTRIBUTIONS: dict[str, Callable[[Array, float], Array]] = {
    "lognormal": _lognormal,
    "normal": _normal,
    "weibull": _weibull,
}


def from_file(path: Path, column: str, xy: Array, d: float) -> Array:
    """A column of a table at places xy (cells, 2), linear between its points; InputError where these do not reach."""
    table = read_table(path, ("x", "y", column))
    x, y, values = (numbers(path, table, name) for name in ("x", "y", column))
    if not values.min() > 0.0:
        row = int(np.argmin(values)) + 1
        raise InputError(f"{path}: row {row} has {column} = {values.min():g}; it is over the value in [ice], above 0")
    base = float(values[0])  # of equal values the mean is that value to the last bit
    try:
        between = LinearNDInterpolator(np.column_stack((x, y)), values - base)
    except (QhullError, ValueError):
        raise InputError(f"{path}: its points span no area; give at least three that are not in a line") from None
    found = np.asarray(between(xy), np.float64)
    outside = np.isnan(found)
    if outside.any():
        found[outside] = between(_pulled_in(xy[outside], x, y, EDGE * d))
    if np.isnan(found).any():
        at = xy[np.isnan(found)][0]
        raise InputError(
            f"{path}: {np.isnan(found).sum()} cells of the sheet lie outside of its points, the first at "
            f"x = {at[0]:g} m, y = {at[1]:g} m from the rear corner; give points up to the edges"
        )
    return base + found


def _pulled_in(xy: Array, x: Array, y: Array, most: float) -> Array:
    """Places moved by at most ``most`` [m] along each axis into the box of the points."""
    box = np.clip(xy, (x.min(), y.min()), (x.max(), y.max()))
    return np.where(np.abs(box - xy) <= most, box, xy)
