"""The sheet whose cracks close: what it conserves, what it remembers, and the strength of its layers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from lattice.contact import NoContact
from lattice.cracks.beam import SLOWLY, Beam, BeamTest, cut_beam, layer_strength, standard_beam
from lattice.cracks.hinges import hinges
from lattice.cracks.law import law_of
from lattice.cracks.make import Measured, cracking_sheet
from lattice.explicit.engine import SubSteps
from lattice.grid import Grid
from lattice.ice import Ice
from lattice.loads import NodeLoad
from lattice.stiffness import hrennikoff

ICE = Ice(E=8.7e9, nu=1 / 3, h=3.0, rho_i=846.0, rho_w=1006.0, sigma_f=750e3, sigma_c=4e6)
GRID = Grid(13, 13, 3.0, -36.0, -18.0)


def sheet_of(strength=450e3, fracture_energy=300.0, scaling=1.0):
    held = np.zeros((GRID.nodes, 2), bool)
    held[GRID.edge_nodes("x-")] = True
    measured = Measured(fracture_energy, 0.3, strength=strength)
    damping = 0.1 * np.sqrt(ICE.k_f * ICE.rho_i * ICE.h)
    options = {"held_in_plane": held, "damping": damping, "alpha": 1e-4, "sub_steps": SubSteps(scaling=scaling)}
    return cracking_sheet(GRID, ICE, hrennikoff(ICE), 0.05, measured, **options)


def pushed(sheet, seconds, force, ramp=1.0):
    """A push down and along on the middle of the front edge, growing over ``ramp`` [s]; lowest point of the edge."""
    node, low, t = GRID.node(GRID.nx - 1, GRID.ny // 2), [], getattr(sheet, "t", 0.0)
    end = t + seconds
    while t < end - 1e-9:
        u, q = np.zeros((GRID.nodes, 2)), np.zeros((GRID.nodes, 3))
        share = min((t + 0.05) / ramp, 1.0)
        u[node, 0], q[node, 0] = -share * force[0], -share * force[1]
        sheet.advance(t, [NodeLoad("push", u, q)], NoContact(), lambda _: None)
        t += 0.05
        low.append(float(sheet.state.q[node, 0]))
    sheet.t = t
    return np.array(low)


def test_a_push_cracks_the_sheet_and_it_holds():
    sheet = sheet_of()
    low = pushed(sheet, 2.5, (0.0, 4e6))
    assert sheet.engine.layered.count > 5
    assert np.isfinite(low).all()
    e, lost = sheet.energy, sum(sheet.engine.crack_losses.values())
    assert lost > 0.0
    assert abs(e.residual) < 1e-5 * abs(e.received)
    assert abs(e.residual) < 0.05 * lost
    assert abs(e.residual + lost) > 0.5 * lost  # the wrong twin: a balance that does not know what cracks take


def test_a_window_again_has_the_same_bits():
    sheet = sheet_of()
    pushed(sheet, 1.0, (0.0, 4e6))
    saved = sheet.save()
    first = pushed(sheet, 0.5, (0.0, 4e6))
    count, losses = sheet.engine.layered.count, dict(sheet.engine.crack_losses)
    sheet.restore(saved)
    again = pushed(sheet, 0.5, (0.0, 4e6))
    assert np.array_equal(first, again)
    assert (sheet.engine.layered.count, sheet.engine.crack_losses) == (count, losses)


def test_brittle_ice_cracks_under_less_than_ice_that_softens():
    """With one strength of the layers, the fracture energy holds the crack back."""
    brittle, soft = sheet_of(fracture_energy=0.0), sheet_of(fracture_energy=1000.0)
    assert pushed(brittle, 1.5, (0.0, 3e6)).min() < pushed(soft, 1.5, (0.0, 3e6)).min()


def test_scaled_inertia_leaves_slow_motion_alone():
    """Four times the fast inertia, the same deflection of the whole sheet under a slow push within 1 %."""
    fast, slow = sheet_of(strength=1e9), sheet_of(strength=1e9, scaling=4.0)
    a, b = pushed(fast, 4.0, (1e6, 1e6), ramp=2.0), pushed(slow, 4.0, (1e6, 1e6), ramp=2.0)
    assert slow.engine.dt > 1.3 * fast.engine.dt
    assert b[-1] == pytest.approx(a[-1], rel=0.01)


# ---- the strength of the layers -----------------------------------------------------------------------------------


@pytest.mark.parametrize(("nominal", "fracture_energy"), [(750e3, 300.0), (967e3, 0.0)])
def test_the_simulated_beam_breaks_at_its_load(nominal, fracture_energy):
    """Basin beam, 18 x 6 x 3 m, in cells of 2.8 m: within 2 % of what was asked for."""
    beam = Beam(18.0, 6.0, nominal * 6.0 * 9.0 / (6.0 * 18.0))
    strength = layer_strength(ICE, 0.3, fracture_energy, beam, 2.8)
    layers, cut = replace(ICE, sigma_t=strength, sigma_f=strength), cut_beam(beam, 2.8)
    found = BeamTest(layers, law_of(layers, fracture_energy, 0.3, cut.grid.d), cut, 1.5 * SLOWLY).strength()
    assert found == pytest.approx(nominal, rel=0.02)


def test_a_froude_copy_of_the_beam_has_the_same_layers():
    """1:25, E and strengths by 1/25, fracture energy by 1/625; with a test of 6 s at every scale it would not."""
    beam, small = Beam(18.0, 6.0, 375e3), Beam(18.0 / 25, 6.0 / 25, 375e3 / 25**3)
    copy = replace(
        ICE,
        h=ICE.h / 25,
        E=ICE.E / 25,
        sigma_t=ICE.sigma_t / 25,
        sigma_c=ICE.sigma_c / 25,
        sigma_shear=ICE.sigma_shear / 25,
    )
    full, model = layer_strength(ICE, 0.3, 300.0, beam, 2.8), layer_strength(copy, 0.3, 300.0 / 625, small, 2.8 / 25)
    assert 25.0 * model == pytest.approx(full, rel=1e-9)


def test_a_beam_of_usual_proportions_breaks_at_the_flexural_strength():
    assert standard_beam(ICE).stress(ICE.h) == pytest.approx(ICE.sigma_f, rel=1e-12)
    assert (standard_beam(ICE).length, standard_beam(ICE).width) == (18.0, 6.0)


# ---- hinges -------------------------------------------------------------------------------------------------------


def test_a_piece_between_deep_cracks_is_hinged_and_what_is_held_is_not():
    whole = np.ones((GRID.nx - 1, GRID.ny - 1), bool)
    whole[8, :] = False  # a crack across: everything in front of it is surrounded
    deep = np.flatnonzero(~whole.ravel())
    held, present = np.zeros(GRID.nodes, bool), np.ones(GRID.nodes, bool)
    held[GRID.edge_nodes("x-")] = True
    found = hinges(GRID, whole.ravel(), deep, present, held, 0.5)
    rows = np.arange(GRID.nodes) // GRID.ny
    assert np.array_equal(found.hinged, rows > 8)
    assert len(found.pieces) == 1
    assert found.parts == 1
    halves = hinges(GRID, whole.ravel(), deep, present, held, 0.2)
    assert not halves.hinged.any()  # a part of more than a fifth of the floe is half of a floe
    assert halves.parts == 2


class JumpingPush:
    """A constant push on the front edge whose height above the middle changes between two windows."""

    def __init__(self):
        self.nodes = np.array([GRID.node(GRID.nx - 1, j) for j in range(4, 9)])
        self.height, self.lead = np.ones(5), np.zeros(5)

    def evaluate(self, t, y):
        force = np.zeros((5, 3))
        force[:, 0] = -2e6 * min(t, 1.0)
        return force, np.zeros((5, 3, 3))


def test_a_push_that_jumps_between_two_windows_leaves_no_residual():
    """Booked with velocities at whole sub-steps, the jump of the moment would leave dt^2 a . F / 4: 9 J."""
    sheet, push, before = sheet_of(strength=1e12), JumpingPush(), 0.0
    for k in range(53):
        sheet.advance(0.05 * k, [], push, lambda _: None)
        if k == 51:
            assert abs(sheet.energy.residual - before) < 1.0
        before = sheet.energy.residual
        if k == 50:
            push.height = push.height - 0.05


def test_a_layered_cell_between_two_pieces_is_booked_once():
    """It goes with the piece that leaves first; booked with both, its energy would be missing from the balance."""
    sheet = sheet_of()
    pushed(sheet, 2.5, (0.0, 4e6))
    layered, before = sheet.engine.layered, sheet.energy.residual
    energies = sheet.engine._energies(sheet.state.u, sheet.state.q)
    cell = int(layered.cell[np.argmax(energies)])
    assert energies.max() > 10.0 * abs(before)
    for node in GRID.cell_nodes[cell][:2]:
        live = sheet.live_cells
        sheet.present[node] = False
        sheet.depart(np.array([node]), live)
    sheet.energy.measure(sheet.state, sheet.live_cells, sheet.present)
    assert cell not in layered.cell
    assert sheet.energy.residual == pytest.approx(before, abs=1e-3 * energies.max())
