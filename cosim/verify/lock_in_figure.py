"""The figure of the case `lock-in`, and its numbers over the draws."""

from __future__ import annotations

from typing import Any

import numpy as np

from coupling.interface import Array


def told(draws: list[Any], name: str) -> Array:
    """(draws, ratios) of what the coupled runs came to."""
    return np.array([[getattr(a, name) for a in d.found] for d in draws])


def ratio_of(draws: list[Any], name: str, over: str = "") -> Array:
    """(draws, ratios) over what the cone at rest came to in the same draw: the same thing, or ``over``."""
    rest = np.array([getattr(d.still, over or name) or 1.0 for d in draws])
    ratio: Array = told(draws, name) / rest[:, None]
    return ratio


def draw(sheet: Any, p: dict[str, Any], f_b: float, draws: list[Any]) -> None:
    """Amplifications of displacement and load, and the frequency of breaking, over f_1 / f_b: median and all draws."""
    r, k = np.array(p["ratios"]), p["stiffness"]
    ways, loads, breaks = sheet.subplots(3, 1, sharex=True, height_ratios=(2.2, 1.2, 1.2))
    for column, name, side, look in ((1, "deviation", 0.985, BLUE), (2, "largest", 1.015, ORANGE)):
        alone = np.array([d.curves[:, column] * k / (getattr(d.still, f"load_{name}") or 1.0) for d in draws])
        line = draws[0].curves[:, 0]
        ways.plot(line, np.median(alone, axis=0), color=look["color"], lw=1.0)
        ways.fill_between(line, alone.min(axis=0), alone.max(axis=0), color=look["color"], alpha=0.15, lw=0.0)
        _dots(ways, r * side, k * ratio_of(draws, name, f"load_{name}"), f"displacement, {name}", look)
        _dots(loads, r * side, ratio_of(draws, f"load_{name}"), f"load, {name}", look)
    loads.axhline(1.0, color="0.6", lw=0.8)
    ways.set(ylabel="over $F/k$ of the cone at rest", ylim=(0, None))
    loads.set(ylabel="over cone at rest", ylim=(0, None))
    title = "dots: coupled, median and range of the draws\nlines: under the load of the cone at rest"
    ways.legend(fontsize=8, title=title, title_fontsize=8)
    loads.legend(fontsize=8, ncols=2)
    _breaking(breaks, r, told(draws, "breaking") / f_b)


BLUE = {"color": "#0072b2", "marker": "o"}
ORANGE = {"color": "#d55e00", "marker": "s"}


def _dots(ax: Any, r: Array, values: Array, label: str, look: dict[str, str]) -> None:
    """Median of the draws, with a bar from the least to the largest; NaN: not in this draw."""
    seen = np.isfinite(values).any(axis=0)
    r, values = r[seen], values[:, seen]
    middle = np.nanmedian(values, axis=0)
    reach = np.array([middle - np.nanmin(values, axis=0), np.nanmax(values, axis=0) - middle])
    ax.errorbar(r, middle, yerr=reach, fmt=look["marker"], ms=5, color=look["color"], lw=1.0, capsize=2, label=label)


def _breaking(ax: Any, r: Array, values: Array) -> None:
    _dots(ax, r, np.where(values > 0.0, values, np.nan), "coupled run", {"color": "k", "marker": "o"})
    line = np.geomspace(0.4, 4.5, 61)
    ax.plot(line, line, color="#009e73", lw=1.0, ls="--", label="$f_1$: locked in")
    ax.axhline(1.0, color="0.6", lw=0.8)
    ax.set(ylabel="breaking / $f_b$", xlabel="$f_1 / f_b$", xscale="log", ylim=(0, 3.2))
    ax.set_xticks(ticks := [0.5, 0.7, 1.0, 1.4, 2.0, 2.8, 4.0], [f"{x:g}" for x in ticks])
    ax.minorticks_off()
    ax.legend(fontsize=8)
