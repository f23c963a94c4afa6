"""Numbers as text for tables, of the terminal and of pages alike. Units follow the size of the values."""

from __future__ import annotations

from cosim.analysis.compare import Range, Row, ratio
from cosim.show.scale import Scale, scale_of

COMPARED = ("feature", "simulated", "thesis", "ratio", "measured", "ratio", "unit", "mean over")


def compare_cells(row: Row) -> tuple[str, ...]:
    """Name, simulated, thesis, ratio, measured, ratio, unit and averaging time of a feature, as text."""
    f = row.feature
    ends = [end for value in (f.thesis, f.measured) if value is not None for end in value]
    scale = scale_of((row.simulated, *ends), f.unit)
    beside = [
        text
        for value in (f.thesis, f.measured)
        for text in (_range(value, scale), number(ratio(row.simulated, value), 1.0))
    ]
    over = over_text(row.over) if f.unit == "N" else "-"
    return f.name, scale.text(row.simulated), *beside, scale.unit, over


def over_text(seconds: float) -> str:
    """An averaging time, beside what it was used for."""
    return f"{seconds:.3g} s" if seconds > 0.0 else "a window"


def number(value: float | None, factor: float) -> str:
    """A number times ``factor`` with two decimals; a dash for none."""
    return "-" if value is None else f"{value * factor:.2f}"


def _range(value: Range | None, scale: Scale) -> str:
    if value is None:
        return "-"
    low, high = (f"{v / scale.size:.4g}" for v in value)
    return low if low == high else f"{low} to {high}"
