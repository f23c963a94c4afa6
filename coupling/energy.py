"""Energy of the whole system for an observer at rest: what the drift puts in, what is stored, what is lost.

    drift_work = change of the stores + losses + residual

All terms are changes since the start of the run [J]; each is measured where it happens and none is what others leave.
The sheet's terms come from `lattice.energy`, those of the blocks from `rubble.energy`. Terms between the two:

* hand-over: what a piece had in the lattice less what its blocks have when they are born (elastic energy is released;
  a rigid block does not bend, has lost its crushed edge, and brings along the water that moves with it),
* interface: work that blocks do on the edge they meet less work that the lattice receives on its nodes. It holds the
  lag of one window and what the edge's spring and mass take up: no store of its own, because the lattice stores the
  same deformation.
* structure: what one that moves puts into the ice that it presses, F . v of all its contacts, on the way that the ice
  saw (`coupling.moving`). Losses of a contact are those of the ice against it.
* In lockstep there is no lag: what blocks lose in impacts on the sheet is what they give less what the lattice receives
  on its nodes, friction apart. An impact that gives more than it takes would be below zero.

While the sheet is served from a long step its terms stand still, all of them, and are booked when the step is done.
A loss may be negative: the step of the rubble, its correction of overlap and dry tops add energy.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from coupling.interface import NS, SimulationError

STORES = ("sheet_elastic", "sheet_foundation", "sheet_kinetic", "rubble_kinetic", "rubble_potential")
SOURCES = ("drift_work", "thrust_work")
MOVING = "structure_work"  #: what a structure that moves puts in; no term where it rests
LOAD_WORK = "_load_work"  #: ends the name of what a load on the sheet puts in, where there are loads
LIMIT = 0.01  #: of the drift's work, or of `EnergyBalance.floor` while that is larger


def terms_of(sheet: Mapping[str, float], rubble: Mapping[str, float]) -> dict[str, float]:
    """The terms of the balance from the books of both participants [J]; without rubble its terms are 0."""
    both = {**sheet, **rubble}
    terms = {name: both.get(name, 0.0) for name in SOURCES + STORES}
    terms |= {name: value for name, value in both.items() if name.endswith(("_loss", LOAD_WORK))}
    if (work := both.get(f"sheet_{MOVING}")) is not None:
        terms[MOVING] = work + both.get(f"rubble_{MOVING}", 0.0)
    terms["handover_elastic_loss"] = sheet["left_elastic"]
    terms["handover_potential_loss"] = sheet["left_foundation"] - rubble.get("born_potential", 0.0)
    terms["handover_kinetic_loss"] = sheet["left_kinetic"] - rubble.get("born_kinetic", 0.0)
    lost = rubble.get("meeting_work", rubble.get("sheet_work", 0.0)) - sheet["received_work"]
    lockstep = "meeting_work" in rubble
    terms["interface_loss"] = 0.0 if lockstep else lost
    if lockstep:
        terms["impact_sheet_loss"] += lost
    return terms


def residual_of(terms: Mapping[str, float]) -> float:
    """What no term explains [J]."""
    spent = sum(value for name, value in terms.items() if name in STORES or name.endswith("_loss"))
    sources = (*SOURCES, MOVING)
    return sum(value for name, value in terms.items() if name in sources or name.endswith(LOAD_WORK)) - spent


@dataclass
class EnergyBalance:
    """The balance of a run, window by window."""

    #: kinetic energy of the floe at the start [J], which it brings along: in the first seconds the drift has done less,
    #: and to a floe that nothing holds it does nothing at all
    floor: float = 1.0
    terms: dict[str, float] = field(default_factory=dict)  #: since the start, at the end of the last window [J]
    work: float = 0.0  #: largest of the drift, or of the structure, so far [J]
    _start: dict[str, float] = field(default_factory=dict)

    @property
    def residual(self) -> float:
        """Of the run so far [J]."""
        return residual_of(self.terms) if self.terms else 0.0

    @property
    def relative(self) -> float:
        """Residual over the work of the drift, or over the floor while that is larger."""
        return abs(self.residual) / max(self.work, self.floor)

    def open(self, sheet: Mapping[str, float], rubble: Mapping[str, float]) -> None:
        """Takes stock before the first window; participants without energy books keep none."""
        if sheet:
            self._start = terms_of(sheet, rubble)
            self.terms = dict.fromkeys(self._start, 0.0)
            self.floor = self._start["sheet_kinetic"] or self.floor

    def close(self, t_ns: int, sheet: Mapping[str, float], rubble: Mapping[str, float]) -> dict[str, float]:
        """Closes a window; returns the terms with the residual [J]. SimulationError if it is too large."""
        if not self._start:
            return {}
        before, now = self.terms, terms_of(sheet, rubble)
        self.terms = {name: value - self._start.get(name, 0.0) for name, value in now.items()}
        self.work = max(self.work, abs(self.terms["drift_work"]), abs(self.terms.get(MOVING, 0.0)))
        if not self.relative <= LIMIT:
            change = {name: value - before.get(name, 0.0) for name, value in self.terms.items()}
            worst = max(change, key=lambda name: abs(change[name]))
            raise SimulationError(
                f"t = {t_ns / NS:.3f} s: the energy balance is off by {self.residual:.4g} J, {self.relative:.2%} of the"
                f" drift's work (allowed {LIMIT:.0%}), {self.residual - residual_of(before):.4g} J of it in this "
                f"window; largest change in it: {worst} {change[worst]:+.4g} J. Shorten coupling.window and "
                "rubble.substep; if that does not help, please report the scenario"
            )
        return {**self.terms, "energy_residual": self.residual}
