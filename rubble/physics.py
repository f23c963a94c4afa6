"""Material and solver parameters of the rubble, in SI units."""

from __future__ import annotations

from dataclasses import dataclass, fields
from math import inf, isfinite, sqrt
from typing import Literal

from rubble.team import TILES

RATE_DEPENDENT = "rate-dependent"  #: friction after Lishman and Polojarvi (2015), see `friction.rate_dependent`
Friction = float | Literal["rate-dependent"]
Backfill = Literal["full", "none", "filling"]


@dataclass(frozen=True)
class RubblePhysics:
    """What the blocks are made of, what they meet, and how finely their motion is resolved.

    Coefficients of friction belong to pairs of bodies and are set contact by contact in every sub-step.
    """

    rho_i: float = 900.0  #: density of ice [kg/m^3]
    rho_w: float = 1025.0  #: density of water [kg/m^3]
    g: float = 9.81  #: [m/s^2]
    mu_ice_ice: Friction = 0.1  #: friction of block on block and block on sheet, or "rate-dependent"
    mu_structure: Friction = 0.1  #: friction of block on structure, or "rate-dependent"
    mu_bed: float = 0.39  #: friction of block on sea bed
    restitution: float = 0.0  #: of every pair
    form_drag: float = 1.0  #: C_d on the projected submerged extent
    skin_drag: float = 4e-3  #: C_f on the wetted edges
    added_mass: float = 0.0  #: share of the mass of displaced water that moves with a block
    added_inertia: float = 0.0  #: the same for rotation
    depth: float = inf  #: of the water over a level sea bed [m]
    thickness: float = 1.0  #: ice thickness, the length scale of `slop_ratio` [m]
    slop_ratio: float = 0.005  #: allowed overlap of two shapes over ice thickness
    iterations: int = 30  #: of the impulse solver; at least the length of a chain of blocks
    substep: float = 0.005  #: constant [s]
    threads: int = 1  #: that share the contacts of a large pile, to the same bits
    align_tolerance: float = 0.0873  #: a block is aligned within this angle of the slope [rad]
    backfill: Backfill = "full"  #: whether the top of a new block floods: at once, never, or over `filling_time`
    filling_time: float = 5.0  #: from the first water over the edge until the top carries its whole head [s]
    backfill_level: float = 0.0  #: height of the water on the tops, <= 0 [m]
    contact_strength: float = inf  #: pressure at which a contact crushes [Pa]
    flexural_strength: float = inf  #: bending stress at which a plate breaks in two [Pa]
    breaking_time: float = 0.2  #: over which the loads that bend it are averaged [s]
    current: tuple[float, float] = (0.0, 0.0)  #: velocity of the water along x and y [m/s]

    def __post_init__(self) -> None:
        for f in fields(self):
            value = getattr(self, f.name)
            if isinstance(value, tuple):
                if not all(isfinite(v) for v in value):
                    raise ValueError(f"rubble.{f.name} is {value}; give two finite velocities")
            elif isinstance(value, str):
                self._check_word(f.name, value)
            elif f.name == "backfill_level":
                if not (isfinite(value) and value <= 0):
                    raise ValueError(f"rubble.backfill_level is {value}; water on a block stands at z <= 0")
            elif not value >= 0 or (not isfinite(value) and f.name not in _MAY_BE_INFINITE):
                raise ValueError(f"rubble.{f.name} is {value}; it must be a number >= 0")
        if self.threads not in range(1, TILES + 1):
            raise ValueError(f"rubble.threads is {self.threads}; give 1 to {TILES}")
        for name in _POSITIVE:
            if getattr(self, name) == 0:
                raise ValueError(f"rubble.{name} is 0; it must be > 0")

    @staticmethod
    def _check_word(name: str, value: str) -> None:
        words = {
            "mu_ice_ice": (RATE_DEPENDENT,),
            "mu_structure": (RATE_DEPENDENT,),
            "backfill": ("full", "none", "filling"),
        }.get(name, ())
        if value not in words:
            raise ValueError(f"rubble.{name} is '{value}'; choose " + (" or ".join(words) or "a number"))

    @property
    def slop(self) -> float:
        """Overlap that the impulse solver leaves alone [m]."""
        return self.slop_ratio * self.thickness

    @property
    def pace(self) -> float:
        """Times of this ice over those of ice of 3 m, by Froude's law: (h / g)^0.5 over its value there [-].

        Where nothing weighs (g = 0) as at 9.81 m/s2.
        """
        return sqrt(self.thickness / 3.0 * (9.81 / (self.g or 9.81)))

    @property
    def afloat(self) -> float:
        """Energy of weight and water of ice that floats flat, g (h - draft) / 2 per mass [J/kg]."""
        return 0.5 * self.g * self.thickness * (1.0 - self.rho_i / self.rho_w)

    @property
    def filling_rate(self) -> float:
        """Share of the head on a wet top that comes per second [1/s]; 0: it stays dry."""
        return 1.0 / self.filling_time if self.backfill == "filling" else 0.0


_MAY_BE_INFINITE = ("contact_strength", "flexural_strength", "depth")
_POSITIVE = (
    "rho_i",
    "rho_w",
    "depth",
    "thickness",
    "slop_ratio",
    "iterations",
    "substep",
    "filling_time",
    "contact_strength",
    "flexural_strength",
    "breaking_time",
)
