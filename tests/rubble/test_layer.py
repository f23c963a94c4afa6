"""Sections together: reproducible, mass kept, blocks clear sideways and downstream, phases."""

from concurrent.futures import ThreadPoolExecutor
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

import numpy as np
import pytest

from rubble.domain import Domain
from rubble.geometry import area_moments, place
from rubble.layer import RubbleLayer
from rubble.piece import Slab
from rubble.sheet import SheetMotion

SCENE = spec_from_file_location("cone_scene", Path(__file__).with_name("cone_scene.py"))
scene = module_from_spec(SCENE)
SCENE.loader.exec_module(scene)
WIDTH, H, PHYSICS, cone_cut, rectangle = scene.WIDTH, scene.H, scene.PHYSICS, scene.cone_cut, scene.rectangle
add, filled, drive, picture = scene.add, scene.filled, scene.drive, scene.picture


def test_two_runs_give_the_same_bits():
    runs = [drive(filled(), 60) for _ in range(2)]
    assert runs[0].load_on_structure.any()
    assert picture(runs[0]) == picture(runs[1])


def test_layers_side_by_side_do_not_disturb_each_other():
    with ThreadPoolExecutor(2) as pool:
        both = list(pool.map(lambda _: picture(drive(filled(), 20)), range(2)))
    assert both[0] == both[1] == picture(drive(filled(), 20))


def balance(layer, *, leak=0.0):
    return layer.mass + layer.gone.mass - leak


def test_mass_stays_through_side_steps_and_clearing():
    layer = filled(domain=Domain(x_max=-14.0))
    total = layer.mass
    count = len(layer.table().id)
    keys = dict(zip(layer.table().id.tolist(), layer.table().section.tolist(), strict=True))
    for block in layer.blocks:
        block.velocity[1] = 0.4 * (1 if block.id % 2 else -1)
    drive(layer, 120)
    table = layer.table()
    assert layer.cleared
    assert len(table.id) + len(layer.cleared) == count
    assert any(keys[i] != s for i, s in zip(table.id.tolist(), table.section.tolist(), strict=True))
    assert balance(layer) == pytest.approx(total, rel=1e-14)
    assert balance(layer, leak=2 * layer.gone.mass) != pytest.approx(total, rel=1e-3)
    assert len(set(table.id.tolist()) | set(layer.cleared)) == count


def test_a_block_crosses_into_the_next_section_with_its_motion():
    layer = RubbleLayer(PHYSICS, WIDTH)
    add(layer, 0, -26.0, 0.4, y=1.39, velocity=(0.3, 0.0))
    layer.block(0).velocity[1] = 0.5
    layer.advance(10)
    table = layer.table()
    assert table.section[0] == 1
    assert table.position[0, 1] > 1.4
    assert table.velocity[0] == pytest.approx([0.3, 0.5, 0.0], abs=0.05)
    layer.advance(10)
    assert layer.table().id[0] == 0


def test_blocks_are_pushed_outwards_on_both_sides_of_the_cone():
    layer = RubbleLayer(PHYSICS, WIDTH, solids=cone_cut)
    for key in (-2, 2):
        add(layer, key, -21.0, -0.2, velocity=(1.0, 0.0))
    left = right = 0.0
    for _ in range(60):
        layer.advance(10)
        right, left = right + layer.table().load[0, 1], left + layer.table().load[1, 1]
    v = layer.table().velocity[:, 1]
    assert v[0] < 0 < v[1]
    assert v[0] == pytest.approx(-v[1], rel=1e-9)
    assert left < 0 < right  # the structure is pushed towards the middle plane


def test_a_block_is_trimmed_and_refused_inside_the_structure():
    layer = RubbleLayer(PHYSICS, WIDTH, solids=cone_cut)
    polygon = rectangle(-20.0, -4.0, -12.5, -1.0)  # the face is at x = -15 - z: -14 below, -11 at the bottom
    with pytest.raises(ValueError, match="trim its outline first") as error:
        layer.add_block(0, Slab(polygon, np.array([-20.0, -12.5]), np.array([WIDTH]), 846.0))
    assert "\n" not in str(error.value)
    rest = layer.trim(polygon, 0)
    assert area_moments(rest)[0] == pytest.approx(7.5 * 3.0 - 1.5**2 / 2, rel=1e-9)
    layer.add_block(0, Slab(rest, np.array([-20.0, -12.5]), np.array([WIDTH]), 846.0))
    layer.advance(20)
    assert np.abs(layer.load_on_structure).max() < 2e5  # touching, not thrown out


def test_a_block_rotates_until_it_lies_along_the_slope_and_has_left_the_sheet():
    layer = RubbleLayer(PHYSICS, WIDTH, solids=cone_cut)
    flat = rectangle(-22.0, -5.0, -16.0, -2.0)
    along = place(rectangle(-3.0, -1.5, 3.0, 1.5), -12.75, -7.75, -np.pi / 4, 0.0, 0.0)
    for polygon in (flat, along):
        ends = np.array([polygon[:, 0].min(), polygon[:, 0].max()])
        layer.add_block(0, Slab(polygon, ends, np.array([WIDTH]), 846.0))
    layer.advance(1)
    assert layer.table().sliding.tolist() == [False, True]


def test_the_table_is_in_the_order_of_numbers_and_its_outlines_fit():
    layer = filled()
    layer.advance(5)
    t = layer.table()
    assert t.id.tolist() == list(range(40))
    assert t.offset[-1] == len(t.outline)
    assert all(b.fragment == 7 for b in layer.blocks)
    for i in range(40):
        area, x, z, _ = area_moments(np.ascontiguousarray(t.outline[t.offset[i] : t.offset[i + 1]]))
        assert area * t.width[i] * 846 == pytest.approx(t.mass[i], rel=1e-9)
        assert (x, z) == pytest.approx(tuple(t.position[i, [0, 2]]), rel=1e-9)


def test_an_empty_layer_runs():
    layer = RubbleLayer(PHYSICS, WIDTH, solids=cone_cut)
    layer.advance(3)
    t = layer.table()
    assert len(t.id) == 0
    assert t.load.shape == (0, 3)
    assert layer.mass == 0.0
    assert not layer.momentum.any()
    assert layer.sheet_forces(4).shape == (0, 3)


def test_removing_the_sheet_frees_the_block_under_it():
    layer = RubbleLayer(PHYSICS, WIDTH)
    x = np.array([0.0, -3.0, -6.0, -9.0])
    layer.set_sheet(0, SheetMotion(x, 0 * x, 1.5, np.zeros((4, 2)), H))
    add(layer, 0, -7.0, -1.6, velocity=(0.0, 0.0))
    layer.advance(400)
    held = layer.table().position[0, 2]
    layer.remove_sheet(0)
    layer.advance(400)
    assert layer.table().position[0, 2] > held + 0.5


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda la: la.advance(0), "at least 1"),
        (
            lambda la: la.set_sheet(0, SheetMotion([0.0, 1.0], [0, 0], 2.0, np.zeros((2, 2)), H)),
            "must decrease",
        ),
        (lambda la: RubbleLayer(PHYSICS, 0.0), "pitch"),
    ],
)
def test_bad_calls_are_refused(call, words):
    with pytest.raises(ValueError, match=words):
        call(RubbleLayer(PHYSICS, WIDTH))


def test_a_list_of_pairs_that_must_grow_changes_no_bit():
    small, large = filled(), filled()
    drive(small, 1), drive(large, 1)
    for section in small.sections.values():
        section.pairs.reserve(section.pairs.count + 4)
    assert picture(drive(small, 40)) == picture(drive(large, 40))
    assert any(s.pairs.capacity > 40 for s in small.sections.values())
