"""A fragment beside the axis of a cone: no corner of the plate that it becomes stands in the cone."""

import numpy as np
import pytest

from coupling.interface import Fragment
from coupling.rubble_port import RubblePort
from coupling.rubble_port.port import OUTLINE_TOLERANCE
from coupling.structure import cone
from rubble.domain import Domain
from rubble.physics import RubblePhysics
from rubble.round import depth_at
from rubble.sections import SectionTable

D, H = 2.0, 3.0
RADIUS = 15.0  #: at the waterline [m]


def fragment(front, first, columns=3, rows=4):
    """Flat ice at rest with its front node at x = ``front`` [m], its columns from y = ``first`` on."""
    row, column = (a.ravel() for a in np.meshgrid(np.arange(rows), np.arange(columns), indexing="ij"))
    none, length = np.zeros(len(row)), np.where(row == 0, D / 2, D)
    return Fragment(
        row=row,
        column=column,
        mass=846.0 * H * D * length,
        length=length,
        width=np.full(len(row), D),
        lead=np.where(row == 0, 0.0, D / 2),
        position=np.column_stack((front - row * D, first + column * D, np.full(len(row), -1.0))),
        velocity=np.zeros((len(row), 3)),
        tilt=none,
        tilt_rate=none,
        flooded=none,
        cut=none,
        cut_tan=np.ones(len(row)),
        cut_face=1.0,
    )


def plate(first):
    """Of a fragment that stands 2 m in a downward cone of 45 degrees: what the port says, and the layer."""
    physics = RubblePhysics(rho_i=846.0, rho_w=1006.0, thickness=H)
    port = RubblePort(
        cone(np.radians(45.0), RADIUS, 9.0, top=5.0, toe_depth=20.0), physics, pitch=D, origin=1.0, domain=Domain()
    )
    return port.add(fragment(2.0 - RADIUS, first)), port.layer


def deepest_corner(layer):
    """How deep the corners of the prisms stand in the body [m]; the greatest."""
    plates, pieces = layer.store.plates, layer.store.tables.pieces
    found = [-1.0]
    for i, k in enumerate(pieces.plate):
        for p, q in pieces.corners[pieces.offset[i] : pieces.offset[i + 1]]:
            for side in (-0.5, 0.5):
                own = np.array([p, pieces.y[i] + side * pieces.width[i], q])
                x, y, z = plates.position[k] + plates.rotation[k] @ own
                found.append(depth_at(layer.runner.body, np.hypot(x, y), z)[0])
    return max(found)


@pytest.mark.parametrize("first", [1.0, 5.0, -7.0])
def test_no_corner_of_a_new_plate_stands_in_the_cone(first):
    moved, layer = plate(first)
    assert moved.trimmed > 0.0
    assert moved.momentum_error < 1e-12
    assert moved.angular_momentum_error < 1e-12
    assert deepest_corner(layer) < OUTLINE_TOLERANCE * H  # that of the chords of the cut


def test_a_plate_that_is_cut_in_the_planes_alone_stands_in_it(monkeypatch):
    """Wrong twin: to the side of the axis the side of each piece that is nearer to it stands deep in the cone."""
    monkeypatch.setattr(SectionTable, "widest", lambda table, y: table.solids(y))
    assert deepest_corner(plate(5.0)[1]) > 0.1 * H
