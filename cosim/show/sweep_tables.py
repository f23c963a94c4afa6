"""Tables of a sweep: variants side by side, distributions, sensitivity indices."""

from __future__ import annotations

from typing import Any

from cosim.show.cells import over_text
from cosim.show.console import new_table, print_line, stdout
from cosim.show.scale import scale_of

COLUMNS = (
    "variant",
    "Fx",
    "at [s]",
    "ratio",
    "Fz",
    "at [s]",
    "ratio",
    "breaking",
    "rotating",
    "sliding",
    "mean Fx",
    "wall [s]",
)
MOST = 60  #: variants that are shown one by one; of more the distributions alone
ENSEMBLE = ("quantity", "runs", "5 %", "median", "95 %", "95 % of the median", "measured", "rank", "exceeded by")


def show(content: dict[str, Any]) -> None:
    """The tables for people."""
    if len(content["variants"]) <= MOST:
        _show_variants(content)
    else:
        print_line(f"{content['scenario']}: {len(content['variants'])} variants, {content['failed']} failed")
    for group in dict.fromkeys(row["group"] for row in content["ensembles"]):
        _show_ensemble(group, [row for row in content["ensembles"] if row["group"] == group])
    if content["indices"]:
        _show_indices(content["indices"])
    lines = [line for row in content["variants"] if (line := _doubt(row))]
    for line in lines[:MOST]:
        print_line(line)
    if len(lines) > MOST:
        print_line(f"... and {len(lines) - MOST} more that failed or are not trustworthy, see the table")


def _doubt(row: dict[str, Any]) -> str:
    """What speaks against a variant."""
    if row["error"] is not None:
        return f"failed: {row['variant']}: {row['error']}"
    because = row["not_trustworthy"]
    return f"not trustworthy: {row['variant']}: because {because}" if because else ""


def _show_variants(content: dict[str, Any]) -> None:
    ran = [row for row in content["variants"] if row["error"] is None]
    scale = scale_of((row[name] for row in ran for name in ("fx_peak", "fz_peak")), "N")
    over = " or ".join(dict.fromkeys(over_text(row["averaging_s"]) for row in ran))
    title = f"{content['scenario']}: peaks of means over {over} [{scale.unit}], ratio to the base, largest Fx of phases"
    table = new_table(*COLUMNS, title=title)
    table.columns[0].min_width = 28
    for row in content["variants"]:
        if row["error"] is not None:
            table.add_row(row["variant"], "failed", *[""] * (len(COLUMNS) - 1))
            continue
        phases = [scale.text(row[f"{p}_fx_peak"]) for p in ("breaking", "rotating", "sliding")]
        load = [
            (scale.text(row[f"{c}_peak"]), f"{row[f'{c}_time']:.2f}", _ratio(row[f"{c}_ratio"])) for c in ("fx", "fz")
        ]
        table.add_row(row["variant"], *load[0], *load[1], *phases, scale.text(row["fx_mean"]), f"{row['wall_s']:.1f}")
    stdout.print(table)


def _show_ensemble(group: str, rows: list[dict[str, Any]]) -> None:
    """Distributions of a group of runs; ranks are places of the measured value among them."""
    table = new_table(*ENSEMBLE, title=f"{group}: distribution over the runs")
    for row in rows:
        if not row["n"]:
            table.add_row(row["quantity"], f"0 of {row['missing']}", *["-"] * (len(ENSEMBLE) - 2))
            continue
        scale = scale_of((row["p05"], row["median"], row["p95"], row.get("measured")), row["unit"])
        runs = str(row["n"]) if not row["missing"] else f"{row['n']} of {row['n'] + row['missing']}"
        between = [scale.labelled(row["p05"]), scale.labelled(row["median"]), scale.labelled(row["p95"])]
        ends = "-" if row["median_interval"] is None else " to ".join(scale.text(x) for x in row["median_interval"])
        table.add_row(row["quantity"], runs, *between, ends, *_measured_cells(row, scale))
    stdout.print(table)


def _measured_cells(row: dict[str, Any], scale: Any) -> tuple[str, str, str]:
    if row["measured"] is None:
        return "-", "-", "-"
    low, high = row["exceedance_interval"]
    range_ = row["measured_range"]
    value = scale.text(row["measured"]) if range_ is None else " to ".join(scale.text(x) for x in range_)
    return value, f"{row['rank']} of {row['n'] + 1}", f"{row['exceedance']:.0%} ({low:.0%} to {high:.0%})"


def _show_indices(rows: list[dict[str, Any]]) -> None:
    names = {"first": "first order"} | {name: name for name in ("total", "delta") if name in rows[0]}
    table = new_table("quantity", "key", *names.values(), "points", title="Sensitivity, +- 95 %")
    for row in rows:
        cells = [f"{row[name]:.2f} +- {row[f'{name}_interval']:.2f}" for name in names]
        table.add_row(row["quantity"], row["key"], *cells, str(row["points"]))
    stdout.print(table)
    if "explained" in rows[0]:
        told = {row["quantity"]: f"{row['explained']:.0%} of {row['quantity']}" for row in rows}
        stdout.print(f"Keys by themselves explain {', '.join(told.values())} at points that were left out of the fit.")


def _ratio(value: float | None) -> str:
    return "-" if value is None else f"{value:.3f}"
