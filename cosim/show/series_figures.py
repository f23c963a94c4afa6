"""Figures of a run beside a measured series: laid on each other, alignment, exceedance, spectra, scatter.

They are drawn on a figure of matplotlib (extra ``report``). Simulated blue, measured orange.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from cosim.series.compare import Comparison, Pair
from cosim.series.peaks import exceedance
from cosim.series.spectra import spectrum
from cosim.series.told import count
from cosim.show.cells import over_text
from cosim.show.scale import Scale, scale_of
from coupling.interface import Array

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SIMULATED, MEASURED = "#2f7ebc", "#e6812b"


def draw_overlay(figure: Figure, c: Comparison, pair: Pair) -> None:
    """Both over the time of the run, the peaks that are counted as dots; grey: not compared."""
    ax = figure.subplots()
    name = pair.component
    scale = _scale(pair)
    for series, look, colour, label in (
        (c.measured, pair.measured, MEASURED, "measured"),
        (c.simulated, pair.simulated, SIMULATED, "simulated"),
    ):
        ax.plot(series.t, series.loads[name] / scale.size, color=colour, lw=1.0, label=label)
        ax.plot(look.t[look.peaks], look.sign * look.y[look.peaks] / scale.size, "o", color=colour, ms=4)
    begin, end = pair.t[0], pair.t[-1]
    margin = 0.1 * (end - begin)
    low, high = begin - margin, end + margin
    ax.axvspan(low, begin, color="#9a9fa6", alpha=0.25, lw=0)
    ax.axvspan(end, high, color="#9a9fa6", alpha=0.25, lw=0)
    ax.set(xlim=(low, high), xlabel="time of the run [s]", ylabel=_label(pair, scale))
    ax.set_title(f"series moved by {-c.alignment.shift:.3f} s; means over {over_text(c.over)}", fontsize=9)
    ax.legend(fontsize=8)
    ax.grid(alpha=0.3)


def draw_alignment(figure: Figure, c: Comparison, _pair: Pair) -> None:
    """What the shift comes from: the correlation over all shifts, or both series around what was laid on what."""
    ax, a = figure.subplots(), c.alignment
    ax.set_title(a.told, fontsize=8, wrap=True)
    ax.grid(alpha=0.3)
    if a.lags is not None and a.correlation is not None:
        ax.plot(a.lags, a.correlation, "k", lw=0.9)
        ax.axvline(a.shift, color=SIMULATED, lw=1.0)
        ax.set(xlabel="series later than the run by [s]", ylabel="correlation")
        return
    simulated, measured = c.simulated.loads[a.component], c.measured.loads[a.component]
    scale = scale_of((float(np.abs(v).max()) for v in (simulated, measured)), "N")
    ax.plot(c.measured.t, measured / scale.size, color=MEASURED, lw=1.0, label="measured")
    ax.plot(c.simulated.t, simulated / scale.size, color=SIMULATED, lw=1.0, label="simulated")
    ax.set(xlabel="time of the run [s]", ylabel=f"{a.component.capitalize()} [{scale.unit}]")
    at = a.marks[0]
    if at is not None:
        around = max(5.0 * c.over, 0.15 * float(np.ptp(c.simulated.t)))
        ax.axvline(at, color="k", lw=0.9, ls="--")
        ax.set_xlim(at - around, at + around)
    ax.legend(fontsize=8)


def draw_exceedance(figure: Figure, _c: Comparison, pair: Pair) -> None:
    """Share of the peaks that exceed a height."""
    ax, scale = figure.subplots(), _scale(pair)
    for look, colour, label in _both(pair):
        height, share = exceedance(look.y[look.peaks])
        text = f"{label}: {count(len(height), 'peak')}"
        ax.semilogy(
            look.sign * height / scale.size,
            share,
            "o-",
            color=colour,
            ms=4,
            lw=0.8,
            label=text,
        )
    ax.axvline(0.0, color="k", lw=0.6)
    ax.set(xlabel=f"peaks of {_label(pair, scale)}", ylabel="share that exceeds it")
    ax.legend(fontsize=8)
    ax.grid(alpha=0.3, which="both")


def draw_spectra(figure: Figure, _c: Comparison, pair: Pair) -> None:
    """Power spectral densities."""
    ax, scale = figure.subplots(), _scale(pair)
    shown: list[tuple[Array, Array]] = []
    for look, colour, label in _both(pair):
        frequency, density = spectrum(look.t, look.y)
        shown.append((frequency, density))
        ax.loglog(frequency[1:], density[1:] / scale.size**2, color=colour, lw=1.0, label=label)
    top = max((float(d[1:].max()) for _, d in shown if len(d) > 1), default=0.0) / scale.size**2
    if top > 0.0:
        ax.set_ylim(1e-7 * top, 3.0 * top)
    ax.set_xlim(right=min((float(f[-1]) for f, _ in shown if len(f)), default=1.0))
    ax.set(xlabel="frequency [Hz]", ylabel=f"{pair.component.capitalize()}: density [{scale.unit}^2/Hz]")
    ax.legend(fontsize=8)
    ax.grid(alpha=0.3, which="both")


def draw_scatter(figure: Figure, _c: Comparison, pair: Pair) -> None:
    """Simulated over measured at the same times, and their quantiles."""
    ax, scale = figure.subplots(), _scale(pair)
    m, s = pair.m / scale.size, pair.s / scale.size
    ax.plot(m, s, ".", color=SIMULATED, ms=3, alpha=0.35, label="same time")
    shares = np.linspace(0.0, 1.0, 101)
    ax.plot(np.quantile(m, shares), np.quantile(s, shares), color=MEASURED, lw=1.6, label="quantiles")
    ends = [float(min(m.min(), s.min())), float(max(m.max(), s.max()))]
    ax.plot(ends, ends, "k--", lw=0.8, label="equal")
    unit = _label(pair, scale)
    ax.set(xlabel=f"measured {unit}", ylabel=f"simulated {unit}", aspect="equal")
    ax.legend(fontsize=8)
    ax.grid(alpha=0.3)


def _both(pair: Pair) -> tuple[tuple[Any, str, str], ...]:
    return (pair.measured, MEASURED, "measured"), (pair.simulated, SIMULATED, "simulated")


def _scale(pair: Pair) -> Scale:
    return scale_of((float(np.abs(v).max()) for v in (pair.s, pair.m)), "N")


def _label(pair: Pair, scale: Scale) -> str:
    return f"{pair.component.capitalize()} [{scale.unit}]"


#: by name of its file
FIGURES: dict[str, tuple[str, Callable[[Any, Comparison, Pair], None]]] = {
    "overlay": ("Simulated and measured", draw_overlay),
    "alignment": ("Alignment", draw_alignment),
    "exceedance": ("Exceedance of the peaks", draw_exceedance),
    "spectra": ("Spectra", draw_spectra),
    "scatter": ("Scatter", draw_scatter),
}
