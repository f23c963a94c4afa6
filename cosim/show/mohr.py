"""The stresses of the cells in the plane of Mohr's circle, with the lines on which the scenario's criteria are met."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from cosim.show.png import picture
from cosim.show.scale import STEPS, Scale
from cosim.stresses import Stresses
from coupling.interface import BoolArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

USED, BEGAN, BESIDE = "#8a94a0", "#0072b2", "#d55e00"
#: equations of the thesis (van Vliet 2018) by the name of a criterion
EQUATIONS = {
    "tension": "(4.6)",
    "compression": "(4.5)",
    "spalling": "(4.9)",
    "bending-top": "(4.14)",
    "bending-bottom": "(4.14)",
    "upward-bending": "(4.15)",
    "downward-bending": "(4.16)",
    "combined-tension": "(4.6) with (4.17)-(4.20)",
    "combined-compression": "(4.5) with (4.17)-(4.20)",
    "principal-stress": "largest principal stress",
    "crack-tip-splitting": "(4.23)",
    "crack-tip-bending": "(4.31)",
}
Recorded = tuple[Stresses | None, Stresses | None]  #: at which cells began to crack, of the most used ones
NEAR = 0.02  #: of the line, as share of the limit
ALIKE = 5e-3  #: limits that differ by less are drawn as one line: they are recorded to 12 binary digits


def draw_mohr(figure: Figure, began: Stresses | None, worst: Stresses | None) -> None:
    """Grey: the most used cells of all recorded frames; filled: cells that begin to crack, on their lines or beyond."""
    shown = [part for part in (worst, began) if part is not None]
    if not shown:
        return
    strength = min(line.strength for line in shown[0].lines.values())
    scale = scale_for(strength)
    ax = figure.subplots()
    frame = extent(shown, strength)
    _quadrants(ax, frame, scale)
    if worst is not None:
        label = "most used cells of the recorded frames"
        ax.plot(worst.mean / scale.size, worst.radius / scale.size, ".", ms=2.0, mew=0, color=USED, label=label)
        ax.lines[-1].set_rasterized(True)
    if began is not None:
        _began(ax, began, frame, scale)
    _envelopes(ax, shown, frame, scale)
    x0, x1, top = (edge / scale.size for edge in frame)
    mean, radius = "\\sigma_1 + \\sigma_2", "\\sigma_1 - \\sigma_2"
    ax.set(xlim=(x0, x1), ylim=(0.0, top), aspect="equal")
    ax.set_xlabel(f"mean of the principal stresses, $({mean})/2$ [{scale.unit}]")
    ax.set_ylabel(f"radius of the circle, $({radius})/2$ [{scale.unit}]")
    ax.grid(alpha=0.25)
    legend = figure.legend(loc="outside right upper", fontsize=8, frameon=False)
    for handle in legend.legend_handles[: worst is not None]:
        handle.set_markersize(6.0)  # type: ignore[union-attr]


def mohr_picture(began: Stresses | None, worst: Stresses | None) -> dict[str, str] | None:
    """For a page, with its caption; None where nothing is recorded."""
    if began is None and worst is None:
        return None
    title = "Stresses of the cells in the plane of Mohr's circle, with the failure envelope"
    return picture(title, draw_mohr, began, worst, caption=caption(began))


def caption(began: Stresses | None) -> str:
    """What is seen, for somebody who has not read the thesis."""
    text = (
        "Every point is a cell, at the face of the ice where it is used most: to the right the mean of its two "
        "principal stresses, up half their difference, tension positive. A cell begins to crack where its point "
        "reaches the line of its criterion (numbers of equations: van Vliet 2018, chapter 4); curvature is scaled by "
        "sigma_t / sigma_f, (4.17)-(4.20). Dotted: one of the principal stresses is zero. "
    )
    if began is None:
        return text + "No cell began to crack."
    on = int((np.abs(began.utilisation - 1.0) <= NEAR).sum())
    return text + (
        f"Of {len(began.cell)} cells that began to crack, {on} were found within {NEAR:.0%} of their line; those "
        "farther out took over the load of a neighbour in the same instant, or bore more than it when the run began."
    )


def scale_for(strength: float) -> Scale:
    """Of stresses: kPa below 1 MPa."""
    size, unit = next(step for step in STEPS["Pa"] if strength >= step[0] or step is STEPS["Pa"][-1])
    return Scale(size, unit, 2)


def extent(shown: list[Stresses], strength: float) -> tuple[float, float, float]:
    """What is drawn: mean from, to, radius to [Pa]; 99 of 100 points, at least around the strength."""
    mean, radius = (np.concatenate([getattr(part, name) for part in shown]) for name in ("mean", "radius"))
    low = min(float(np.quantile(mean, 0.01)) if len(mean) else 0.0, -0.5 * strength)
    high = max(float(np.quantile(mean, 0.99)) if len(mean) else 0.0, strength)
    top = max(float(np.quantile(radius, 0.99)) if len(radius) else 0.0, strength)
    return max(low, -3.0 * strength) * 1.1, min(high, 2.0 * strength) * 1.1, min(top, 2.0 * strength) * 1.15


def beside_tips(began: Stresses) -> BoolArray:
    """Cells (n,) whose limit is another one than the strength of mean ice, as beside a crack tip."""
    strength = np.array([line.strength for line in began.lines.values()])[began.criterion]
    return np.asarray(np.abs(began.limit / strength - 1.0) > ALIKE, bool)


def _began(ax: Axes, began: Stresses, frame: tuple[float, float, float], scale: Scale) -> None:
    beside, (x0, x1, top) = beside_tips(began), frame
    s, t = began.mean, began.radius
    out = int(((s < x0) | (s > x1) | (t > top)).sum())
    more = f"\n({out} of {len(s)} beyond the picture)" if out else ""
    look: dict[str, Any] = {"ls": "", "ms": 4.5, "mew": 0.7, "zorder": 5}
    at: dict[str, Any] = {"marker": "o", "mfc": BEGAN, "mec": "w", "label": f"cells that begin to crack{more}"}
    text = "the same, with another limit\nof their own (crack tip, weaker ice)"
    tip: dict[str, Any] = {"marker": "^", "mfc": "w", "mec": BESIDE, "label": text}
    for chosen, kind in ((~beside, at), (beside, tip)):
        if chosen.any():
            ax.plot(s[chosen] / scale.size, t[chosen] / scale.size, **look, **kind)


def _envelopes(ax: Axes, shown: list[Stresses], frame: tuple[float, float, float], scale: Scale) -> None:
    """A line for every criterion at its strength, and for the lowest other limit at which a cell fails."""
    styles = iter(("-", (0, (6, 2)), (0, (1, 1.5)), (0, (5, 2, 1, 2)), (0, (3, 1, 1, 1, 1, 1))) * 3)
    for number, (name, line) in enumerate(shown[0].lines.items()):
        limits = np.concatenate([part.limit[part.criterion == number] for part in shown])
        other = limits[np.abs(limits / line.strength - 1.0) > ALIKE]
        text = f"{name}\n{EQUATIONS.get(name, '')}, {line.strength / scale.size:.3g} {scale.unit}"
        a, b = line.along_mean, line.along_radius
        _line(ax, (a, b, line.strength), frame, scale, color="k", ls=next(styles), label=text)
        if len(other):
            low = float(other.min())
            text = f"lowest other limit, {low / scale.size:.3g} {scale.unit}"
            _line(ax, (a, b, low), frame, scale, color=BESIDE, ls="--", label=text)


def _line(
    ax: Axes, line: tuple[float, float, float], frame: tuple[float, float, float], scale: Scale, **look: Any
) -> None:
    """Where a s + b t = limit."""
    a, b, limit = line
    if b == 0.0:
        ax.axvline(limit / a / scale.size, lw=1.3, zorder=4, **look)
        return
    s = np.array(frame[:2])
    ax.plot(s / scale.size, (limit - a * s) / b / scale.size, lw=1.3, zorder=4, **look)


def _quadrants(ax: Axes, frame: tuple[float, float, float], scale: Scale) -> None:
    """The lines on which a principal stress is zero, and what lies between them."""
    top = frame[2] / scale.size
    for side in (-1.0, 1.0):
        ax.plot([0.0, side * top], [0.0, top], color="#51606f", lw=0.7, ls=(0, (2, 3)), zorder=1)
    low, high = frame[0] / scale.size, frame[1] / scale.size
    for x, y, text, place in (
        (0.75 * high, 0.04 * top, "both tension", "right"),
        (0.5 * low, 0.6 * top, "one tension,\none compression", "center"),
        (low, 0.04 * top, " both compression", "left"),
    ):
        ax.text(x, y, text, ha=place, va="top" if y > 0.5 * top else "bottom", fontsize=8, color="#51606f", zorder=6)
