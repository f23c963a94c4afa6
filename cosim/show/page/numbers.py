"""Tables of numbers of the page: statistics, moments, the force budget with its terms explained, balances."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from cosim.analysis.budget import rows as budget_rows
from cosim.analysis.moments import moments
from cosim.analysis.run_data import RunData
from cosim.show.scale import scale_of, significant
from coupling.energy import MOVING
from coupling.interface import PHASES

STATISTICS = ("mean", "standard deviation", "half of the time below", "9 of 10 below", "99 of 100 below", "largest")
#: what the terms of the force budget are, see `coupling.budget`
MEANING = {
    "dry tops": "water displaced by blocks whose top is pressed under and not yet flooded",
    "flooded rubble": "buoyancy of the blocks as if all tops were flooded, less their weight",
    "pressed sheet": "water under the deflected sheet",
    "water above": "head on tops of the sheet that flood (against the load)",
    "water left below": "pull of a linear foundation where the bottom has left the water, taken back",
    "drag": "drag of the water on blocks and sheet",
    "inertia": "less the gain of momentum of blocks and sheet",
    "held": "supports of the sheet, the thrust of its back edge",
    "sea bed": "sea bed under grounded blocks; minus it is the force on the bed",
    "staggering": "lag between sheet and rubble, no physics",
    "residual": "what the terms miss of the total",
}
FAILURES = 4  #: instants before a failure that the budget shows
BALANCES = {
    "mass_error": ("mass: sheet, rubble, crushed, cleared against the start", 1e-12),
    "energy": ("energy that no term explains, over the work of the drift", 0.01),
}


def statistics(run: RunData) -> dict[str, Any]:
    """Of the mean loads over the averaging time, from first to last window: head and rows as text.

    Shares of the time are those of the load in the direction of the largest one: below is nearer to zero.
    """
    lasting = run.lasting
    values = {name: lasting.component(name) for name in ("fx", "fy", "fz", "f")}
    scale = scale_of((np.abs(v).max() for v in values.values()), "N")
    rows = []
    for name, load in values.items():
        largest = float(load[np.abs(load).argmax()])
        shares = np.sign(largest) * np.quantile(np.sign(largest) * load, [0.5, 0.9, 0.99])
        found = [float(load.mean()), float(load.std()), *shares.tolist(), largest]
        rows.append((name.capitalize(), *map(scale.text, found)))
    return {"head": (f"load [{scale.unit}]", *STATISTICS), "rows": rows}


def moment_table(run: RunData) -> dict[str, Any] | None:
    """Peaks of the moments by phase, and where the load attacks at its peaks; None without moments."""
    found = moments(run)
    if found is None:
        return None
    by_phase = {"total": found["peaks"], **found["peaks_by_phase"]}
    scale = scale_of((cell["value"] for row in by_phase.values() for cell in row.values()), "N m")
    axes = ("mx", "my", "mz", "m")
    rows = [
        (name, *(text for axis in axes for text in (scale.text(row[axis]["value"]), f"{row[axis]['time']:.2f}")))
        for name, row in by_phase.items()
    ]
    attack = [
        (
            f"peak of {name.capitalize()}",
            f"{at['time']:.2f}",
            *(scale.text(at[axis]) for axis in axes[:3]),
            *(f"{v:.2f}" for v in at["attack"] or (np.nan,) * 3),
        )
        for name, at in found["at_peaks"].items()
    ]
    head = ("moment", *(t for a in ("Mx", "My", "Mz", "M") for t in (f"{a} [{scale.unit}]", "at [s]")))
    where = ("at", "time [s]", *(f"{a} [{scale.unit}]" for a in ("Mx", "My", "Mz")), "x [m]", "y [m]", "z [m]")
    point = ", ".join(f"{axis} = {v:g} m" for axis, v in zip("xyz", found["point"], strict=True))
    return {"point": point, "head": head, "rows": rows, "attack_head": where, "attack": attack}


def budget_table(run: RunData) -> dict[str, Any] | None:
    """Terms down, instants across, for each component; None without a budget."""
    rows, left_out = _fewer(budget_rows(run))
    if not rows:
        return None
    scale = scale_of((row["total"] for row in rows), "N")
    parts = []
    for component in ("Fz", "Fx"):
        of = [row for row in rows if row["component"] == component]
        head = (component + f" [{scale.unit}]", *(f"{row['when']}\n{row['time']} s" for row in of), "is")
        body = [("total", *(scale.text(row["total"]) for row in of), "load of the ice on the structure")]
        for name in of[0]["terms"]:
            meaning = MEANING.get(name, "a load on the sheet, by its name in the scenario")
            body.append((name, *(scale.text(row["terms"][name]) for row in of), meaning))
        parts.append({"head": [text.replace("all s", "all windows") for text in head], "rows": body})
    return {"unit": scale.unit, "parts": parts, "left_out": left_out}


def _fewer(rows: list[dict[str, Any]]) -> tuple[list[dict[str, Any]], int]:
    """At most `FAILURES` failures, those under the largest Fx, and how many are left out: a page has no more room."""
    found = [row for row in rows if row["when"] == "before failure" and row["component"] == "Fx"]
    found.sort(key=lambda row: -abs(row["total"]))
    late = {row["time"] for row in found[FAILURES:]}
    return [row for row in rows if row["when"] != "before failure" or row["time"] not in late], len(late)


def balances(run: RunData) -> list[tuple[str, str, str]]:
    """What is balanced, how well, and beyond what a run stops, as text."""
    rows = []
    for name, (about, limit) in BALANCES.items():
        if name == "energy":
            work = np.abs(run.ledger.get("drift_work", np.empty(0)))
            work = np.maximum(work, np.abs(run.ledger.get(MOVING, work)))
            residual = np.abs(run.ledger.get("energy_residual", np.empty(0)))
            if not len(work) or not len(residual) or not work[-1]:
                continue
            value = float(residual[-1] / work[-1])
        elif name in run.ledger:
            value = float(np.nanmax(np.abs(run.ledger[name])))
        else:
            continue
        rows.append((about, f"{value:.1e}", significant(limit) if limit > 1e-6 else f"{limit:.0e}"))
    return rows


def curve_data(run: RunData, most: int = 3000) -> dict[str, Any]:
    """Averaged Fx and Fz by phase for the curves that can be enlarged; of many windows the one that is largest."""
    run = run.lasting
    n = len(run.t)
    if n > most:
        edges = np.linspace(0, n, most + 1).astype(int)
        size = np.abs(run.component("f"))
        kept = np.array([a + int(size[a:b].argmax()) for a, b in pairwise(edges)])
    else:
        kept = np.arange(n)
    scale = scale_of((np.abs(run.component(name)).max(initial=0.0) for name in ("fx", "fz")), "N")
    series = {
        axis: {
            name: [float(f"{v:.5g}") for v in (run.component(axis, phase)[kept] / scale.size)]
            for name, phase in (("total", None), *((p, p) for p in PHASES))
        }
        for axis in ("fx", "fz")
    }
    events = [{"t": e.t_ns / 1e9, "kind": e.kind} for e in run.events if e.kind in ("split", "circumferential")]
    return {"t": [float(f"{v:.7g}") for v in run.t[kept]], "unit": scale.unit, "series": series, "events": events}
