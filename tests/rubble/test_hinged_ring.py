"""A piece of a ring of hinged pieces: a wedge that turns about its rear edge when its tip is pushed under water.

Its top stays dry, so that the water answers as a foundation, k = rho_w g, along the whole piece:

    F_tip = 2 psi k w (a L / 3 + L^2 / 12),   held down at the hinge: 2 psi k w (a L / 6 + L^2 / 12)

for a tip at radius a, a hinge at a + L, and half an opening angle psi.
"""

from __future__ import annotations

import numpy as np
import pytest

from rubble.books import CONTACT
from rubble.layer import RubbleLayer
from rubble.physics import RubblePhysics
from rubble.piece import Start, prism_at
from rubble.rig import Hinge

H, RHO_I, RHO_W, G, A, L, PSI, STRIPS = 3.0, 846.0, 1006.0, 9.81, 15.0, 20.0, 0.3, 40
LEVEL = H / 2 - H * RHO_I / RHO_W


def wedge():
    """Strips along the drift, each from the hinge at x = 0 to the tip at x = L or to the side of the wedge."""
    width = 2.0 * PSI * (A + L) / STRIPS
    prisms = []
    for k in range(STRIPS):
        y = (k + 0.5 - STRIPS / 2) * width
        front = A + L - max(A, abs(y) / PSI)
        box = np.array([(0.0, -H / 2), (front, -H / 2), (front, H / 2), (0.0, H / 2)])
        prisms.append(prism_at(box, y, width, RHO_I))
    return prisms


def forces(deflection, backfill="none"):
    """Forces down at the tip and at the hinge [N] when the tip has gone down slowly by ``deflection`` [m]."""
    physics = RubblePhysics(rho_i=RHO_I, rho_w=RHO_W, thickness=H, backfill=backfill, form_drag=5.0)
    layer = RubbleLayer(physics, 2.8)
    number = layer.add_plate(
        wedge(), Start(np.array([0.0, 0.0, LEVEL]), np.array([1.0, 0.0, 0.0, 0.0]), np.zeros(3), np.zeros(3))
    )
    for y in (-5.0, 5.0):
        Hinge(layer, number, (0.0, y, LEVEL), (0.0, 0.0, 0.0))
    speed = 0.02
    Hinge(layer, number, (L, 0.0, LEVEL), (0.0, 0.0, -speed))
    layer.advance(round((deflection / speed - 2.0) / physics.substep))
    before = layer.runner.momenta[CONTACT].copy()
    layer.advance(round(2.0 / physics.substep))  # mean of two seconds, in which the tip goes down by 4 cm
    px, _, pz, _, about_y, _ = (layer.runner.momenta[CONTACT] - before) / 2.0
    # about the hinge, at x = 0 and z = LEVEL: only the tip has an arm; turning (x, z) about y is z F_x - x F_z
    tip = (about_y - LEVEL * px) / L
    return tip, -pz - tip


@pytest.mark.parametrize("deflection", [0.4, 1.0])
def test_a_wedge_that_turns_about_its_hinge(deflection):
    tip, hinge = forces(deflection + 0.02)
    k = RHO_W * G
    assert tip == pytest.approx(2 * PSI * k * deflection * (A * L / 3 + L**2 / 12), rel=0.03)
    assert hinge == pytest.approx(2 * PSI * k * deflection * (A * L / 6 + L**2 / 12), rel=0.05)


def test_a_wedge_whose_top_floods_carries_less():
    """Twin: when water comes over the top that part of the foundation is gone."""
    dry, _ = forces(1.02)
    wet, _ = forces(1.02, backfill="full")
    assert wet < 0.8 * dry
