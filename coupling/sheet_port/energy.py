"""The sheet's terms of the energy balance."""

from __future__ import annotations

from coupling.energy import LOAD_WORK, MOVING
from coupling.sheet_port.moving import OnMoving
from lattice.energy import EnergyBooks

RUBBLE = "rubble"  #: name of the rubble's forces among the loads on the lattice


def energy_terms(e: EnergyBooks, drift: float, moving: OnMoving | None = None) -> dict[str, float]:
    """Energy of the sheet by term, for an observer at rest [J]; see `lattice.energy` and `coupling.energy`.

    The lattice counts for one who moves along with ``drift`` [m/s]: to one at rest a force does drift times its impulse
    more work. A contact takes from the ice what its force does there, less what a ``moving`` structure puts in.
    """
    friction, contact = e.rub.work + drift * e.rub.push, e.touch.work + drift * e.touch.push
    put_in, rubbed = (0.0, 0.0) if moving is None else (moving.work, moving.rubbed)
    crushed = e.crushed.elastic + e.crushed.foundation + e.crushed.kinetic_at(drift)
    return {
        "drift_work": drift * e.hold,
        "received_work": e.load(RUBBLE).at(drift),
        "sheet_elastic": e.now.elastic,
        "sheet_foundation": e.now.foundation,
        "sheet_kinetic": e.now.kinetic_at(drift),
        "contact_friction_loss": rubbed - friction,
        "contact_crushing_loss": (put_in - rubbed) - (contact - friction),
        "damping_loss": e.damping,
        "scheme_loss": e.scheme,
        "fracture_loss": e.fracture,
        "edge_crushed_loss": crushed,
        "left_elastic": e.pieces.elastic,
        "left_foundation": e.pieces.foundation,
        "left_kinetic": e.pieces.kinetic_at(drift),
        "contact_work": e.contact,
        "rubble_work": e.received,
        "sheet_energy_residual": e.residual,
        **({} if moving is None else {f"sheet_{MOVING}": put_in}),
        **{f"crack_{cause}_loss": value for cause, value in e.engine.crack_losses.items()},
        **{name + LOAD_WORK: work.at(drift) for name, work in e.loads.items() if name != RUBBLE},
    }
