"""Units of display that follow the size of the case: N, kN or MN; mm or m; g, kg or t. No more digits than are true.

Numbers that stand together, in a column or a picture, have one unit and one number of decimals.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

#: by SI unit: size and name of what it is shown in, the largest first
STEPS: dict[str, tuple[tuple[float, str], ...]] = {
    "N": ((1e6, "MN"), (1e3, "kN"), (1.0, "N"), (1e-3, "mN")),
    "N m": ((1e6, "MN m"), (1e3, "kN m"), (1.0, "N m"), (1e-3, "mN m")),
    "Pa": ((1e6, "MPa"), (1e3, "kPa"), (1.0, "Pa")),
    "m": ((1.0, "m"), (1e-3, "mm")),
    "J": ((1e6, "MJ"), (1e3, "kJ"), (1.0, "J"), (1e-3, "mJ")),
    "kg": ((1e6, "1000 t"), (1e3, "t"), (1.0, "kg"), (1e-3, "g")),
    "kg/s": ((1e3, "t/s"), (1.0, "kg/s"), (1e-3, "g/s")),
    "m^3": ((1.0, "m^3"), (1e-3, "l")),
    "m^2": ((1.0, "m^2"), (1e-4, "cm^2")),
}
DIGITS = 3  #: that a result of a run has


@dataclass(frozen=True)
class Scale:
    """A unit of display."""

    size: float  #: of it, in SI
    unit: str
    decimals: int

    def text(self, value: float | None) -> str:
        """A value in SI as text without its unit; a dash for none."""
        if value is None or not math.isfinite(value):
            return "-"
        shown = f"{value / self.size:.{self.decimals}f}"
        return shown.removeprefix("-") if float(shown) == 0.0 else shown

    def labelled(self, value: float | None) -> str:
        """The same with its unit."""
        return f"{self.text(value)} {self.unit}"


def scale_of(values: Iterable[float | None], unit: str) -> Scale:
    """For values in this SI unit that are shown together: the largest in magnitude has three digits."""
    largest = max((abs(v) for v in values if v is not None and math.isfinite(v)), default=0.0)
    steps = STEPS.get(unit, ((1.0, unit),))
    size, name = next((step for step in steps if largest >= step[0]), steps[-1 if largest else 0])
    return Scale(size, name, decimals(largest / size))


def decimals(largest: float) -> int:
    """Decimals with which a number has `DIGITS` digits."""
    return max(0, DIGITS - 1 - math.floor(math.log10(largest))) if largest > 0.0 else 2


def significant(value: float) -> str:
    """A number on its own with three digits, without an exponent where it is not long."""
    if not math.isfinite(value):
        return "-"
    return f"{float(f'{value:.{DIGITS}g}'):.12g}"


def seconds(values: Iterable[float | None]) -> Scale:
    """Times of a run [s]: hundredths, and thousandths where all happens within a few seconds."""
    largest = max((abs(v) for v in values if v is not None), default=0.0)
    return Scale(1.0, "s", 2 if largest >= 5.0 else 3)
