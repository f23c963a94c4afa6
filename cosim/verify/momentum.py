"""Case `momentum`: head-on and oblique impacts of two blocks, and the balance of impulses of a lively pile."""

from __future__ import annotations

from typing import Any

import numpy as np

from cosim.verify.case import CaseResult, at_most, near
from rubble.arrays import Array
from rubble.cut import plane
from rubble.geometry import place
from rubble.layer import RubbleLayer
from rubble.outline import convex_parts
from rubble.physics import RubblePhysics
from rubble.piece import Slab

PARAMETERS: dict[str, Any] = {
    "e": 0.3,
    "mu": 0.2,
    "rho_i": 846.0,
    "rho_w": 1006.0,
    "v": 2.0,
    "turned": 30.0,
    "offset": 0.4,
    "substeps": 10000,
}
SOURCE = "Newton's impact law with Coulomb friction for two rigid bodies"
A, B = (2.0, 2.0), (3.0, 4.0)  #: extents of the two blocks [m]


def box(size: tuple[float, float]) -> Array:
    """(4, 2) corners of a box around the origin."""
    x, z = size[0] / 2.0, size[1] / 2.0
    return np.array([(-x, -z), (x, -z), (x, z), (-x, z)])


def collide(p: dict[str, Any], turned: float, offset: float) -> tuple[Array, Array, Array]:
    """Velocities (2, 3) x, z, omega before and after an impact in air, and lever arms (2, 2) of the contact."""
    physics = RubblePhysics(
        rho_i=p["rho_i"],
        rho_w=p["rho_w"],
        g=0.0,
        restitution=p["e"],
        mu_ice_ice=p["mu"],
        form_drag=0.0,
        skin_drag=0.0,
        thickness=0.1,
        iterations=100,
    )
    layer = RubbleLayer(physics, 1.0)
    corner = float(place(box(A), 0.0, 0.0, turned, 0.0, 0.0)[:, 0].max())
    for x, z, size, angle, v in ((-corner - 0.5, 100.0 + offset, A, turned, p["v"]), (B[0] / 2, 100.0, B, 0.0, 0.0)):
        middle = x * np.cos(angle) + z * np.sin(angle)
        layer.add_block(
            0,
            Slab(
                place(box(size), x, z, angle, 0.0, 0.0),
                middle + np.array([-size[0], size[0]]) / 2,
                np.array([1.0]),
                p["rho_i"],
                angle,
            ),
            (v, -0.3 * v if turned else 0.0),
        )
    before = _motion(layer)
    while not layer.store.tables.sums[:, 3].any():
        layer.advance(1)
    outline, t = layer.block(0).outline, layer.table()
    tip = outline[np.argmax(outline[:, 0])]
    middle = np.array([0.5 * (tip[0] + t.position[1, 0] - B[0] / 2), tip[1]])  # of the overlap: both feel it there
    return before, _motion(layer), middle - t.position[:, [0, 2]]


def _motion(layer: RubbleLayer) -> Array:
    t = layer.table()
    return np.column_stack([t.velocity[:, [0, 2]], t.omega])


def impact(p: dict[str, Any], before: Array, r: Array, inertia: bool) -> Array:
    """Velocities after a one-point impact on a face with normal +x.

    Restitution e acts along it, friction mu against the slip that is left across.
    """
    mass = p["rho_i"] * np.array([A[0] * A[1], B[0] * B[1]])
    moment = mass * np.array([A[0] ** 2 + A[1] ** 2, B[0] ** 2 + B[1] ** 2]) / 12.0
    jacobian = np.array(
        [
            [(-1.0, 0.0, r[0, 1] * inertia), (1.0, 0.0, -r[1, 1] * inertia)],
            [(0.0, -1.0, -r[0, 0] * inertia), (0.0, 1.0, r[1, 0] * inertia)],
        ]
    ).reshape(2, 6)
    m = np.array([mass[0], mass[0], moment[0], mass[1], mass[1], moment[1]])
    k, u = jacobian / m @ jacobian.T, jacobian @ before.ravel()
    j = np.linalg.solve(k, [-(1.0 + p["e"]) * u[0], -u[1]])  # the slip stops ...
    if abs(j[1]) > p["mu"] * j[0]:  # ... or goes on
        sign = np.sign(j[1])
        j[0] = -(1.0 + p["e"]) * u[0] / (k[0, 0] + k[0, 1] * sign * p["mu"])
        j[1] = sign * p["mu"] * j[0]
    return np.asarray((before.ravel() + jacobian.T @ j / m).reshape(2, 3))


def pile_balance(p: dict[str, Any], substeps: int) -> tuple[float, float]:
    """Momenta gained less those received over a run, and the same with those from the structure reversed.

    Three of them and three angular ones about the origin; each as part of what passed through the plates.
    """
    physics = RubblePhysics(
        rho_i=p["rho_i"], rho_w=p["rho_w"], thickness=3.0, added_mass=0.2, added_inertia=0.2, restitution=p["e"]
    )
    face = np.array([(30.0, -30.0), (-5.0, 5.0)])
    layer = RubbleLayer(physics, 1.5, solids=lambda _: plane(convex_parts(face, back=60.0)))
    for i in range(12):
        x, z = -4.0 - 5.0 * (i % 4), -4.0 - 4.0 * (i // 4)
        outline = place(box((4.0, 2.5)), x, z, 0.0, 0.0, 0.0)
        slab = Slab(outline, np.array([x - 2.0, x + 2.0]), np.array([3.0]), p["rho_i"])
        layer.add_block(0, slab, (1.0, 0.2 * (-1) ** i, 0.0), y=0.4 * (i % 3))
    received, scale, start = layer.runner.momenta, np.zeros(6), layer.store.carried
    before = received.copy()
    for _ in range(substeps // 10):
        layer.advance(10)
        scale += np.abs(received - before).sum(axis=0)
        before = received.copy()
    gained = layer.store.carried - start
    signs = np.ones(4), np.array([-1.0, 1.0, 1.0, 1.0])
    errors = [float((np.abs(gained - sign @ received) / scale).max()) for sign in signs]
    return errors[0], errors[1]


def run(p: dict[str, Any], quick: bool) -> CaseResult:
    """Velocities after impacts, and the balance of a pile with its twin; ``quick``: fewer sub-steps."""
    if not 0.0 <= p["e"] <= 1.0 or not p["mu"] >= 0.0 or not p["v"] > 0.0 or not 0.0 < abs(p["turned"]) < 45.0:
        raise ValueError("momentum: give 0 <= e <= 1, mu >= 0, v > 0 and a turn between 0 and 45 degrees")
    head, head_after, arms = collide({**p, "mu": 0.0}, 0.0, 0.0)
    straight = impact({**p, "mu": 0.0}, head, arms, False)
    before, after, arms = collide(p, np.radians(p["turned"]), p["offset"])
    exact = impact(p, before, arms, True)
    balance, reversed_balance = pile_balance(p, 1000 if quick else int(p["substeps"]))
    return CaseResult(
        "momentum",
        p,
        [
            near("head-on: velocities along x after the impact", head_after[:, 0], "m/s", straight[:, 0], 1e-3, SOURCE),
            near("oblique: velocities x, z, omega after the impact", after, "m/s, rad/s", exact, 1e-3, SOURCE),
            at_most(
                "pile: momenta gained less received, six components, part of those received",
                balance,
                "-",
                1e-12,
                "Newton's second law",
            ),
            near(
                "the same with the structure's impulse reversed is refused (1 = yes)",
                float(reversed_balance > 1e-3),
                "-",
                1.0,
                0.0,
                "a wrong sign must be found",
            ),
        ],
    )
