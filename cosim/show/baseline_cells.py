"""Design formulas as text for tables, of the terminal and of pages alike. Loads in MN."""

from __future__ import annotations

from typing import Any

from cosim.show.cells import number

BESIDE = ("design formulas", "Fx [MN]", "ratio", "Fz [MN]", "ratio", "breaking")


def method_cells(found: dict[str, Any]) -> tuple[str, ...]:
    """Title, Fx, Fz and share of breaking of a method, as text."""
    if "refused" in found:
        return found["title"], "-", "-", "-"
    return (
        found["title"],
        number(found["fx"], 1e-6),
        number(found["fz"], 1e-6),
        f"{100.0 * found['breaking_share']:.0f} %",
    )


def beside_rows(design: dict[str, Any]) -> list[tuple[str, ...]]:
    """Rows of the table of a run: formula, Fx, simulated / design, Fz, simulated / design, share of breaking."""
    peak = design["simulated"]
    share = peak["breaking_share"]
    rows: list[tuple[str, ...]] = [
        (
            "simulated peak",
            number(peak["fx"], 1e-6),
            "",
            number(peak["fz"], 1e-6),
            "",
            "-" if share is None else f"{100.0 * share:.0f} %",
        )
    ]
    for found in design.get("methods", {}).values():
        title, fx, fz, breaking = method_cells(found)
        rows.append((title, fx, number(found.get("ratio_fx"), 1.0), fz, number(found.get("ratio_fz"), 1.0), breaking))
    return rows


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
