"""Initial rubble: a stated volume of a stated porosity comes to rest round the structure; its slope is a result."""

import numpy as np
import pytest

from coupling.structure import cone
from rubble.cut import revolved
from rubble.domain import Domain
from rubble.heap import Place, heap
from rubble.initial import CALM, PACKED, Initial, settle
from rubble.layer import RubbleLayer
from rubble.outline import convex_parts
from rubble.physics import RubblePhysics
from rubble.pile import flank
from rubble.sheet import SheetMotion

H, PITCH, RHO_I, RHO_W = 3.0, 5.6, 846.0, 1006.0
SHAPE = cone(np.radians(45), 15.0, 9.0, top=5.0, toe_depth=20.0)
UNDER = -H * RHO_I / RHO_W


def pile(volume, sections, seed=2018, mu=0.1, pitch=PITCH, h=H, physics=None, **asked):
    """Rubble under the edge of a sheet that touches the cone all round, where a section has a cone before it."""
    under = -h * RHO_I / RHO_W
    physics = RubblePhysics(
        rho_i=RHO_I,
        rho_w=RHO_W,
        thickness=h,
        mu_ice_ice=mu,
        restitution=0.1,
        added_mass=0.2,
        added_inertia=0.2,
        **(physics or {}),
    )
    layer = RubbleLayer(
        physics,
        pitch,
        domain=Domain(x_max=21.0, depth=60.0, y_max=90.0),
        solids=lambda y: revolved(convex_parts(*SHAPE.section(y, -20.0, 5.0, 1e-3))),
    )
    fronts = {}
    for key in sections:
        face = float(SHAPE.face_x(layer.centre(key), under))
        x = np.arange(face - 0.5, face - 60.0, -2.8)
        layer.set_sheet(
            key,
            SheetMotion(x, np.full(len(x), under + h / 2), x[0] + 0.5, np.zeros((len(x), 2)), h),
        )
        fronts[key] = (face, under)
    return layer, settle(layer, Place(fronts, foot(SHAPE, under)), Initial(volume, seed, **asked))


def foot(shape, z):
    """The outline of a structure at a height."""
    y = np.linspace(-20.0, 20.0, 401)
    points = np.column_stack([shape.face_x(y, z), y])
    return points[np.isfinite(points[:, 0])]


def check(found, volume):
    weight = volume * (RHO_W - RHO_I) * 9.81
    assert found.volume == pytest.approx(volume, rel=1e-12)
    assert found.force == pytest.approx(weight, rel=0.03)
    assert found.calm <= CALM
    assert 0.05 < found.porosity < 0.5
    assert 0.0 < found.slope < np.radians(75)


@pytest.mark.slow
def test_a_pile_lifts_the_sheet_with_its_buoyant_weight():
    layer, found = pile(1200.0, (0, 1))
    check(found, 1200.0)
    assert layer.time == 0.0
    assert not layer.cleared
    assert found.mass == pytest.approx(layer.mass)
    assert all(b.flooded == 1.0 for b in layer.blocks)


def test_the_same_seed_gives_the_same_pile_and_another_seed_another():
    runs = [pile(300.0, (0,), seed)[0].table().position.tobytes() for seed in (7, 7, 8)]
    assert runs[0] == runs[1] != runs[2]


def test_a_pile_settles_in_still_water_and_then_feels_the_current():
    """The water that flows would push the pile while it settles; afterwards it drags on its blocks."""
    (still, _), (flows, _) = (pile(300.0, (0,), 7, physics={"current": (v, 0.0)}) for v in (0.0, 0.3))
    assert still.table().position.tobytes() == flows.table().position.tobytes()
    for layer in (still, flows):
        layer.advance(1)
    assert flows.table().velocity[:, 0].max() > still.table().velocity[:, 0].max() + 1e-6


@pytest.mark.slow
@pytest.mark.parametrize("mu", [0.1, 0.4, "rate-dependent"])
def test_the_basins_3000_m3_lift_with_4_7_mn(mu):
    _, found = pile(3000.0, range(-2, 3), mu=mu)
    check(found, 3000.0)
    assert found.force == pytest.approx(4.7e6, rel=0.03)


@pytest.mark.parametrize("porosity", [pytest.param(0.2, marks=pytest.mark.slow), 0.3])
def test_a_pile_has_the_porosity_that_is_asked_for(porosity):
    """Within 0.03, whatever the width of the sections: blocks are narrower than they are."""
    layer, found = pile(1500.0, range(-2, 3), mu="rate-dependent", porosity=porosity)
    assert found.porosity == pytest.approx(porosity, abs=0.03)
    width = {round(b.width, 9) for b in layer.blocks}
    assert width == {round(PITCH * (1.0 - porosity) / (1.0 - PACKED), 9)}


def test_a_porosity_that_blocks_do_not_pack_to_is_refused():
    with pytest.raises(ValueError, match="blocks pack no closer"):
        pile(300.0, (0,), porosity=0.05)


def test_rubble_that_rises_beside_the_sheet_has_no_profile():
    """A little rubble with nothing over it: neither porosity nor slope, and no error."""
    physics = RubblePhysics(rho_i=RHO_I, rho_w=RHO_W, thickness=H)
    layer = RubbleLayer(physics, PITCH)
    place = Place({0: (-15.0, UNDER - 5.0)}, np.array([[-15.0, 0.0]]))
    found = settle(layer, place, Initial(20.0, 1))
    assert np.isnan(found.porosity)
    assert np.isnan(found.slope)
    assert found.depth == 0.0


def test_no_volume_is_refused():
    with pytest.raises(ValueError, match="more than 0"):
        pile(0.0, (0,))


def lengths_of(layer):
    """Of the blocks, in thicknesses."""
    return np.array([b.mass / (RHO_I * H * b.width) / H for b in layer.blocks])


@pytest.mark.slow
def test_the_mesh_leaves_porosity_and_sizes_alone():
    """Eight sections, and four twice as wide: as many blocks in each section's share, as long as ever."""
    fine, narrow = pile(1500.0, range(-4, 4), mu="rate-dependent", pitch=0.5 * PITCH)
    coarse, wide = pile(1500.0, range(-2, 2), mu="rate-dependent")
    assert narrow.porosity == pytest.approx(wide.porosity, abs=0.04)
    assert len(fine.blocks) * fine.pitch == pytest.approx(len(coarse.blocks) * coarse.pitch, rel=0.03)
    for layer in (fine, coarse):
        found, count = lengths_of(layer), len(layer.blocks)
        spread = 1.0 / np.sqrt(12.0)  # even between 0.5 and 1.5
        assert found.mean() == pytest.approx(1.0, abs=3.0 * spread / np.sqrt(count))
        assert found.std() == pytest.approx(spread, rel=0.2)


def test_blocks_have_the_lengths_that_are_asked_for():
    layer, found = pile(900.0, (0, 1), lengths=(2.0, 2.5))
    assert lengths_of(layer) == pytest.approx(2.25, abs=0.4)
    assert lengths_of(layer).mean() == pytest.approx(2.25, rel=0.1)
    assert found.volume == pytest.approx(900.0, rel=1e-12)


@pytest.mark.parametrize("angle", [20.0, 35.0])
def test_the_angle_of_a_flank_is_that_of_the_wedge(angle):
    """Also where blocks stick out of it: one corner a thickness deep moves it by less than half a degree."""
    x, slope = np.arange(0.05, 40.0, 0.1), np.tan(np.radians(angle))
    wedge = np.maximum(12.0 - slope * x, 0.0)
    assert np.degrees(flank([x], [wedge], 0.1)) == pytest.approx(angle, abs=0.05)
    rough = [np.where(wedge > 0.0, wedge + shift, 0.0) for shift in (-0.5, 0.0, 0.5)]
    assert np.degrees(flank([x] * 3, rough, 0.1)) == pytest.approx(angle, abs=0.3)
    corner = wedge + np.where(np.abs(x - 3.0) < 0.5, H, 0.0)
    assert np.degrees(flank([x] * 5, [corner, wedge, wedge, wedge, wedge], 0.1)) == pytest.approx(angle, abs=0.5)
    assert np.isnan(flank([], [], 0.1))


def test_a_heap_round_a_cone_falls_away_from_it_on_all_sides():
    """Its volume is that of a ring with the section of a wedge (Pappus); a heap before a plane is a wedge."""
    y, tangent = {k: float(k) for k in range(-40, 41)}, np.tan(np.radians(30.0))
    angle = np.linspace(0.5 * np.pi, 1.5 * np.pi, 2001)
    ring = np.column_stack([12.0 * np.cos(angle), 12.0 * np.sin(angle)])
    front = {k: (-np.sqrt(max(144.0 - v * v, 0.0)), -2.5) for k, v in y.items()}
    half_ring = np.pi * (12.0 * 10.0**2 / 2.0 + 10.0**3 / 6.0) * tangent  # integral of (10 - s)(12 + s) over s
    flanks = heap(Place(front, ring), y, half_ring, np.radians(30.0), 1.0)
    assert sum(f.area for f in flanks.values()) == pytest.approx(half_ring, rel=1e-9)
    assert max(f.thickness.max() for f in flanks.values()) == pytest.approx(10.0 * tangent, rel=0.01)
    assert max(flanks) == 21
    reach = {k: -float(f.x[f.thickness > 0.0].min()) for k, f in flanks.items()}
    assert [reach[k] for k in (0, 10, -10)] == pytest.approx([22.0, np.sqrt(384.0), np.sqrt(384.0)], abs=0.1)
    wall = Place({k: (-12.0, -2.5) for k in y}, np.column_stack([np.full(801, -12.0), np.linspace(-40.0, 40.0, 801)]))
    wedge = heap(wall, y, 81.0 * 50.0 * tangent, np.radians(30.0), 1.0)
    assert {round(f.area / (50.0 * tangent), 6) for f in wedge.values()} == {1.0}


@pytest.mark.parametrize(("slope", "mu"), [(20.0, 0.1), (40.0, 0.7)])
def test_settled_rubble_is_as_far_from_the_structure_as_the_heap(slope, mu):
    """On the mean of its ice, within a quarter of a thickness, where friction can hold it; a flatter one is farther."""
    sections, asked = range(-4, 5), Initial(1500.0, 3, slope=np.radians(slope))
    layer, _ = pile(1500.0, sections, seed=3, mu=mu, pitch=0.5 * PITCH, slope=np.radians(slope))
    place = Place({k: (float(SHAPE.face_x(layer.centre(k), UNDER)), UNDER) for k in sections}, foot(SHAPE, UNDER))
    ice = [place.distance(b.position[:1], float(b.position[1]))[0] for b in layer.blocks]
    at = np.average(ice, weights=[b.mass for b in layer.blocks])
    assert at == pytest.approx(middle(asked, layer, place), abs=0.25 * H)
    other = Initial(1500.0, 3, slope=np.radians(60.0 - slope))
    assert at != pytest.approx(middle(other, layer, place), abs=0.5 * H)


def middle(asked, layer, place):
    """Mean distance of a heap from the structure [m]."""
    flanks = asked.flanks(layer, place)
    at = np.concatenate([place.distance(f.x, layer.centre(k)) for k, f in flanks.items()])
    return np.average(at, weights=np.concatenate([f.thickness for f in flanks.values()]))


def test_a_pile_in_shallow_water_spreads():
    """Three quarters as deep as it would be: nothing below the bed, a flatter pile, the sheet lifted as ever."""
    _, deep = pile(450.0, (0,))
    depth = -UNDER + 0.75 * deep.depth
    layer, found = pile(450.0, (0,), physics={"depth": depth})
    assert min(b.outline[:, 1].min() for b in layer.blocks) > -depth - 0.02 * H
    assert found.depth <= 0.75 * deep.depth + 0.05 * H
    assert found.force == pytest.approx(450.0 * (RHO_W - RHO_I) * 9.81 + layer.budget["sea_bed"][1], rel=0.03)
    assert found.volume == pytest.approx(450.0, rel=1e-12)


UP = cone(np.radians(45), 15.0, 4.0, top=11.0, toe_depth=8.0, breaking="upward")
FREEBOARD = H * (1.0 - RHO_I / RHO_W)


def on_top(volume, sections, seed=2018, mu=0.3):
    """Rubble on the sheet before a cone that lifts it."""
    layer = RubbleLayer(
        RubblePhysics(rho_i=RHO_I, rho_w=RHO_W, thickness=H, mu_ice_ice=mu, restitution=0.1),
        PITCH,
        domain=Domain(x_max=25.0, depth=60.0, y_max=90.0),
        solids=lambda y: revolved(convex_parts(*UP.section(y, -8.0, 11.0, 1e-3))),
    )
    fronts = {}
    for key in sections:
        front = float(UP.face_x(layer.centre(key), FREEBOARD - H))
        x = np.arange(front - 1.4, front - 60.0, -2.8)
        layer.set_sheet(key, SheetMotion(x, np.full(len(x), FREEBOARD - H / 2), front, np.zeros((len(x), 2)), H))
        fronts[key] = (min(float(UP.face_x(layer.centre(key), FREEBOARD)), front), FREEBOARD)
    return layer, settle(layer, Place(fronts, foot(UP, FREEBOARD), above=True), Initial(volume, seed))


def test_before_an_upward_cone_rubble_lies_on_the_sheet_with_its_dry_weight():
    layer, found = on_top(600.0, (0, 1))
    weight = 600.0 * RHO_I * 9.81
    assert found.calm <= CALM
    assert found.force == pytest.approx(weight, rel=0.03)  # but for what lies in the water between front and slope
    assert found.force != pytest.approx(600.0 * (RHO_W - RHO_I) * 9.81, rel=0.5)
    on_sheet = sum(float(layer.sheet_forces(k)[:, 2].sum()) for k in layer.sections)
    assert on_sheet < -0.5 * weight
    assert 0.2 < found.porosity < 0.4
    assert np.radians(10) < found.slope < np.radians(45)
    dry = [b for b in layer.blocks if b.outline[:, 1].min() > 0.0]
    assert len(dry) > 0.8 * len(layer.blocks)
