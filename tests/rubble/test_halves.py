"""A large pile is solved in two halves that share nothing, and a seam: by one thread or two, to the same bits."""

import numpy as np
import pytest

from rubble.halves import FEW, divide, halves
from rubble.layer import RubbleLayer
from rubble.physics import RubblePhysics
from rubble.piece import Slab
from rubble.sheet import MEETS, SheetMotion
from rubble.solver import begin, solve
from rubble.team import ALONE, TILES

PITCH, COLUMNS, DEPTH, SECTIONS = 2.0, 9, 8, 8
BOX = np.array([(-1, -0.5), (1, -0.5), (1, 0.5), (-1, 0.5)])


def pile(threads=1, columns=COLUMNS, friction=0.3):
    """Blocks under a sheet, stacked so that they touch; every other layer of them ties two sections together."""
    physics = RubblePhysics(thickness=1.0, mu_ice_ice=friction, threads=threads, contact_strength=1e6)
    layer = RubbleLayer(physics, PITCH)
    for key in range(SECTIONS):
        for row in range(DEPTH):
            wide = row % 2 == 1
            if wide and key % 2 == row // 2 % 2:
                continue
            for column in range(columns):
                x, z = 2.0 * column + 0.02 * row, -1.0 - 0.999 * row
                y = layer.centre(key) - (0.5 * PITCH if wide else 0.0)
                slab = Slab(BOX + np.array([x, z]), x + np.array([-1.0, 1.0]), np.array([PITCH * (1 + wide)]), 900.0)
                layer.add_block(key, slab, y=y, alone=False)
    nodes = np.arange(2.0 * columns + 2.0, -5.0, -2.0)
    for key in range(SECTIONS):
        layer.set_sheet(key, SheetMotion(nodes, 0.0 * nodes, nodes[0] + 0.5, np.zeros((len(nodes), 2)), 1.0))
    layer.set_yields(range(SECTIONS), None)
    return layer


def meet(layer, steps):
    """In lockstep with a sheet whose nodes answer."""
    layer.begin()
    known = layer.runner.edges.nodes
    told = np.stack([known[name] for name in MEETS], axis=1)
    told[:, -3:] = 1e-4
    forces = [layer.meet(told.copy()) for _ in range(steps)]
    layer.end()
    return np.array(forces)


def parts_of(layer, out=None):
    """Rows of both halves and of the seam in the last sub-step."""
    found = layer.runner._halves if out is None else out
    return [found.row[a:b].copy() for a, b in zip(found.start[:-1], found.start[1:], strict=True)]


def shared(layer, parts):
    """Plates and nodes of the sheet that rows of both halves move."""
    point = layer.runner._rows[int(layer.runner._counted[1]) % 2].point
    ground = layer.store.plates.number
    moved = []
    for part in parts[:TILES]:
        own, sheet = point[part], point[part][point[part]["edge"] >= 0]
        moved.append(
            {("plate", k) for k in (*own["a"], *own["b"])} | {("node", k) for k in (*sheet["front"], *sheet["rear"])}
        )
        moved[-1].discard(("plate", ground))
    return moved[0] & moved[1]


@pytest.fixture(scope="module")
def settled():
    layer = pile()
    meet(layer, 5)
    return layer


def test_halves_share_nothing(settled):
    parts, count = parts_of(settled), settled.runner.contacts
    assert count > FEW
    assert sorted(np.concatenate(parts)) == list(range(count))
    assert all((np.diff(part) > 0).all() for part in parts)
    assert abs(len(parts[0]) - len(parts[1])) < 0.1 * count
    assert 0 < len(parts[TILES]) < 0.25 * count
    assert shared(settled, parts) == set()
    assert shared(settled, [np.concatenate([parts[0], parts[TILES]]), parts[1]]) != set()


def test_edges_that_yield_together_are_in_the_seam(settled):
    runner = settled.runner
    rows, count = runner._rows[int(runner._counted[1]) % 2], runner.contacts
    scene, out = runner._run.scene, halves(count)
    together = scene._replace(edges=scene.edges._replace(yields=np.ones((2, SECTIONS, SECTIONS))))
    divide(scene, rows, count, out)
    on_sheet = [(rows.point[part]["edge"] >= 0).sum() for part in parts_of(settled, out)]
    divide(together, rows, count, out)
    then = [(rows.point[part]["edge"] >= 0).sum() for part in parts_of(settled, out)]
    assert min(on_sheet[:TILES]) > 0
    assert then == [0, 0, sum(on_sheet)]


def test_two_threads_have_the_bits_of_one():
    seen = []
    for threads in (1, 2, 2):
        layer = pile(threads)
        forces = [meet(layer, 4).tobytes() for _ in range(3)]
        plates = layer.store.plates
        seen.append((forces, plates.position.tobytes(), plates.velocity.tobytes()))
        assert layer.runner.contacts > FEW
    assert seen[1] == seen[0]
    assert seen[2] == seen[0]


def test_a_small_pile_is_one_part():
    layer = pile(2, columns=3)
    meet(layer, 2)
    parts = parts_of(layer)
    assert 100 < layer.runner.contacts < FEW
    assert [len(part) for part in parts] == [0, 0, layer.runner.contacts]
    assert (np.diff(parts[TILES]) == 1).all()


@pytest.mark.parametrize("lost", [False, True])
def test_the_order_of_parts_leads_to_the_same_motion(lost):
    """Without friction the motion under contacts is one only; rows of the seam that are lost are missed."""
    layer = pile(friction=0.0)
    meet(layer, 1)
    runner, plates = layer.runner, layer.store.plates
    rows, count = runner._rows[int(runner._counted[1]) % 2], runner.contacts
    plates.motion["z"][:-1] += 0.01 * np.sin(np.arange(plates.number))
    start, before, motion = plates.motion.copy(), plates.velocity[:-1].copy(), []
    nodes = runner.edges.nodes.copy()
    for divided in (False, True):
        parts = halves(count)
        if divided:
            divide(runner._run.scene, rows, count, parts)
            if lost:
                parts.start[-1] = parts.start[-2]
        plates.motion[:], runner.edges.nodes[:], rows.way["impulse"][:count] = start, nodes, 0.0
        begin(rows, count, plates, runner.edges, parts)
        solve(ALONE, rows, parts, plates, runner.edges, 20000)
        motion.append(plates.velocity[:-1].copy())
    moved = np.abs(motion[0] - before).max()
    assert (np.abs(motion[1] - motion[0]).max() < 1e-6 * moved) is not lost


@pytest.mark.parametrize("threads", [0, TILES + 1])
def test_there_are_no_other_numbers_of_threads(threads):
    with pytest.raises(ValueError, match=rf"rubble\.threads is {threads}; give 1 to 2"):
        RubblePhysics(threads=threads)
