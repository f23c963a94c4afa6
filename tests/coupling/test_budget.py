"""The force budget: each term against its closed form, and their sum against the load of the contacts."""

from __future__ import annotations

import numpy as np
import pytest

from cosim.build import build
from cosim.scenario.loading import load_scenario
from coupling.budget import AXES, TERMS, force_budget
from coupling.rubble_port import RubblePort
from lattice.contact import NoContact
from lattice.explicit.engine import ExplicitEngine
from lattice.explicit_sheet import ExplicitSheet
from lattice.grid import Grid
from lattice.ice import Ice
from lattice.implicit.engine import Engine
from lattice.loads import NodeLoad
from lattice.sheet import Sheet
from lattice.stiffness import hrennikoff
from rubble.cut import plane
from rubble.layer import RubbleLayer
from rubble.outline import convex_parts
from rubble.physics import RubblePhysics
from rubble.piece import Slab

RHO_I, RHO_W, G, H, LENGTH, WIDTH = 846.0, 1006.0, 9.81, 3.0, 8.0, 2.8
BOX = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) * np.array([LENGTH, H]) / 2.0
LIFT = (RHO_W - RHO_I) * G * LENGTH * H * WIDTH  #: of a flooded block under water [N]


def layer_with(solids, **physics):
    return RubbleLayer(
        RubblePhysics(rho_i=RHO_I, rho_w=RHO_W, thickness=H, **physics), WIDTH, solids=lambda y: plane(solids)
    )


def add(layer, x, z, angle=0.0, flooded=None):
    """A box with its middle at (x, z), its long axis at ``angle``."""
    c, s = np.cos(angle), np.sin(angle)
    middle = x * c + z * s
    layer.add_block(
        0,
        Slab(
            BOX @ np.array([(c, s), (-s, c)]) + [x, z],
            middle + np.array([-0.5, 0.5]) * LENGTH,
            np.array([WIDTH]),
            RHO_I,
            angle,
        ),
        flooded=flooded,
    )


def budget_of(layer):
    """Budget of a layer without lattice, with its load."""
    terms = {name: tuple(f) for name, f in layer.budget.items()}
    x, _, z = sum((layer.sheet_forces(k).sum(axis=0) for k in layer.sections), np.zeros(3))
    load = layer.load_on_structure.sum(axis=0)
    return force_budget(load, {**terms, "staggering": (-x, -z)}), load


@pytest.mark.parametrize("depth", [9.0, 12.0])
def test_a_dry_block_held_under_water_by_a_slope(depth):
    """Along a slope of 45 degrees with enough friction: dead lift, and the head that its dry top does not carry."""
    slope = convex_parts(np.array([(30.0, -30.0), (-5.0, 5.0)]), back=60.0)
    layer = layer_with(slope, mu_structure=2.0, backfill="none")
    normal = np.array([1.0, 1.0]) / np.sqrt(2.0)  # of the top, towards the slope
    add(layer, *(np.array([depth, -depth]) - H / 2.0 * normal), angle=-np.pi / 4)
    for _ in range(80):
        layer.advance(10)
    budget, load = budget_of(layer)
    head = RHO_W * G * depth * LENGTH * WIDTH * normal
    assert (budget["fx_dry_tops"], budget["fz_dry_tops"]) == pytest.approx(tuple(head), rel=2e-3)
    assert budget["fz_flooded_rubble"] == pytest.approx(LIFT, rel=1e-9)
    assert abs(budget["fx_flooded_rubble"]) < 1e-9 * LIFT
    assert load[[0, 2]] == pytest.approx((head[0], head[1] + LIFT), rel=2e-3)
    assert max(abs(budget["fx_residual"]), abs(budget["fz_residual"])) < 1e-9 * load[2]


def test_a_pile_that_floats_under_a_lid():
    """Three flooded blocks lie over each other: the lid carries the lift of all of them, nothing else acts."""
    lid = [np.array([(-5.0, -10.0), (5.0, -10.0), (5.0, -8.0), (-5.0, -8.0)])]
    layer = layer_with(lid)
    for k in range(3):
        add(layer, 0.0, -11.6 - 3.1 * k)
    for _ in range(400):
        layer.advance(10)
    budget, load = budget_of(layer)
    assert budget["fz_flooded_rubble"] == pytest.approx(3 * LIFT, rel=1e-9)
    assert load[2] == pytest.approx(3 * LIFT, rel=1e-3)
    assert all(abs(budget[f"fz_{name}"]) < 1e-3 * LIFT for name in TERMS if name != "flooded_rubble")
    assert abs(budget["fz_residual"]) < 1e-9 * load[2]


def press(sheet, down, ahead, windows, tolerance):
    """An even load on the nodes (n,) [N]; in each window the terms add up to ``tolerance`` of it. Last reaction."""
    for k in range(windows):
        force_u, force_q = np.zeros((sheet.grid.nodes, 2)), np.zeros((sheet.grid.nodes, 3))
        force_u[:, 0], force_q[:, 0] = ahead, -down
        load = NodeLoad("load", force_u, force_q)
        r = sheet.advance(0.05 * k, [load], NoContact(), lambda nodes: None).reaction
        parts = np.array([r.foundation, r.drag, r.inertia, r.held, r.applied["load"]])
        assert np.abs(parts.sum(axis=0)).max() < tolerance * down.sum()
    return r


@pytest.mark.parametrize("long_step", [1, 4])
def test_a_sheet_pressed_down_and_pushed_ahead(long_step):
    """Under an even load the foundation carries all of it; what pushes it ahead is held at its back edge."""
    grid = Grid(13, 12, 2.0)
    ice = Ice(E=8.7e9, nu=1 / 3, h=1.0, rho_i=RHO_I, rho_w=RHO_W, sigma_t=750e3, sigma_f=750e3, sigma_c=4e6)
    held = np.zeros(grid.nodes, bool)
    held[grid.edge_nodes("x-")] = True
    engine = Engine(grid, ice, hrennikoff(ice), held_in_plane=held, damping=2e4, alpha=1e-2)
    sheet = Sheet(engine, 0.05, long_step=long_step)
    down, ahead = 100.0 * grid.area, 50.0 * grid.area
    r = press(sheet, down, ahead, windows=400, tolerance=1e-7)
    assert r.applied["load"] == pytest.approx((ahead.sum(), -down.sum()), rel=1e-12)
    assert r.foundation[1] == pytest.approx(down.sum(), rel=1e-4)
    assert r.held[0] == pytest.approx(-ahead.sum(), rel=1e-4)


def test_the_dynamic_engine_adds_up_within_its_quadrature():
    """A floe that springs back under an even load that comes at once: waves, but the sum is right to a thousandth."""
    grid = Grid(9, 8, 4.0)
    ice = Ice(E=8.7e9, nu=1 / 3, h=1.0, rho_i=RHO_I, rho_w=RHO_W, sigma_t=75e6, sigma_f=75e6, sigma_c=4e8)
    held = np.zeros(grid.nodes, bool)
    held[grid.edge_nodes("x-")] = True
    engine = ExplicitEngine(grid, ice, hrennikoff(ice), 0.05, held_in_plane=held, damping=500.0, alpha=1e-3)
    sheet = ExplicitSheet(engine)
    down, ahead = 100.0 * grid.area, 50.0 * grid.area
    r = press(sheet, down, ahead, windows=20, tolerance=1e-3)
    assert r.foundation[1] > 0.1 * down.sum()


CASE = ("sheet.nodes=[40, 40]", "contact.strength='2000 kPa'", "rubble.initial_volume='600 m^3'")


def coupled(*overrides, twin=None):
    """Loads (n, 2), budgets and event kinds of a short run that breaks; ``twin`` may change its scheduler."""
    scheduler = build(load_scenario("van_vliet_2018_floe_165m", [*CASE, *overrides]))
    if twin is not None:
        twin(scheduler)
    load, budgets, kinds = [], [], []
    while scheduler.t_ns < 10.5e9:
        frame = scheduler.macro_step()
        load.append(frame.load.sum(axis=0)[[0, 2]])
        budgets.append(frame.budget)
        kinds += [e.kind for e in frame.events]
    return np.array(load), budgets, kinds


def residual(budgets):
    return np.array([[b["fx_residual"], b["fz_residual"]] for b in budgets])


@pytest.fixture(scope="module")
def short_run():
    return coupled()


def test_the_terms_of_a_coupled_run_add_up_to_the_load(short_run):
    """Sheet that breaks, rubble below it: to rounding, since rubble on the sheet keeps it from long steps."""
    load, budgets, kinds = short_run
    assert "hand_over" in kinds
    for axis, k in AXES.items():
        total = np.array([sum(b[f"{axis}_{name}"] for name in TERMS) for b in budgets])
        assert np.abs(total - load[:, k])[1:].max() < 1e-9 * load.max()


def test_every_term_of_a_coupled_run_is_at_work(short_run):
    load, budgets, _ = short_run
    for name in TERMS:
        axis = "fx" if name == "held" else "fz"
        assert max(abs(b[f"{axis}_{name}"]) for b in budgets) > 1e-4 * load.max(), name


@pytest.mark.parametrize("name", ["dry_tops", "flooded_rubble", "drag", "inertia", "staggering"])
def test_a_twin_with_a_wrong_sign_is_rejected(name):
    """The rubble's terms one by one with the other sign: the residual shows it at once."""

    def turn(scheduler):
        wrong = property(
            lambda self: {n: (-x, -z) if n == name else (x, z) for n, (x, z) in RubblePort.budget.__get__(self).items()}
        )
        scheduler.rubble.__class__ = type("Twin", (RubblePort,), {"budget": wrong})

    load, budgets, _ = coupled(twin=turn)
    assert np.abs(residual(budgets)[1:]).max() > 1e-3 * load.max()


def test_an_unknown_term_is_refused():
    with pytest.raises(ValueError, match="unknown terms"):
        force_budget(np.zeros(3), {"magic": (0.0, 1.0)})


def test_staggering_telescopes(short_run):
    """Its impulse stays below what the rubble exerts in a few windows: it moves force in time, it does not make any."""
    _, budgets, _ = short_run
    shift = np.array([b["fz_staggering"] for b in budgets])
    assert np.abs(np.cumsum(shift)).max() < 4.0 * np.abs(shift).max()


def test_an_implicit_scheme_leaves_no_staggering():
    """Where sheet and rubble agree on their force the term vanishes with the tolerance, and the sum still closes."""
    largest = {}
    for scheme in ("serial-explicit", "serial-implicit"):
        scheduler = build(
            load_scenario("van_vliet_2018_floe_165m", [*CASE, f"coupling.scheme='{scheme}'", "coupling.tolerance=1e-5"])
        )
        frames = [scheduler.macro_step() for _ in range(20)]
        largest[scheme] = max(abs(f.budget["fz_staggering"]) for f in frames)
        load = max(abs(f.load.sum(axis=0)[2]) for f in frames)
        assert max(abs(f.budget["fz_residual"]) for f in frames) < 1e-9 * load
    assert largest["serial-implicit"] < 0.01 * largest["serial-explicit"]
