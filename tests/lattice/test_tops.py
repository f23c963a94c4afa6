"""Tops that flood and bottoms that leave the water: rigid plates whose motion is one ordinary differential equation."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import root

from lattice.contact import NoContact
from lattice.explicit.engine import ExplicitEngine
from lattice.explicit_sheet import ExplicitSheet
from lattice.grid import Grid
from lattice.ice import Ice
from lattice.implicit.engine import Engine
from lattice.loads import NodeLoad
from lattice.sheet import Sheet
from lattice.state import State, StepError
from lattice.stiffness import hrennikoff
from lattice.tops import ABOVE, BELOW

GRID = Grid(5, 4, 3.0)
ICE = Ice(E=8.7e9, nu=1 / 3, h=3.0, rho_i=846.0, rho_w=1006.0, sigma_t=1e15, sigma_f=1e15, sigma_c=5e15)
MASS, DRAFT, WINDOW = ICE.rho_i * ICE.h, ICE.h - ICE.freeboard, 0.05
ENGINES = [Sheet, ExplicitSheet]


def floe(engine, rate, damping=0.0, lattice=GRID, ice=ICE):
    """A floe that floats freely; without a rate its water is linear."""
    options = {"held_in_plane": np.zeros(lattice.nodes, bool), "damping": damping, "alpha": 1e-3}
    if engine is Sheet:
        sheet = Sheet(Engine(lattice, ice, hrennikoff(ice), **options), WINDOW)
    else:
        sheet = ExplicitSheet(ExplicitEngine(lattice, ice, hrennikoff(ice), WINDOW, **options))
    if rate is not None:
        sheet.flood(rate)
    return sheet


def weight(sheet, pressure):
    """A load of so much per area, upwards [Pa]."""
    force = np.zeros((sheet.grid.nodes, 3))
    force[:, 0] = pressure * sheet.grid.area
    return NodeLoad("weight", np.zeros((sheet.grid.nodes, 2)), force)


def move(sheet, pressure, windows):
    """Mean deflection, flooded part and outcome at the end of each window."""
    rows = []
    for k in range(windows):
        out = sheet.advance(k * WINDOW, [weight(sheet, pressure)], NoContact(), lambda nodes: None)
        flooded = 0.0 if sheet.tops is None else sheet.tops.flooded.mean()
        rows.append((sheet.state.q[:, 0].mean(), flooded, out))
    w, flooded, outs = zip(*rows, strict=True)
    return np.array(w), np.array(flooded), outs


def rigid(pressure, rate, damping, windows):
    """The same for a rigid plate: m w'' + c w' + k w = p + water, from rest afloat."""
    k, freeboard = ICE.k_f, ICE.freeboard

    def slope(_, y):
        w, v, part = y
        head, out = max(-freeboard - w, 0.0), max(w - DRAFT, 0.0)
        force = pressure - k * w - damping * v - min(part, 1.0) * k * head + k * out
        return v, force / MASS, rate if head > 0.0 else 0.0

    times = WINDOW * np.arange(1, windows + 1)
    return solve_ivp(slope, (0.0, times[-1]), (0.0, 0.0, 0.0), t_eval=times, max_step=2e-3, rtol=1e-9).y


@pytest.mark.parametrize("engine", ENGINES)
def test_a_loaded_plate_sinks_as_its_top_floods(engine):
    """Set down with 0.7 of the weight that would press its top under, it swings below and sinks for good."""
    pressure, rate, damping, windows = -0.7 * ICE.k_f * ICE.freeboard, 0.5, 500.0, 80
    w, flooded, _ = move(floe(engine, rate, damping), pressure, windows)
    truth = rigid(pressure, rate, damping, windows)
    np.testing.assert_allclose(w, truth[0], atol=0.01 * np.abs(truth[0]).max())
    omega = np.sqrt(ICE.k_f / MASS)
    assert flooded.max() > 0.0
    free, _, _ = move(floe(engine, rate), pressure, windows)
    first = np.flatnonzero(free < -ICE.freeboard)[0]  # undamped: 0.7 freeboard (1 - cos omega t) = freeboard
    assert first == int(np.arccos(1.0 - 1.0 / 0.7) / omega / WINDOW)
    dry, _, _ = move(floe(engine, None, damping), pressure, windows)
    assert np.abs(dry - truth[0]).max() > 0.05 * np.abs(truth[0]).max()


@pytest.mark.parametrize("engine", ENGINES)
def test_a_plate_that_lies_under_water_goes_down_as_the_head_fills(engine):
    """At rest under s0 k_f per area, s0 > freeboard, it passes (s0 - f freeboard) / (1 - f) while f = t / T."""
    s0, filling = 1.2 * ICE.freeboard, 40.0
    sheet = floe(engine, 1.0 / filling, 100.0)
    sheet.state = State.rest(GRID.nodes)._replace(q=np.tile((-s0, 0.0, 0.0), (GRID.nodes, 1)))
    w, flooded, _ = move(sheet, -s0 * ICE.k_f, 600)
    part = WINDOW * np.arange(1, 601) / filling
    np.testing.assert_allclose(flooded, part, rtol=1e-9)
    depth = (s0 - part * ICE.freeboard) / (1.0 - part)
    np.testing.assert_allclose(-w[::100], depth[::100], rtol=0.01)
    assert -w[-1] > 1.4 * s0
    dry = floe(engine, None, 100.0)
    dry.state = State.rest(GRID.nodes)._replace(q=np.tile((-s0, 0.0, 0.0), (GRID.nodes, 1)))
    np.testing.assert_allclose(move(dry, -s0 * ICE.k_f, 100)[0], -s0, rtol=1e-6)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_flooded_plate_sinks_at_the_speed_of_its_weight_less_its_buoyancy(engine):
    excess, damping = 0.1 * ICE.k_f * ICE.freeboard, 2000.0
    w, _, outs = move(floe(engine, np.inf, damping), -ICE.k_f * ICE.freeboard - excess, 600)
    speed = -np.diff(w[-20:]).mean() / WINDOW
    assert speed == pytest.approx(excess / damping, rel=1e-3)
    area = GRID.area.sum()
    lift = outs[-1].reaction.foundation[1] + outs[-1].reaction.applied[ABOVE][1]
    assert lift == pytest.approx(ICE.k_f * ICE.freeboard * area, rel=1e-3)


@pytest.mark.parametrize(("share", "rests"), [(0.8, True), (1.05, False)])
def test_a_rigid_floe_pressed_down_along_an_edge_carries_what_flooded_ice_can(share, rests):
    """Below the limit it comes to rest where forces and moments on a rigid plate balance; above it goes on sinking."""
    grid = Grid(12, 3, 3.0)
    length, width = 33.0, 6.0
    b = length - np.sqrt(length**2 / (1.0 + ICE.freeboard / DRAFT))  # freeboard a^2 = draft b (2 length - b)
    limit = ICE.k_f * width * (ICE.freeboard * (length - b) - DRAFT * b)
    sheet, front = floe(Sheet, np.inf, 4000.0, grid, replace(ICE, E=1e12)), grid.edge_nodes("x+")
    for k in range(900):
        load = NodeLoad("weight", np.zeros((grid.nodes, 2)), np.zeros((grid.nodes, 3)))
        load.force_q[front, 0] = -share * limit * grid.area[front] / grid.area[front].sum()
        out = sheet.advance(k * WINDOW, [load], NoContact(), lambda nodes: None)
        if out.pieces:
            break
    if not rests:
        assert out.pieces  # it has turned by 0.1 rad as a whole
        return

    arm = length - grid.xy[:, 0]

    def balance(y):
        lift = ICE.k_f * grid.area * np.clip(-y[0] - y[1] * arm, -DRAFT, ICE.freeboard)
        return lift.sum() / (share * limit) - 1.0, lift @ arm / (share * limit * length)

    rest = root(balance, (-1.0, 0.05))
    assert rest.success
    w = rest.x[0] + rest.x[1] * arm
    assert w.min() < -2.0 * ICE.freeboard
    np.testing.assert_allclose(sheet.state.q[:, 0], w, atol=0.01 * np.abs(w).max())


@pytest.mark.parametrize("engine", ENGINES)
def test_a_plate_lifted_out_of_the_water_weighs_what_it_weighs(engine):
    """Under 1.1 of its weight, upwards, it flies off with a tenth of g; on a linear foundation it swings."""
    pressure = 1.1 * MASS * ICE.g
    w, _, outs = move(floe(engine, 0.2), pressure, 80)
    up = np.flatnonzero(w > 1.05 * DRAFT)[1:]
    assert len(up) > 30
    np.testing.assert_allclose(np.diff(w[up], 2) / WINDOW**2, 0.1 * ICE.g, rtol=0.03)
    np.testing.assert_allclose(w, rigid(pressure, 0.2, 0.0, 80)[0], atol=2e-3 * w.max())
    assert outs[-1].reaction.applied[BELOW][1] > 0.0
    dry, _, _ = move(floe(engine, None), pressure, 80)
    assert dry.min() < 0.5 * DRAFT
    assert dry.max() < 2.3 * DRAFT < w.max()


@pytest.mark.parametrize(("engine", "tolerance"), [(Sheet, 1e-9), (ExplicitSheet, 1e-5)])
@pytest.mark.parametrize("pressure", [-0.8 * ICE.k_f * ICE.freeboard, 1.1 * MASS * ICE.g])
def test_energy_and_forces_close(engine, tolerance, pressure):
    """Both loads are booked by name; the twin whose water is not booked is off by far."""
    sheet = floe(engine, 0.2, 500.0)
    _, _, outs = move(sheet, pressure, 80)
    books, scale = sheet.energy, abs(sheet.energy.loads["weight"].work)
    water = books.loads[ABOVE].work + books.loads[BELOW].work
    assert abs(books.residual) < tolerance * scale
    assert abs(books.residual - water) > 1e-3 * scale
    for out in outs[::10]:
        r = out.reaction
        parts = np.array([r.foundation, r.drag, r.inertia, r.held, *r.applied.values()])
        assert np.abs(parts.sum(axis=0)).max() < 1e-3 * np.abs(parts).max()


@pytest.mark.parametrize("engine", ENGINES)
def test_what_follows_a_restored_sheet_has_the_same_bits(engine):
    sheet, pressure = floe(engine, 0.2), -0.8 * ICE.k_f * ICE.freeboard
    move(sheet, pressure, 40)
    saved, part = sheet.save(), sheet.tops.flooded.copy()
    assert 0.0 < part.max() < 1.0
    runs = []
    for _ in range(2):
        sheet.restore(saved)
        assert np.array_equal(sheet.tops.flooded, part)
        w, flooded, _ = move(sheet, pressure, 10)
        runs.append((w.tobytes(), flooded.tobytes()))
    assert runs[0] == runs[1]
    sheet.restore(saved)
    sheet.tops.flooded = 0.5 * part
    assert move(sheet, pressure, 10)[0].tobytes() != runs[0][0]  # a difference would be noticed


@pytest.mark.parametrize("engine", ENGINES)
def test_a_sheet_that_stays_afloat_has_the_bits_of_a_linear_foundation(engine):
    pressure = -0.3 * ICE.k_f * ICE.freeboard
    w, flooded, outs = move(floe(engine, 0.2), pressure, 40)
    linear, _, _ = move(floe(engine, None), pressure, 40)
    assert w.tobytes() == linear.tobytes()
    assert not flooded.any()
    assert outs[-1].reaction.applied[ABOVE] == outs[-1].reaction.applied[BELOW] == (0.0, 0.0)


def test_only_wet_nodes_carry_water_and_tops_drain():
    sheet = floe(Sheet, 0.2)
    q = np.zeros((GRID.nodes, 3))
    q[:7, 0] = -1.5 * ICE.freeboard
    wet = State.rest(GRID.nodes)._replace(q=q)
    (load,) = sheet.tops.loads(wet, sheet.present, 1.0)
    expected = -0.1 * ICE.k_f * GRID.area[:7] * 0.5 * ICE.freeboard  # in the middle of the first second of five
    np.testing.assert_allclose(load.force_q[:7, 0], expected, rtol=1e-12)
    assert not load.force_q[7:].any()
    np.testing.assert_allclose(sheet.tops.flooded, np.where(np.arange(GRID.nodes) < 7, 0.2, 0.0))
    assert sheet.tops.loads(State.rest(GRID.nodes), sheet.present, 1.0) == []
    assert not sheet.tops.flooded.any()


def test_what_cannot_be_is_refused():
    with pytest.raises(ValueError, match="filling rate of the tops"):
        floe(Sheet, -1.0)
    sheet = floe(Sheet, 0.2)
    with pytest.raises(StepError, match="beyond its freeboard"):
        sheet.rest_under([weight(sheet, -1.1 * ICE.k_f * ICE.freeboard)])
