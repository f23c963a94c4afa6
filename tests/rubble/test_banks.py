"""Plates meet the sides of the sheet: a piece that moves sideways stops at the bank of the next column."""

from __future__ import annotations

import numpy as np
import pytest

from rubble.layer import RubbleLayer
from rubble.physics import RubblePhysics
from rubble.piece import Start, prism_at
from rubble.sheet import SheetMotion

H, PITCH, RHO_I, RHO_W, LENGTH = 1.0, 2.0, 900.0, 1000.0, 4.0
LEVEL = H / 2 - H * RHO_I / RHO_W


def beside_a_sheet(y, speed, mu=0.0, width=2.0):
    """A plate at ``y`` that moves along y, and a sheet in section 0 alone."""
    physics = RubblePhysics(
        rho_i=RHO_I, rho_w=RHO_W, thickness=H, mu_ice_ice=mu, form_drag=0.0, skin_drag=0.0, restitution=0.0
    )
    layer = RubbleLayer(physics, PITCH)
    x = -2.0 - 2.0 * np.arange(6)
    layer.set_sheet(0, SheetMotion(x, np.full(6, LEVEL), x[0] + 1.0, np.zeros((6, 2)), H))
    layer.set_yields([0], np.zeros((2, 1, 1)))
    box = np.array([(-LENGTH, -H), (LENGTH, -H), (LENGTH, H), (-LENGTH, H)]) / 2
    start = Start(np.array([-6.0, y, LEVEL]), np.array([1.0, 0, 0, 0]), np.array([0.1, speed, 0.0]), np.zeros(3))
    layer.add_plate([prism_at(box, 0.0, width, RHO_I)], start)
    return layer


@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize("width", [2.0, 3.0])
def test_a_plate_stops_at_the_bank(side, width):
    """The bank is half a section from the plane; without friction what leads along it goes on."""
    layer = beside_a_sheet(side * 4.0, -side * 0.2, width=width)
    mass, impulse = layer.mass, 0.0
    for _ in range(260):
        layer.advance(10)
        impulse += float(layer.sheet_forces(0)[:, 1].sum()) * 0.05
    plate = layer.blocks[0]
    assert side * plate.position[1] == pytest.approx(PITCH / 2 + width / 2, abs=2 * layer.physics.slop)
    assert abs(plate.velocity[1]) < 1e-9
    assert plate.velocity[0] == pytest.approx(0.1, rel=1e-9)
    assert impulse == pytest.approx(-side * 0.2 * mass, rel=0.05)  # with what the correction of overlap has taken


def test_a_bank_rubs():
    """A plate that is pressed on it slows down along it; without the bank's friction it would not."""
    layer = beside_a_sheet(2.1, -0.2, mu=0.5)
    layer.advance(400)
    assert layer.blocks[0].velocity[0] == pytest.approx(0.1 - 0.5 * 0.2, abs=1e-3)


def test_a_plate_under_the_sheet_passes():
    """Where both have nothing in common as seen along y there is no bank."""
    layer = beside_a_sheet(4.0, -0.2)
    layer.blocks[0].position[2] -= 1.5 * H
    layer.blocks[0].rows.moved[:] *= 1e9  # so heavy that its lift does not matter
    layer.blocks[0].rows.inverse_mass[0] /= 1e9
    layer.advance(2000)
    assert layer.blocks[0].position[1] == pytest.approx(2.0, abs=1e-3)
