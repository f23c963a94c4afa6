"""A run beside a measured series as text: tables of the terminal, rows of a page, pictures as files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from cosim.outputs import whole, writable
from cosim.series.compare import Comparison, Pair, agreement_rows, rows
from cosim.show.cells import number
from cosim.show.console import new_table, print_line, stdout
from cosim.show.png import drawn, picture
from cosim.show.scale import scale_of, significant
from cosim.show.series_figures import FIGURES

METRICS = ("metric", "simulated", "measured", "ratio", "unit")
AGREEMENT = ("agreement", "value", "best", "unit")


def metric_cells(pair: Pair) -> list[tuple[str, ...]]:
    """Metrics of both, as text."""
    out = []
    for row in rows(pair):
        if row["unit"] == "-":
            cells = [significant(v) if (v := row[key]) is not None else "-" for key in ("simulated", "measured")]
            unit = "-"
        else:
            scale = scale_of((row["simulated"], row["measured"]), row["unit"])
            cells, unit = [scale.text(row[key]) for key in ("simulated", "measured")], scale.unit
        out.append((row["name"], *cells, number(row["ratio"], 1.0), unit))
    return out


def agreement_cells(pair: Pair) -> list[tuple[str, ...]]:
    """Measures of the aligned pair, as text."""
    out: list[tuple[str, ...]] = []
    for row in agreement_rows(pair):
        scale = scale_of((row["value"],), row["unit"])
        value = scale.text(row["value"]) if row["unit"] == "N" else _plain(row["value"])
        out.append((row["name"], value, significant(row["best"]), scale.unit))
    return out


def _plain(value: float | None) -> str:
    return "-" if value is None else f"{value:.3f}"


def print_series(c: Comparison) -> None:
    """What was done with the series, then the metrics of each component."""
    title = c.description.title or c.measured.name
    for line in c.told:
        print_line(f"series: {line}")
    for pair in c.pairs:
        name = pair.component.capitalize()
        for head, cells, what in (
            (METRICS, metric_cells(pair), f"{name} of {c.run} beside {title}"),
            (AGREEMENT, agreement_cells(pair), f"{name}, aligned"),
        ):
            table = new_table(*head, title=what)
            for row in cells:
                table.add_row(*row)
            stdout.print(table)
    if c.description.source:
        print_line(f"measured: {c.description.source}")


def page_parts(c: Comparison) -> list[dict[str, Any]]:
    """For a page: title, tables and pictures of each component."""
    return [
        {
            "title": f"{pair.component.capitalize()} beside {c.description.title or c.measured.name}",
            "tables": ((METRICS, metric_cells(pair)), (AGREEMENT, agreement_cells(pair))),
            "told": c.told if k == 0 else (),
            "figures": [picture(title, draw, c, pair) for title, draw in FIGURES.values()],
        }
        for k, pair in enumerate(c.pairs)
    ]


def write_pictures(c: Comparison, folder: Path) -> list[Path]:
    """Every figure of every component as PNG in a folder, which is made."""
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    for pair in c.pairs:
        for name, (_, draw) in FIGURES.items():
            picture = folder / f"{Path(c.run).stem}_{pair.component}_{name}.png"
            with whole(writable(picture, ".png"), ".png") as part:
                drawn(part, draw, c, pair)
            written.append(picture)
    return written
