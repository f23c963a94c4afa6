"""From a scenario to participants: the only place where solvers are put together."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from cosim.build_engine import explicit_engine
from cosim.build_motion import build_motion, repeats_of
from cosim.build_rubble import build_rubble, filling_rate, initial_rubble
from cosim.errors import InputError
from cosim.loads import loads_of
from cosim.observer import RunInfo
from cosim.scenario.ice import STRENGTHS
from cosim.scenario.scenario import Scenario
from cosim.scenario.variation import FIELDS
from cosim.strained import Strained
from cosim.structures import KINDS
from coupling.contact import ContactLaw
from coupling.crushing import CONTACTS
from coupling.interface import NS, BoolArray, Motion, RubbleParticipant, Structure
from coupling.interface import Path as Way
from coupling.ledger import Ledger
from coupling.moving import WithStructure
from coupling.rubble_port import NoRubble, RubblePort
from coupling.scheduler import Scheduler, Scheme
from coupling.schemes import SCHEMES, Iteration
from coupling.sheet_port import SheetPort
from coupling.start import lay_rubble
from coupling.steering import ByPower, Steering, fixed
from lattice.cracks.beam import Beam
from lattice.cracks.make import Measured, cracking_sheet
from lattice.criteria.table import chosen
from lattice.explicit_sheet import ExplicitSheet
from lattice.floe import Floe
from lattice.fragments import front_x
from lattice.grid import Grid
from lattice.ice import BeamTest, Ice
from lattice.implicit.engine import Engine
from lattice.sheet import Sheet
from lattice.stiffness import STIFFNESS_SETS
from lattice.varied import Varied

if TYPE_CHECKING:
    from cosim.ice.broken import Broken


def build(scenario: Scenario, motion: Motion | None = None, *, begins: bool = True) -> Scheduler:
    """All participants of a run, at rest, with the floe touching the structure.

    ``motion`` is that of the structure, if it is not to be the one of the scenario. A run that does not begin, but goes
    on from a checkpoint, has its rubble there: none is laid for it.
    """
    structure = build_structure(scenario)
    ice = build_ice(scenario)
    sheet = build_sheet(scenario, ice, structure)
    if scenario.water.tops == "flood":
        sheet.flood(filling_rate(scenario))
    law = ContactLaw(scenario.contact.strength, scenario.contact.friction, ice.E / sheet.grid.d)
    columns = scenario.rubble.columns_per_section
    contact = CONTACTS[scenario.contact.model]
    motion = build_motion(scenario) if motion is None else motion
    way = None if motion is None else Way()
    port = SheetPort(sheet, structure, law, scenario.drift.velocity, columns, contact, loads_of(scenario), way)
    rubble: RubbleParticipant = build_rubble(scenario, structure, sheet.grid) if scenario.rubble.enabled else NoRubble()
    if scenario.coupling.scheme == "lockstep" and isinstance(rubble, RubblePort):
        port.lockstep(scenario.rubble.substep)
        rubble.lockstep = True
    ledger = Ledger(port.initial_mass if sheet.present.all() else port.mass)
    if isinstance(rubble, RubblePort):
        rubble.on_crushed = ledger.crush
        if begins:
            _earlier_ice(scenario, port, rubble)
            ledger.initial_mass += rubble.mass
    scheme = build_scheme(scenario)
    if motion is not None and way is not None:
        scheme = WithStructure(scheme, motion, way, repeats_of(scenario))
    return Scheduler(
        port,
        rubble,
        ledger,
        scenario.window_ns,
        scheme,
        build_steering(scenario),
        scenario.duration_ns,
    )


def _earlier_ice(scenario: Scenario, sheet: SheetPort, rubble: RubblePort) -> None:
    """Rubble that is there before the run: a heap that settles, or the pieces of another run."""
    if scenario.rubble.initial_volume > 0.0:
        lay_rubble(sheet, rubble, initial_rubble(scenario))
    if scenario.rubble.pieces:
        from cosim.ice.pieces import put  # few runs begin with pieces

        put((scenario.folder or Path()) / scenario.rubble.pieces, scenario, sheet, rubble)


def build_scheme(scenario: Scenario) -> Scheme:
    """How sheet and rubble go through a window."""
    c = scenario.coupling
    iteration = Iteration(c.tolerance, c.max_iterations, c.relaxation, c.force_floor, c.unconverged == "stop")
    return SCHEMES[c.scheme](iteration)


def build_steering(scenario: Scenario) -> Steering:
    """How the length of the windows is chosen."""
    c, substep_ns = scenario.coupling, round(scenario.rubble.substep * NS)
    if c.steering == "fixed":
        return fixed
    shortest, longest = c.bounds(scenario.rubble.substep)
    return ByPower(scenario.window_ns, round(shortest * NS), round(longest * NS), substep_ns, c.power_tolerance)


def build_ice(scenario: Scenario) -> Ice:
    """Ice and water of the sheet."""
    i, w = scenario.ice, scenario.water
    test = (
        None
        if i.beam_test is None
        else BeamTest(i.beam_test.length, i.beam_test.width, i.beam_test.failure_load, i.beam_test.factor)
    )
    return Ice(
        E=i.youngs_modulus,
        nu=i.poisson_ratio,
        h=i.thickness,
        rho_i=i.density,
        rho_w=w.density,
        g=w.gravity,
        beam_test=test,
        added_mass=w.added_mass,
        **{field: sign * value for key, (field, sign) in STRENGTHS.items() if (value := getattr(i, key)) is not None},
    )


def build_structure(scenario: Scenario) -> Structure:
    """The structure, by its kind."""
    return KINDS[scenario.structure.kind].build(scenario.structure)


def build_sheet(scenario: Scenario, ice: Ice, structure: Structure) -> Floe:
    """The floe, ``sheet.gap`` before its front touches the face on the structure's axis plane with its first edge."""
    s = scenario.sheet
    front = structure.foremost_x(ice.freeboard if structure.faces_down else ice.freeboard - ice.h) - s.gap
    grid = Grid.rectangle(s.length, s.width, s.nodes[0], s.nodes[1], front - s.length, -s.axis)
    state = _broken(scenario, grid)
    if state is not None:
        grid = replace(grid, x0=grid.x0 + room_before(structure, ice, grid, state.gone) - s.gap)
    sheet = _whole_sheet(scenario, ice, grid)
    if state is not None:
        try:
            sheet.begin_broken(state.gone, state.cracked, state.angle)
        except ValueError as error:
            raise InputError(f"sheet.broken = {s.broken}: {error}") from error
    return sheet


def _broken(scenario: Scenario, grid: Grid) -> Broken | None:
    if not scenario.sheet.broken:
        return None
    from cosim.ice.broken import broken  # tables are slow to import, and few ice is broken or varies

    return broken((scenario.folder or Path()) / scenario.sheet.broken, grid)


def _varied(scenario: Scenario, grid: Grid) -> Varied | None:
    if not any(getattr(scenario.ice, name) for name in FIELDS):
        return None
    from cosim.ice.fields import varied

    return varied(scenario, grid)


def room_before(structure: Structure, ice: Ice, grid: Grid, gone: BoolArray) -> float:
    """How far a floe without the nodes that are ``gone`` (nodes,) can come forward until it touches [m]."""
    front = front_x(grid, ~gone)
    column = np.flatnonzero(np.isfinite(front))
    z = ice.freeboard if structure.faces_down else ice.freeboard - ice.h
    between = structure.face_x(grid.y0 + column * grid.d, z) - front[column]
    if not np.isfinite(between).any():
        raise InputError("sheet.broken: no ice is left before the structure; leave some of it")
    return float(np.nanmin(between))


def _whole_sheet(scenario: Scenario, ice: Ice, grid: Grid) -> Floe:
    """The floe before anything is broken."""
    s = scenario.sheet
    held = np.zeros((grid.nodes, 2), bool)
    if s.back != "free":
        held[grid.edge_nodes("x-")] = (True, s.back == "held")
    if s.sides != "free":
        held[np.concatenate((grid.edge_nodes("y-"), grid.edge_nodes("y+")))] |= (s.sides == "held", True)
    damping = scenario.water.damping * math.sqrt(ice.k_f * ice.rho_i * ice.h)
    window, alpha = scenario.coupling.window, scenario.ice.material_damping
    springs = STIFFNESS_SETS[s.stiffness](ice)
    criteria = chosen(scenario.fracture.judged)
    options: dict[str, Any] = {"held_in_plane": held, "damping": damping, "alpha": alpha}
    options["varied"] = _varied(scenario, grid)
    dynamic = scenario.fracture.propagation == "dynamic"
    if scenario.fracture.cracks == "closing":
        measured = build_measured(scenario)
        try:
            options |= {"dynamic": dynamic, "criteria": criteria, "threads": s.threads}
            return cracking_sheet(grid, ice, springs, window, measured, **options)
        except ValueError as error:
            raise InputError(f"{scenario.name}: {error}") from error
    if dynamic:
        engine = explicit_engine(scenario.fracture.device)
        return ExplicitSheet(engine(grid, ice, springs, window, **options), criteria=criteria)
    windows = max(1, round(scenario.fracture.longest_step / window))
    return Sheet(Engine(grid, ice, springs, threads=s.threads, **options), window, criteria=criteria, long_step=windows)


def build_measured(scenario: Scenario) -> Measured:
    """What the strength of the layers of cracking ice follows from."""
    f, test = scenario.fracture, scenario.ice.beam_test
    beam = None if test is None else Beam(test.length, test.width, test.failure_load)
    concentration = 1.0 if test is None else test.concentration
    return Measured(f.fracture_energy, f.crack_friction, beam, concentration, f.layer_strength)


def run_info(scenario: Scenario, scheduler: Scheduler | None = None) -> RunInfo:
    """What stays constant over a run, for observers; of a run that is built they can ask for stresses."""
    s = scenario.sheet
    mesh = build_structure(scenario).mesh(2.0 * s.width)
    return RunInfo(
        scenario,
        mesh,
        tuple(s.nodes),
        s.spacing,
        scenario.duration_ns,
        scenario.window_ns,
        None if scheduler is None else Strained.of(scheduler),
    )
