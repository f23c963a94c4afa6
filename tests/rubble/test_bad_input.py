"""What cannot be is refused in one clear line."""

import numpy as np
import pytest

from coupling.structure import cone
from rubble.cut import plane
from rubble.layer import RubbleLayer
from rubble.physics import RubblePhysics
from rubble.piece import Slab

WALL = np.array([(0.0, -30.0), (10.0, -30.0), (10.0, 30.0), (0.0, 30.0)])


def add(layer, x, z, width=1.0):
    outline = np.array([(x, z), (x + 4.0, z), (x + 4.0, z + 2.0), (x, z + 2.0)])
    return layer.add_block(0, Slab(outline, np.array([x, x + 4.0]), np.array([width]), 900.0))


def twice(layer):
    add(layer, -10.0, -5.0)
    add(layer, -8.0, -4.5)


@pytest.mark.parametrize(
    ("do", "words"),
    [
        (lambda la: add(la, -2.0, -5.0), "overlaps the structure by"),
        (twice, "overlaps block 0 by"),
        (lambda la: add(la, -9.0, -5.0, width=0.0), "widths > 0"),
        (lambda la: RubbleLayer(RubblePhysics(), 0.0), "section pitch is 0 m"),
        (lambda la: cone(np.pi / 4, 10.0, 5.0, toe_depth=-1.0), "above the waterline"),
    ],
)
def test_one_clear_line(do, words):
    with pytest.raises(ValueError, match=words) as error:
        do(RubbleLayer(RubblePhysics(thickness=2.0), 1.0, solids=lambda y: plane([WALL])))
    assert "\n" not in str(error.value)
    assert len(str(error.value)) < 200


def test_the_block_that_was_refused_leaves_nothing_behind():
    layer = RubbleLayer(RubblePhysics(thickness=2.0), 1.0, solids=lambda y: plane([WALL]))
    with pytest.raises(ValueError, match="overlaps"):
        twice(layer)
    assert len(layer.blocks) == 1
    layer.advance(10)
