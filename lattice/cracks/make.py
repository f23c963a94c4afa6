"""A sheet whose cracks close, from what is measured: a beam test and a fracture energy."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from lattice.cracks.beam import Beam, layer_strength, standard_beam
from lattice.cracks.engine import SLOW, CrackingEngine
from lattice.cracks.law import law_of, softening
from lattice.cracks.sheet import PRINCIPAL, CrackingSheet
from lattice.criteria.table import Criterion
from lattice.explicit.engine import TRUE_INERTIA
from lattice.explicit_sheet import CONTACT_TIME
from lattice.grid import Grid
from lattice.ice import Ice
from lattice.stiffness import Springs

#: time between two evaluations of the contact in slow interaction, in units of (h / g)^(1/2): 5 ms for ice of 3 m,
#: where against 2 ms it moves the peak of the 165 m floe by 0.1 % [-]
SLOW_CONTACT = 9.0425e-3


@dataclass(frozen=True)
class Measured:
    """What the strength of the layers follows from."""

    fracture_energy: float  #: G_f, 0: brittle [J/m2]
    friction: float  #: of the faces of a crack [-]
    beam: Beam | None = None  #: None: a beam of usual proportions that breaks at the flexural strength
    concentration: float = 1.0  #: of the stress at the beam's root beyond what its cells show [-]
    strength: float | None = None  #: of the layers, where it is known without a beam [Pa]


def cracking_sheet(
    grid: Grid,
    ice: Ice,
    springs: Springs,
    window: float,
    measured: Measured,
    *,
    dynamic: bool = False,
    criteria: tuple[Criterion, ...] = PRINCIPAL,
    **options: Any,
) -> CrackingSheet:
    """The sheet; ``dynamic`` keeps the true inertia of cracks, ``options`` as in `CrackingEngine`."""
    strength = measured.strength
    if strength is None:
        beam = measured.beam or standard_beam(ice)
        beam = replace(beam, load=measured.concentration * beam.load)
        strength = layer_strength(ice, measured.friction, measured.fracture_energy, beam, grid.d)
    layers = replace(ice, sigma_t=strength, sigma_f=strength, beam_test=None)
    law = law_of(layers, measured.fracture_energy, measured.friction, grid.d)
    sub_steps = TRUE_INERTIA if dynamic else SLOW
    options = {"sub_steps": sub_steps, **options, "rigid": softening(layers, measured.fracture_energy, grid.d)}
    engine = CrackingEngine(grid, layers, springs, window, law=law, **options)
    return CrackingSheet(engine, criteria=criteria, contact_time=CONTACT_TIME if dynamic else SLOW_CONTACT)
