"""Numbers as text for tables, of the terminal and of pages alike. Loads in MN, times in s, volumes in m^3."""

from __future__ import annotations

from cosim.analysis.compare import Range, Row, ratio

SCALES = {"N": (1e-6, "MN"), "s": (1.0, "s"), "m^3": (1.0, "m^3")}  #: factor and unit of display


def compare_cells(row: Row) -> tuple[str, ...]:
    """Name, simulated, thesis, ratio, measured, ratio and unit of a feature, as text."""
    f = row.feature
    factor, unit = SCALES.get(f.unit, (1.0, f.unit))
    beside = [
        text
        for value in (f.thesis, f.measured)
        for text in (_range(value, factor), number(ratio(row.simulated, value), 1.0))
    ]
    return f.name, number(row.simulated, factor), *beside, unit


def number(value: float | None, factor: float) -> str:
    """A number times ``factor`` with two decimals; a dash for none."""
    return "-" if value is None else f"{value * factor:.2f}"


def _range(value: Range | None, factor: float) -> str:
    if value is None:
        return "-"
    low, high = (f"{v * factor:g}" for v in value)
    return low if low == high else f"{low} to {high}"
