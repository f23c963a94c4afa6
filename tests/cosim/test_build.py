"""From scenario to participants: every value arrives where it acts."""

import dataclasses

import numpy as np
import pytest

from cosim.build import build, build_ice, build_sheet, build_steering, build_structure
from cosim.build_rubble import build_rubble
from cosim.scenario.loading import load_scenario
from coupling.steering import ByPower

CASE = "van_vliet_2018_floe_55m_centre"
NX, NY = 8, 8


def scenario(*overrides):
    return load_scenario(CASE, [f"sheet.nodes=[{NX}, {NY}]", *overrides])


def sheet_of(*overrides):
    s = scenario(*overrides)
    return build_sheet(s, build_ice(s), build_structure(s))


def held(back, sides):
    """Which of u_x and u_y the engine holds, (NX, NY, 2)."""
    engine = sheet_of(f"sheet.back={back}", f"sheet.sides={sides}").engine
    both = [engine._held.reshape(NX, NY, 2)[..., k] for k in (0, 1)]
    np.testing.assert_array_equal(engine.held_x.reshape(NX, NY, 2)[..., 0], both[0])
    return both


@pytest.mark.parametrize(("back", "x", "y"), [("held", True, True), ("roller", True, False), ("free", False, False)])
def test_a_roller_at_the_back_holds_the_ice_along_the_drift_only(back, x, y):
    along, across = held(back, "free")
    assert along[0].all() == along[0].any() == x
    assert across[0].all() == across[0].any() == y
    assert not along[1:].any()
    assert not across[1:].any()


@pytest.mark.parametrize(("sides", "x", "y"), [("held", True, True), ("roller", False, True), ("free", False, False)])
def test_a_roller_at_the_sides_holds_the_ice_across_the_drift_only(sides, x, y):
    along, across = held("free", sides)
    for column in (0, -1):
        assert along[:, column].all() == along[:, column].any() == x
        assert across[:, column].all() == across[:, column].any() == y
    assert not along[:, 1:-1].any()
    assert not across[:, 1:-1].any()


def test_rollers_at_back_and_sides_hold_both_at_the_corners_alone():
    along, across = held("roller", "roller")
    np.testing.assert_array_equal(np.flatnonzero(along.ravel()), np.arange(NY))
    np.testing.assert_array_equal(np.flatnonzero(across.any(axis=0)), [0, NY - 1])
    assert across[:, [0, -1]].all()


@pytest.mark.parametrize("thickness", [1.0, 3.0])
@pytest.mark.parametrize("share", [0.1, 0.3])
def test_damping_of_the_water_is_a_share_of_sqrt_k_f_rho_h(thickness, share):
    """0.1 sqrt(k_f rho_i h) per area on the deflection, none on the rotations (thesis 4.2.1)."""
    sheet = sheet_of(f"ice.thickness='{thickness} m'", f"water.damping={share}")
    per_area = share * np.sqrt(1006.0 * 9.81 * 846.0 * thickness)
    c = sheet.engine.C_q.reshape(-1, 3)
    np.testing.assert_allclose(c[:, 0], per_area * sheet.grid.area, rtol=1e-12)
    assert not c[:, 1:].any()


@pytest.mark.parametrize(("breaking", "faces"), [("downward", 1.0), ("upward", -1.0)])
def test_the_floe_begins_where_the_edge_that_touches_first_meets_the_face(breaking, faces):
    s = scenario(f"structure.breaking={breaking}", "sheet.axis_from_side='20 m'", "structure.slope='60 deg'")
    ice, structure = build_ice(s), build_structure(s)
    sheet = build_sheet(s, ice, structure)
    z = 3.0 * (1.0 - 846.0 / 1006.0) - (0.0 if faces > 0 else 3.0)
    assert sheet.grid.xy[:, 0].max() == pytest.approx(-15.0 - faces * z / np.tan(np.pi / 3), rel=1e-9)
    assert np.ptp(sheet.grid.xy[:, 0]) == pytest.approx(55.0, rel=1e-12)
    assert (sheet.grid.xy[:, 1].min(), sheet.grid.xy[:, 1].max()) == pytest.approx((-20.0, 35.0), rel=1e-12)


def test_a_long_step_has_as_many_windows_as_fit_in_it():
    assert sheet_of("fracture.longest_step='0.2 s'").ahead._longest == 4
    assert sheet_of("fracture.longest_step='0.01 s'").ahead._longest == 1


RUBBLE = {
    "friction_ice_ice": ("0.21", "mu_ice_ice", 0.21),
    "friction_structure": ("0.22", "mu_structure", 0.22),
    "friction_sea_bed": ("0.24", "mu_bed", 0.24),
    "restitution": ("0.23", "restitution", 0.23),
    "form_drag": ("0.24", "form_drag", 0.24),
    "skin_drag": ("0.025", "skin_drag", 0.025),
    "backfill": ("none", "backfill", "none"),
    "filling_time": ("2.5 s", "filling_time", 2.5),
    "iterations": ("27", "iterations", 27),
    "substep": ("2.5 ms", "substep", 0.0025),
    "contact_strength": ("2.9 MPa", "contact_strength", 2.9e6),
}


def port_of(*overrides):
    s = scenario(*overrides)
    structure = build_structure(s)
    return build_rubble(s, structure, build_sheet(s, build_ice(s), structure).grid)


def test_water_is_as_deep_as_it_is_told_and_nothing_is_lost_on_its_bed():
    deep, shallow, abyss = port_of(), port_of("water.depth='7 m'"), port_of("water.depth='300 m'")
    assert deep.physics.depth == np.inf
    assert shallow.physics.depth == 7.0
    assert shallow.layer.domain.depth == deep.layer.domain.depth
    assert abyss.layer.domain.depth == 300.0


@pytest.mark.parametrize("key", RUBBLE)
def test_every_value_of_the_rubble_arrives(key):
    text, name, value = RUBBLE[key]
    assert getattr(port_of(f"rubble.{key}={text}").physics, name) == value
    default = port_of().physics
    changed = port_of(f"rubble.{key}={text}").physics
    assert [f.name for f in dataclasses.fields(default) if getattr(default, f.name) != getattr(changed, f.name)] == [
        name
    ]


def test_water_ice_and_drift_arrive_in_the_rubble():
    p = port_of(
        "rubble.added_mass=0.26", "water.density='1020 kg/m^3'", "water.gravity='9.8 m/s^2'", "ice.density='900 kg/m^3'"
    ).physics
    assert (p.added_mass, p.added_inertia) == (0.26, 0.26)
    assert (p.rho_w, p.g, p.rho_i, p.thickness) == (1020.0, 9.8, 900.0, 3.0)


def test_rubble_crushes_at_the_ice_s_strength_unless_it_has_its_own():
    text = load_scenario(CASE).text.replace('contact_strength = "4 MPa"', "#")
    assert text != load_scenario(CASE).text
    s = scenario("ice.compressive_strength='3 MPa'")
    own = s.rubble.model_copy(update={"contact_strength": None})
    model = s.model.model_copy(update={"rubble": own})
    other = dataclasses.replace(s, model=model)
    structure = build_structure(other)
    assert build_rubble(other, structure, sheet_of().grid).physics.contact_strength == 3e6
    assert port_of("ice.compressive_strength='3 MPa'").physics.contact_strength == 4e6


@pytest.mark.parametrize("columns", [1, 3])
def test_sections_are_whole_node_columns_in_the_middle_of_their_ice(columns):
    port, d = port_of(f"rubble.columns_per_section={columns}"), 55.0 / 7
    assert port.layer.pitch == pytest.approx(columns * d, rel=1e-12)
    assert port.layer.centre(0) == pytest.approx(-27.5 + 0.5 * (columns - 1) * d, rel=1e-9)


def test_the_domain_ends_behind_the_structure_and_beside_the_floe():
    """Two thicknesses behind it, twenty below the water, and one section beside the wider half of the floe."""
    port, s = port_of("sheet.axis_from_side='20 m'"), scenario()
    domain = port.layer.domain
    assert domain.x_max == pytest.approx(build_structure(s).reach + 6.0, rel=1e-12)
    assert domain.depth == 60.0
    assert domain.y_max == pytest.approx(35.0 + 55.0 / 7, rel=1e-12)
    assert port_of("sheet.axis_from_side='35 m'").layer.domain.y_max == pytest.approx(35.0 + 55.0 / 7, rel=1e-12)


def laid(seed):
    port = build(scenario("rubble.initial_volume='150 m^3'", f"scenario.seed={seed}")).rubble
    return port.layer.table().position.tobytes()


def test_the_seed_of_the_scenario_is_that_of_the_rubble():
    """Same seed, same pile, to the last bit; another seed, another pile."""
    first = laid(3)
    assert first == laid(3)
    assert first != laid(4)


def test_rubble_that_lies_there_counts_as_ice_of_the_start():
    s = build(scenario("rubble.initial_volume='150 m^3'"))
    assert s.rubble.mass == pytest.approx(150.0 * 846.0, rel=1e-9)
    assert s.ledger.initial_mass == pytest.approx(846.0 * (3.0 * 55.0**2 + 150.0), rel=1e-9)


def test_steering_by_power_keeps_its_bounds():
    found = build_steering(
        scenario("coupling.steering=power", "coupling.shortest_window='10 ms'", "coupling.longest_window='200 ms'")
    )
    assert isinstance(found, ByPower)
    assert (found.shortest_ns, found.longest_ns) == (10_000_000, 200_000_000)
