"""Design formulas as text for tables, of the terminal and of pages alike. Units follow the size of the loads."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from cosim.show.cells import number, over_text
from cosim.show.scale import Scale, scale_of


def scale_of_methods(methods: Iterable[dict[str, Any]]) -> Scale:
    """For the loads of all methods."""
    return scale_of((found.get(axis) for found in methods for axis in ("fx", "fz")), "N")


def method_cells(found: dict[str, Any], scale: Scale) -> tuple[str, ...]:
    """Title, Fx, Fz and share of breaking of a method, as text."""
    if "refused" in found:
        return found["title"], "-", "-", "-"
    return found["title"], scale.text(found["fx"]), scale.text(found["fz"]), f"{100.0 * found['breaking_share']:.0f} %"


def beside_table(design: dict[str, Any]) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
    """Head and rows of the table of a run: formula, Fx, simulated / design, Fz, simulated / design, breaking's share.

    The simulated peak is the one of the whole program, `cosim.analysis.sustained`.
    """
    peak, methods = design["simulated"], list(design.get("methods", {}).values())
    scale, share = scale_of_methods([peak, *methods]), design["simulated"]["breaking_share"]
    over = over_text(design["averaging_s"])
    first = (f"simulated peak, mean over {over}", scale.text(peak["fx"]), "", scale.text(peak["fz"]), "")
    rows: list[tuple[str, ...]] = [(*first, "-" if share is None else f"{100.0 * share:.0f} %")]
    for found in methods:
        title, fx, fz, breaking = method_cells(found, scale)
        rows.append((title, fx, number(found.get("ratio_fx"), 1.0), fz, number(found.get("ratio_fz"), 1.0), breaking))
    return ("design formulas", f"Fx [{scale.unit}]", "ratio", f"Fz [{scale.unit}]", "ratio", "breaking"), rows


def remarks(design: dict[str, Any]) -> list[str]:
    """What stands below that table."""
    if "refused" in design:
        return [str(design["refused"])]
    out = []
    for found in design["methods"].values():
        assumed = "; ".join(f"{key} = {text}" for key, text in found["assumed"].items())
        tail = f"; {found['refused']}" if "refused" in found else f"; assumed: {assumed}" if assumed else ""
        out.append(f"{found['title']}: {found['source']}; {found['caveat']}{tail}")
    return out
