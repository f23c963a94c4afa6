"""The failure criteria by name, and the strengths that each of them needs.

A new criterion is a function of `CellState` and `Ice` and one line of `CRITERIA`; runs of both engines judge it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from lattice.criteria import laws
from lattice.grid import Array
from lattice.ice import Ice
from lattice.strain import CellState


@dataclass(frozen=True)
class Criterion:
    """A way in which a cell can fail."""

    name: str
    judge: Callable[[CellState, Ice], Array]  #: utilisation of the cells of a state, (cells,); a cell fails at 1
    needs: tuple[str, ...] = ()  #: fields of `Ice` that it reads and that have no other value than infinity by default
    limited: bool = False  #: it compares with `CellState.limit`, which is (4.31) at crack tips
    at_tips: bool = False  #: in a run only cells beside a crack tip are judged


CRITERIA: dict[str, Criterion] = {
    c.name: c
    for c in (
        Criterion("tension", laws.tension, ("sigma_t", "sigma_c")),
        Criterion("compression", laws.compression, ("sigma_c",)),
        Criterion("spalling", laws.spalling, ("sigma_spall",)),
        Criterion("bending-top", laws.bending_top, ("sigma_f", "sigma_c")),
        Criterion("bending-bottom", laws.bending_bottom, ("sigma_f", "sigma_c")),
        Criterion("upward-bending", laws.upward_bending, ("sigma_f_upward", "sigma_c")),
        Criterion("downward-bending", laws.downward_bending, ("sigma_f_downward", "sigma_c")),
        Criterion("combined-tension", laws.combined_tension, ("sigma_t", "sigma_f", "sigma_c"), limited=True),
        Criterion("combined-compression", laws.combined_compression, ("sigma_t", "sigma_f", "sigma_c")),
        Criterion("principal-stress", laws.principal_stress, ("sigma_t", "sigma_f"), limited=True),
        Criterion("crack-tip-splitting", laws.crack_tip_splitting, ("sigma_t", "sigma_c", "K_IC"), at_tips=True),
        Criterion("crack-tip-bending", laws.crack_tip_bending, ("sigma_f", "sigma_c"), at_tips=True),
        Criterion("out-of-plane-shear", laws.out_of_plane_shear, ("sigma_shear",)),
    )
}
THESIS = (CRITERIA["combined-tension"],)  #: what the thesis judges in chapter 6; (4.31) at crack tips comes with it


def chosen(names: Iterable[str]) -> tuple[Criterion, ...]:
    """The criteria of these names, each once; ValueError for one that is not in the table, or for none."""
    names = tuple(dict.fromkeys(names))
    if unknown := [name for name in names if name not in CRITERIA]:
        raise ValueError(f"unknown failure criterion {unknown[0]!r}: use some of {', '.join(CRITERIA)}")
    if not names:
        raise ValueError(f"no failure criterion: use at least one of {', '.join(CRITERIA)}")
    return tuple(CRITERIA[name] for name in names)


def needed(criteria: Iterable[Criterion]) -> tuple[str, ...]:
    """Names of the strengths in `Ice` without which these criteria cannot be judged, each once."""
    return tuple(dict.fromkeys(name for criterion in criteria for name in criterion.needs))
