"""A cone with rubble in five sections, driven by a sheet; shared by the tests of this folder."""

import numpy as np

from rubble.cut import revolved
from rubble.layer import RubbleLayer
from rubble.outline import convex_parts
from rubble.physics import RubblePhysics
from rubble.piece import Slab
from rubble.sheet import SheetMotion

WIDTH, H = 2.8, 3.0
PHYSICS = RubblePhysics(rho_i=846.0, rho_w=1006.0, thickness=H)


def cone_cut(y):
    """Cone of 45 degrees, radius 15 m at the waterline, 5 m at its neck in 10 m depth: r = 15 + z."""
    z = np.concatenate([[-20.0], np.linspace(-10.0, 5.0, 61)])
    square = np.maximum(15 + z, 5.0) ** 2 - y**2
    keep = square > 0
    return revolved(convex_parts(np.column_stack([-np.sqrt(square[keep]), z[keep]])))


def rectangle(x0, z0, x1, z1):
    return np.array([(x0, z0), (x1, z0), (x1, z1), (x0, z1)], dtype=float)


def add(layer, key, x, z, length=5.0, velocity=(0.5, 0.0), y=None, alone=True):
    ends = np.array([x, x + length])
    return layer.add_block(
        key,
        Slab(rectangle(x, z - H, x + length, z), ends, np.array([WIDTH]), 846.0),
        velocity,
        y=layer.centre(key) if y is None else y,
        fragment=7,
        alone=alone,
    )


def filled(**kwargs):
    layer = RubbleLayer(PHYSICS, WIDTH, solids=cone_cut, **kwargs)
    for key in (2, -1, 0, -2, 1):
        for i in range(8):
            add(layer, key, -17.5 - 5.5 * (i % 4), -3.2 - 3.2 * (i // 4))
    return layer


def drive(layer, windows):
    for w in range(windows):
        for key in list(layer.sections):
            x = np.arange(-16.0, -50.0, -2.8) + 0.025 * w
            layer.set_sheet(key, SheetMotion(x, 0 * x, x[0] + 1.4, np.tile((0.5, 0.0), (len(x), 1)), H))
        layer.advance(10)
    return layer


def picture(layer):
    t = layer.table()
    forces = [layer.sheet_forces(k) for k in layer.sections]
    return b"".join(
        np.ascontiguousarray(a).tobytes() for a in (t.id, t.position, t.quaternion, t.velocity, t.load, *forces)
    )
