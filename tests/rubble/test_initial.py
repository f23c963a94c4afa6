"""Initial rubble: a stated volume of a stated porosity comes to rest under the ice; its slope is a result."""

import numpy as np
import pytest

from coupling.structure import cone
from rubble.cut import revolved
from rubble.domain import Domain
from rubble.initial import CALM, PACKED, settle
from rubble.layer import RubbleLayer
from rubble.outline import convex_parts
from rubble.physics import RubblePhysics
from rubble.sheet import SheetMotion

H, PITCH, RHO_I, RHO_W = 3.0, 5.6, 846.0, 1006.0
SHAPE = cone(np.radians(45), 15.0, 9.0, top=5.0, toe_depth=20.0)
UNDER = -H * RHO_I / RHO_W


def pile(volume, sections, seed=2018, mu=0.1, threads=1, porosity=0.3):
    physics = RubblePhysics(
        rho_i=RHO_I, rho_w=RHO_W, thickness=H, mu_ice_ice=mu, restitution=0.1, added_mass=0.2, added_inertia=0.2
    )
    layer = RubbleLayer(
        physics,
        PITCH,
        domain=Domain(x_max=21.0, depth=60.0, y_max=90.0),
        threads=threads,
        solids=lambda y: revolved(convex_parts(*SHAPE.section(y, -20.0, 5.0, 1e-3))),
    )
    fronts = {}
    for key in sections:
        face = float(SHAPE.face_x(layer.centre(key), UNDER))
        x = np.arange(face - 0.5, face - 60.0, -2.8)
        layer.set_sheet(
            key,
            SheetMotion(x, np.full(len(x), UNDER + H / 2), x[0] + 0.5, np.zeros((len(x), 2)), H),
        )
        fronts[key] = (face, UNDER)
    return layer, settle(layer, fronts, volume, seed, porosity=porosity)


def check(found, volume):
    weight = volume * (RHO_W - RHO_I) * 9.81
    assert found.volume == pytest.approx(volume, rel=1e-12)
    assert found.force == pytest.approx(weight, rel=0.03)
    assert found.calm <= CALM
    assert 0.05 < found.porosity < 0.5
    assert 0.0 < found.slope < np.radians(75)


def test_a_pile_lifts_the_sheet_with_its_buoyant_weight():
    layer, found = pile(1200.0, (0, 1))
    check(found, 1200.0)
    assert layer.time == 0.0
    assert not layer.cleared
    assert found.mass == pytest.approx(layer.mass)
    assert all(b.flooded == 1.0 for b in layer.blocks)


def test_the_same_seed_gives_the_same_pile_and_another_seed_another():
    runs = [
        pile(300.0, (0,), seed, threads=threads)[0].table().position.tobytes()
        for seed, threads in ((7, 1), (7, 2), (8, 1))
    ]
    assert runs[0] == runs[1] != runs[2]


@pytest.mark.slow
@pytest.mark.parametrize("mu", [0.1, 0.4, "rate-dependent"])
def test_the_basins_3000_m3_lift_with_4_7_mn(mu):
    _, found = pile(3000.0, range(-2, 3), mu=mu)
    check(found, 3000.0)
    assert found.force == pytest.approx(4.7e6, rel=0.03)


@pytest.mark.parametrize("porosity", [0.2, 0.3])
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
    found = settle(layer, {0: (-15.0, UNDER - 5.0)}, 20.0, 1)
    assert np.isnan(found.porosity)
    assert np.isnan(found.slope)
    assert found.depth == 0.0


def test_no_volume_is_refused():
    with pytest.raises(ValueError, match="more than 0"):
        pile(0.0, (0,))
