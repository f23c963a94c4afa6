"""Where the load acts: forces of nodes and blocks at their places, moments that close with them."""

from dataclasses import replace

import numpy as np
import pytest
from threadpoolctl import threadpool_limits

import cosim.build
from cosim.moments import attack_of, grip_of, weight_of
from cosim.scenario.loading import load_scenario
from coupling.attack import PointForces, point_forces
from coupling.interface import BlockTable, ContactForces, Phase
from coupling.structure import cone

ORIGIN = np.zeros(3)


def block(corners, load=(1.0, 0.0, 1.0), y=0.0, phase=Phase.SLIDING, number=0):
    """A table of one block with these corners (k, 2)."""
    corners = np.asarray(corners, float)
    centre = np.array([[corners[:, 0].mean(), y, corners[:, 1].mean()]])
    one, none = np.ones(1), np.zeros((1, 3))
    return BlockTable(
        id=np.array([number]), section=np.array([0]), phase=np.array([phase]), mass=one, width=one, position=centre,
        quaternion=np.array([[1.0, 0.0, 0.0, 0.0]]), angle=one, velocity=none, omega=one,
        load=np.array([load], float), bearing=centre, outline=corners, offset=np.array([0, len(corners)]),
    )  # fmt: skip


def test_forces_of_sheet_and_blocks_in_one_table():
    contact = ContactForces(
        np.array([1, 2, 3]),
        np.array([[-1.0, 0, 0], [-1.0, 1, 0], [-1.0, 2, 0]]),
        np.array([[-2.0, 0, -1], [0, 0, 0], [-3.0, 0, 0]]),
        np.array([False, False, True]),
    )
    found = point_forces(contact, block([[-1, -3], [1, -3], [1, -1], [-1, -1]], load=(4.0, 0.0, 4.0), number=9))
    assert found.force[:, 0].tolist() == [2.0, 3.0, 4.0]
    assert found.phase.tolist() == [Phase.BREAKING, Phase.ROTATING, Phase.SLIDING]
    assert found.block.tolist() == [-1, -1, 9]
    assert found.moments(ORIGIN)[Phase.BREAKING].tolist() == [0.0, 1.0, 0.0]


def test_forces_normal_to_a_cone_turn_nothing_about_its_axis_and_pass_one_point():
    """Normals of a cone meet the axis: M_z = 0, and about the point where they meet all moments vanish."""
    tower = cone(np.pi / 4, 15.0, 9.0, top=5.0, toe_depth=20.0, breaking="downward")
    y, z = np.linspace(-12, 12, 25), np.full(25, -2.0)
    places = np.column_stack((tower.face_x(y, z), y, z))
    force = -np.linspace(1, 2, 25)[:, None] * tower.normal(y, z)
    forces = PointForces(places, force, np.zeros(25, np.int64), np.full(25, -1))
    size = np.abs(forces.moments(ORIGIN)).max()
    assert abs(forces.moments(ORIGIN)[0, 2]) < 1e-12 * size
    apex = np.array([0.0, 0.0, -2.0 + 13.0])  # inward along -n: up by as much as in, from the radius 13 m at z = -2 m
    assert np.abs(forces.moments(apex)).max() < 1e-12 * size


def test_parallel_forces_have_no_moment_about_the_point_of_attack():
    rng = np.random.default_rng(5)
    places, size = rng.normal(size=(30, 3)), rng.uniform(1, 2, 30)
    forces = PointForces(places, size[:, None] * [0.6, 0.0, 0.8], np.zeros(30, np.int64), np.full(30, -1))
    centre = attack_of(weight_of(forces))
    assert np.abs(forces.moments(centre)).max() < 1e-12 * size.sum()
    assert np.abs(forces.moments(centre + 0.1)).max() > 1.0
    nothing = PointForces(places[:0], places[:0], np.zeros(0, np.int64), np.zeros(0, np.int64))
    assert np.isnan(attack_of(weight_of(nothing))).all()


@pytest.fixture(scope="module")
def windows():
    """400 windows of an encounter with a cone, all phases in them, and the cone."""
    scenario = load_scenario("first_cone")
    with threadpool_limits(1):
        s = cosim.build.build(scenario)
        return cosim.build.build_structure(scenario), [s.macro_step() for _ in range(400)]


def test_moments_close_with_forces_and_places(windows):
    """Forces add up to the load of every phase; a shift of the point adds its arm times that load; both to 1e-12."""
    _, frames = windows
    point, loaded = np.array([3.0, -2.0, -20.0]), {p: 0 for p in Phase}
    for frame in frames:
        found = point_forces(frame.contact, frame.blocks)
        size = max(np.abs(found.force).sum(), 1e-300)
        for phase in Phase:
            mine = found.phase == phase
            assert np.abs(found.force[mine].sum(axis=0) - frame.load[phase]).max() <= 1e-12 * size
            by_hand = np.zeros(3)
            for r, f in zip(found.position[mine], found.force[mine], strict=True):
                by_hand += np.cross(r, f)
            assert np.abs(found.moments(ORIGIN)[phase] - by_hand).max() <= 1e-12 * 20.0 * size
            loaded[phase] += bool(frame.load[phase].any())
        shifted = found.moments(ORIGIN) - np.cross(point, frame.load)
        assert np.abs(grip_of(frame, tuple(point)).moment - shifted).max() <= 1e-12 * 40.0 * size
    assert min(loaded.values()) > 30


def test_a_force_that_is_left_out_is_found(windows):
    """The twin whose hinged nodes or blocks are forgotten does not close."""
    _, frames = windows
    frame = next(f for f in reversed(frames) if f.blocks.load.any())
    none = replace(frame.blocks, load=np.zeros_like(frame.blocks.load))
    found = point_forces(frame.contact, none)
    assert np.abs(found.force.sum(axis=0) - frame.load.sum(axis=0)).max() > 1e-3 * np.abs(frame.load).max()


def test_blocks_act_on_the_face(windows):
    """The places of their forces lie on the structure: a chord of the cone at most within it, and never before it."""
    structure, frames = windows
    gaps = []
    for frame in frames:
        found = point_forces(frame.contact, frame.blocks)
        x, y, z = found.position[found.block >= 0].T
        gaps += [((structure.face_x(y, z) - x) * -structure.normal(y, z)[:, 0])]
    gap = np.concatenate(gaps)
    assert len(gap) > 500
    assert np.isfinite(gap).all()
    assert np.percentile(gap, [50, 80]) == pytest.approx([0.0, 0.0], abs=0.02)
    assert gap.min() > -0.5  # of 3 to 4 m of radius: pieces that bear on both sides of the nose
    assert gap.max() < 0.05  # a tenth of the thickness
