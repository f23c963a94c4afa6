"""Tables of the design formulas for people. Loads in MN."""

from __future__ import annotations

from typing import Any

from cosim.console import new_table, number, print_line, stdout


def print_baseline(title: str, methods: dict[str, dict[str, Any]]) -> None:
    """`cosim baseline`: loads and terms, then what is assumed and what is not verified."""
    table = new_table("formula", "Fx [MN]", "Fz [MN]", "breaking", "terms", title=f"Design formulas: {title}")
    for found in methods.values():
        table.add_row(*cells(found), _terms(found))
    stdout.print(table)
    for found in methods.values():
        print_line(f"{found['title']}: {found['source']}; {found['caveat']}")
    assumed = {
        key: text for found in methods.values() if "refused" not in found for key, text in found["assumed"].items()
    }
    if assumed:
        print_line("assumed, because [baseline] of the scenario does not say:")
    for key, text in assumed.items():
        print_line(f"  {key} = {text}")


def cells(found: dict[str, Any]) -> tuple[str, ...]:
    """Title, Fx, Fz and share of breaking of a method, as text."""
    if "refused" in found:
        return found["title"], "-", "-", "-"
    return (
        found["title"],
        number(found["fx"], 1e-6),
        number(found["fz"], 1e-6),
        f"{100.0 * found['breaking_share']:.0f} %",
    )


def _terms(found: dict[str, Any]) -> str:
    if "refused" in found:
        return str(found["refused"])
    return ", ".join(f"{name} {value * 1e-6:.4g}" for name, value in found["terms"].items())


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
        title, fx, fz, breaking = cells(found)
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


BESIDE = ("design formulas", "Fx [MN]", "ratio", "Fz [MN]", "ratio", "breaking")


def print_beside(design: dict[str, Any]) -> None:
    """The design formulas of `cosim compare`; ratio = simulated / design."""
    table = new_table(*BESIDE, title="Peak beside design formulas")
    for row in beside_rows(design):
        table.add_row(*row)
    stdout.print(table)
    for line in remarks(design):
        print_line(line)
