"""What the design formulas work on, and what they come to."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Literal

from cosim.errors import InputError


class BaselineError(InputError):
    """A case that a formula cannot serve; the message is one line: formula, value, what to do."""


@dataclass(frozen=True)
class Case:
    """Ice and structure in SI units, angles in rad."""

    h: float  #: ice thickness [m]
    w: float  #: width of the structure at the waterline: D of a cone [m]
    a: float  #: slope from the horizontal
    mu: float  #: friction, ice on structure
    sigma_f: float  #: flexural strength [Pa]
    E: float  #: Young's modulus [Pa]
    nu: float  #: Poisson's ratio
    rho_i: float  #: density of ice [kg/m3]
    rho_w: float  #: density of water [kg/m3]
    g: float  #: [m/s2]
    h_r: float  #: height of the rubble on the slope [m]
    e: float  #: porosity of the rubble
    th: float  #: slope of the rubble
    ph: float  #: friction angle of the rubble
    c: float  #: cohesion of the rubble [Pa]
    mu_i: float  #: friction, ice on ice
    h_R: float  #: thickness of the ice that rides on the structure [m]
    D_T: float  #: diameter at the cone's narrow end [m]
    breaking: Literal["downward", "upward"] = "downward"
    wide: bool = False  #: the ice is no wider than the structure: no ends, l_c = w
    wedges: int = 5  #: between the radial cracks in front of a cone

    @property
    def sign(self) -> float:
        """Of Fz: a downward-breaking structure is lifted."""
        return 1.0 if self.breaking == "downward" else -1.0


@dataclass(frozen=True)
class Load:
    """A design load on the structure."""

    terms: dict[str, float]  #: parts by their symbol [N]
    fx: float  #: in drift direction [N]
    fz: float  #: upwards [N]
    breaking: float  #: what breaking the sheet takes of fx, its share of the compression included [N]
    between: dict[str, float] = field(default_factory=dict)  #: intermediate values by symbol [SI]


@dataclass(frozen=True)
class Method:
    """A formula with its source and with what a reader must know of it."""

    name: str
    title: str
    formula: Callable[[Case], Load]
    source: str
    caveat: str
    cone_only: bool
    uses: tuple[str, ...]  #: keys of [baseline] that enter it


def refuse(formula: str, what: str, remedy: str) -> BaselineError:
    """The error of a formula that cannot be used: what is against it, and the remedy."""
    return BaselineError(f"{formula}: {what}; {remedy}")
