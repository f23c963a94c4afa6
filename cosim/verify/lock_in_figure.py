"""The figure of the case `lock-in`."""

from __future__ import annotations

from typing import Any

import numpy as np

from coupling.interface import Array


def draw(sheet: Any, p: dict[str, Any], still: Any, found: list[Any], curves: Array) -> None:
    """Amplifications of displacement and load, and the frequency of breaking, over f_1 / f_b.

    ``curves`` (n, 3): ratio, deviation and largest displacement [m] under the load of the cone that stood still.
    """
    r, k, f_b = np.array(p["ratios"]), p["stiffness"], still.breaking or 1.0
    ways, loads, breaks = sheet.subplots(3, 1, sharex=True, height_ratios=(2.2, 1.2, 1.2))
    for column, name, size, colour in (
        (1, "deviation", still.load_deviation, "tab:blue"),
        (2, "largest", still.load_largest, "tab:red"),
    ):
        size = size or 1.0
        coupled = np.array([getattr(a, name) for a in found])
        ways.plot(curves[:, 0], curves[:, column] * k / size, color=colour, lw=1.0)
        ways.plot(r, coupled * k / size, "o", color=colour, label=f"displacement, {name}")
        load = np.array([getattr(a, f"load_{name}") for a in found])
        loads.plot(r, load / size, "o", color=colour, label=f"load, {name}")
    ways.set(ylabel="over $F/k$ of the cone at rest", ylim=(0, None))
    ways.legend(fontsize=8, title="dots: coupled; line: load of the cone at rest", title_fontsize=8)
    loads.axhline(1.0, color="0.6", lw=0.8)
    loads.set(ylabel="over cone at rest", ylim=(0, None))
    loads.legend(fontsize=8)
    told = np.array([a.breaking / f_b if a.breaking else np.nan for a in found])
    breaks.plot(r, told, "ko", label="coupled run")
    breaks.plot(curves[:, 0], curves[:, 0], color="tab:green", lw=1.0, label="$f_1$: locked in")
    breaks.axhline(1.0, color="0.6", lw=0.8)
    breaks.set(ylabel="breaking / $f_b$", xlabel="$f_1 / f_b$", xscale="log", ylim=(0, 3.2))
    breaks.set_xticks(ticks := [0.5, 0.7, 1.0, 1.4, 2.0, 2.8, 4.0], [f"{x:g}" for x in ticks])
    breaks.minorticks_off()
    breaks.legend(fontsize=8)
