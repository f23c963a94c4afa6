"""Picture of a sweep: how far each value moves the largest load away from the base."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cosim.errors import FailedError
from cosim.show.cells import over_text
from cosim.show.scale import scale_of
from cosim.study.task import Row


def tornado(content: dict[str, Any], out: Path) -> None:
    """Peaks of Fx and Fz of every variant as bars from the base, the widest key on top."""
    rows = [row for row in content["variants"] if row["error"] is None and row["variant"] != "base"]
    base = content["variants"][0]
    if base["error"] is not None or not rows:
        raise FailedError(f"{out}: not drawn: it needs the base and at least one variant that ran")
    groups = _by_key(rows, content["keys"])
    figure = Figure(figsize=(9.0, 1.2 + 0.32 * len(rows) + 0.15 * len(groups)), layout="constrained")
    for ax, c in zip(figure.subplots(1, 2, sharey=True), ("fx", "fz"), strict=True):
        _bars(ax, groups, float(base[f"{c}_peak"]), c)
    over = over_text(base["averaging_s"])
    title = f"{content['scenario']}: peaks of the mean over {over}, bars begin at the base"
    figure.suptitle(title, fontsize=10, parse_math=False)
    figure.savefig(out, dpi=130)


def _by_key(rows: list[Row], keys: list[str]) -> list[list[Row]]:
    """Rows that vary the same keys together, the ones that change Fx most first."""
    groups: dict[tuple[str, ...], list[Row]] = {}
    for row in rows:
        groups.setdefault(tuple(key for key in keys if key in row), []).append(row)
    return sorted(groups.values(), key=lambda g: -max(abs((row["fx_ratio"] or 1.0) - 1.0) for row in g))


def _bars(ax: Axes, groups: list[list[Row]], base: float, component: str) -> None:
    place, labels = 0.0, []
    scale = scale_of([base, *(row[f"{component}_peak"] for group in groups for row in group)], "N")
    base /= scale.size
    for group in groups:
        for row in group:
            peak = row[f"{component}_peak"] / scale.size
            ax.barh(-place, peak - base, left=base, height=0.8, color="#e6812b" if peak > base else "#2f7ebc")
            ax.annotate(
                f"{peak:.{scale.decimals}f}",
                (peak, -place),
                xytext=(3 if peak >= base else -3, 0),
                fontsize=7,
                va="center",
                textcoords="offset points",
                ha="left" if peak >= base else "right",
            )
            labels.append((-place, row["variant"]))
            place += 1.0
        place += 0.5
    ax.axvline(base, color="k", lw=0.8)
    ax.set_yticks([p for p, _ in labels], [name for _, name in labels], fontsize=8, parse_math=False)
    ax.set_xlabel(f"{component.capitalize()} [{scale.unit}], base {base:.{scale.decimals}f}")
    ax.margins(x=0.2)
    ax.grid(axis="x", alpha=0.3)
