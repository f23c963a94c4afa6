"""Picture of an ensemble: the distribution of each quantity over its runs, beside what was measured."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cosim.errors import FailedError
from cosim.show.scale import scale_of
from cosim.study.task import FEATURE

COLOURS = ("#2f7ebc", "#e6812b", "#00a37a", "#8b5fbf", "#b04a4a", "#5a6b7b")
MOST = 6  #: groups that are told apart
COLUMNS = 3


def ensemble(content: dict[str, Any], out: Path) -> None:
    """Share of runs above a value, one curve for each group: median and 5 to 95 % marked, the measured value dashed."""
    ran = [row for row in content["variants"] if row["error"] is None]
    groups = list(dict.fromkeys(row["group"] for row in ran))
    told = {(row["group"], row["quantity"]): row for row in content["ensembles"] if row["n"] > 1}
    names = [q for q in dict.fromkeys(q for _, q in told) if q != "f_peak"]
    if not names:
        raise FailedError(f"{out}: not drawn: no group has two runs that ended")
    if len(groups) > MOST:  # points of a sampled design: one distribution over all of them
        raise FailedError(f"{out}: not drawn: {len(groups)} groups are more than {MOST}; draw them from the table")
    rows = -(-len(names) // COLUMNS)
    figure = Figure(figsize=(4.2 * min(COLUMNS, len(names)), 3.2 * rows + 0.6), layout="constrained")
    axes = figure.subplots(rows, min(COLUMNS, len(names)), squeeze=False).ravel()
    for ax, name in zip(axes, names, strict=False):
        _exceedance(ax, name, groups, ran, told)
    for ax in axes[len(names) :]:
        ax.set_axis_off()
    title = f"{content['scenario']}: {len(ran)} runs; dots: 5 %, median, 95 %; dashed: measured"
    figure.suptitle(title, fontsize=10, parse_math=False)
    figure.savefig(out, dpi=130)


def _exceedance(ax: Axes, name: str, groups: list[str], ran: list[dict[str, Any]], told: dict[Any, Any]) -> None:
    some = [told[g, name] for g in groups if (g, name) in told]
    scale = scale_of([x for row in some for x in (row["p95"], row.get("measured"))], some[0]["unit"])
    for colour, group in zip(COLOURS, groups, strict=False):
        row = told.get((group, name))
        if row is None:
            continue
        column = name if name.endswith("_peak") and name in ran[0] else FEATURE + name
        values = sorted(r[column] for r in ran if r["group"] == group and r.get(column) is not None)
        x = np.array([*values, values[-1]]) / scale.size
        above = np.linspace(1.0, 0.0, len(x))
        ax.step(x, above, where="pre", color=colour, lw=1.2, label=group)
        marks = np.array([row["p05"], row["median"], row["p95"]]) / scale.size
        ax.plot(marks, [0.95, 0.5, 0.05], "o", ms=4, color=colour)
    ends = some[0].get("measured_range") or ([some[0]["measured"]] if some[0]["measured"] is not None else [])
    for end in ends:
        ax.axvline(end / scale.size, color="k", ls="--", lw=1.0)
    ax.set_xlabel(f"{name} [{scale.unit}]", parse_math=False)
    ax.set_ylabel("share of runs above")
    ax.set_ylim(0.0, 1.03)
    ax.grid(alpha=0.3)
    if len(groups) > 1:
        ax.legend(fontsize=7)
