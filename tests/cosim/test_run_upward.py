"""Upward-breaking structures, the whole chain on small floes: signs, balances, and where the ice goes."""

import numpy as np
import pytest

from cosim.build import build, build_structure
from cosim.scenario.errors import ScenarioError
from cosim.scenario.loading import load_scenario
from cosim.simulation import run_scenario
from coupling.interface import Phase
from coupling.rubble_port import OUTLINE_TOLERANCE
from coupling.structure import cone, plane_slope
from rubble.geometry import overlap_area
from rubble.outline import convex_parts

PLANE, CONE = "upward_plane", "icefloe_gla_upward_cone"
STRIP = ["sheet.length='60 m'", "sheet.width='3 m'", "sheet.nodes=[61, 4]", "scenario.duration='12 s'"]
COARSE = ["sheet.length='60 m'", "sheet.nodes=[31, 31]", "scenario.duration='5 s'"]


def steps(name, overrides):
    """Frames of a run and its scheduler."""
    scenario = load_scenario(name, overrides)
    scheduler = build(scenario)
    frames = [scheduler.macro_step() for _ in range(scenario.duration_ns // scenario.window_ns)]
    return scheduler, frames


@pytest.fixture(scope="module")
def strip():
    return steps(PLANE, STRIP)


@pytest.fixture(scope="module")
def at_cone():
    return steps(CONE, COARSE)


@pytest.mark.parametrize("case", ["strip", "at_cone"])
def test_ice_that_rides_up_presses_the_structure_down(case, request):
    scheduler, frames = request.getfixturevalue(case)
    load = np.array([f.load for f in frames])
    assert scheduler.fragments >= 1
    for phase in (Phase.BREAKING, Phase.ROTATING):
        k = int(np.abs(load[:, phase, 2]).argmax())
        assert load[k, phase, 2] < 0.0 < load[k, phase, 0]
    assert load.sum(axis=1)[:, 2].mean() < 0.0


@pytest.mark.parametrize("case", ["strip", "at_cone"])
def test_mass_closes_and_no_block_stands_in_the_structure(case, request):
    scheduler, _ = request.getfixturevalue(case)
    assert scheduler.ledger.mass_error < 1e-14
    layer = scheduler.rubble.layer
    for block in layer.blocks:
        solids = layer.table_of_sections.solids(float(block.position[1])).polygons
        deep = overlap_area(block.outline, solids)
        assert deep < 4.0 * layer.physics.slop * np.sqrt(block.pieces[0].prism.area), block.outline


def test_blocks_are_lifted_out_of_the_water(at_cone):
    _, frames = at_cone
    afloat = 1.0 - 0.9162 / 0.9998  # freeboard
    assert max(f.blocks.outline[:, 1].max() for f in frames if f.blocks.count) > afloat + 0.3


def test_up_and_down_are_mirror_images_until_the_ice_breaks():
    """The lattice is linear, its foundation too if asked, and rubble is off: same Fx, same time, opposite Fz."""
    found = {}
    for word in ("upward", "downward"):
        options = [*STRIP, f"structure.breaking='{word}'", "rubble.enabled=false", "scenario.duration='1.5 s'"]
        options.append("water.tops='dry'")
        found[word] = run_scenario(load_scenario(PLANE, options)).events[0]
    up, down = found["upward"], found["downward"]
    assert up.force[0] == pytest.approx(down.force[0], rel=1e-6)
    assert up.force[0] > 5e3
    assert up.force[2] == pytest.approx(-down.force[2], rel=1e-6)
    assert up.force[2] < 0.0
    assert up.t_ns == pytest.approx(down.t_ns, rel=1e-6)


def test_a_strip_breaks_at_croasdales_load():
    """0.68 sigma_f (rho_w g h^5 / E)^(1/4) is the tip load of an elastic beam on water: within a tenth, and inertia."""
    from cosim.baselines.methods import design_loads

    scenario = load_scenario(
        PLANE,
        [
            *STRIP,
            "rubble.enabled=false",
            "scenario.duration='20 s'",
            "drift.velocity='20 mm/s'",
            "fracture.longest_step='0.2 s'",
        ],
    )
    event = run_scenario(scenario).events[0]
    H_B = design_loads(scenario.model)["croasdale"]["terms"]["H_B"]
    assert event.force[0] == pytest.approx(H_B, rel=0.1)


def test_a_sheet_that_leaves_the_water_is_an_event():
    scheduler = build(load_scenario(PLANE, STRIP))
    port = scheduler.sheet
    assert port.watch.draft == pytest.approx(0.5 * 916.2 / 999.8)
    port.sheet.state.q[:, 0] = 1.01 * port.watch.draft
    (event,) = port.watch.lifted_out(np.zeros(3))
    assert event.kind == "out_of_water"
    assert "draft of 0.458 m" in event.text
    assert port.watch.lifted_out(np.zeros(3)) == []


@pytest.mark.parametrize(
    ("override", "says"),
    [
        ("structure.toe_depth='0.9 m'", "draft"),
        ("structure.breaking='sideways'", "'downward' or 'upward'"),
        ("structure.neck_radius='3 m'", "below the waterline radius"),
    ],
)
def test_faults(override, says):
    with pytest.raises(ScenarioError, match=says) as error:
        load_scenario(CONE, [override])
    assert "\n" not in str(error.value)


def test_an_upward_cone_needs_its_rim(tmp_path):
    text = load_scenario(CONE).text
    file = tmp_path / "mine.toml"
    file.write_text("\n".join(line for line in text.splitlines() if not line.startswith("toe_depth")))
    with pytest.raises(ScenarioError, match='add its depth, for example toe_depth = "4 m"'):
        load_scenario(file)


def test_old_files_break_downwards():
    assert load_scenario("van_vliet_2018_floe_165m").structure.breaking == "downward"


@pytest.mark.parametrize("name", [PLANE, CONE])
def test_the_mesh_is_the_structure(name):
    structure = build_structure(load_scenario(name))
    points, triangles = structure.mesh(20.0)
    assert points[:, 2].max() == structure.top
    assert triangles.max() < len(points)
    x = structure.face_x(0.0, points[:, 2])
    front = points[np.abs(points[:, 1]) < 1e-6] if structure.half_width < np.inf else points
    assert np.abs(front[:, 0]).max() == pytest.approx(np.abs(x).max())
    low, high = points[points[:, 2] < -1.0, 0].min(), points[points[:, 2] == structure.top, 0].min()
    assert low < high  # the face leans back


@pytest.mark.parametrize("y", [0.0, 0.5, 1.5])
def test_sections_of_an_upward_cone_are_solid_up_to_its_shaft(y):
    shape = cone(np.radians(60), 2.5, 0.75, toe_depth=4.0, top=8.0, breaking="upward")
    parts = convex_parts(*shape.section(y, -4.0, 8.0, OUTLINE_TOLERANCE))
    top = max(float(p[:, 1].max()) for p in parts)
    neck = (2.5 - 0.75) * np.sqrt(3.0)
    assert top == pytest.approx(8.0 if y < 0.75 else (2.5 - y) * np.sqrt(3.0), abs=1e-2)
    probe = np.array([(-0.1, neck - 1.9), (0.1, neck - 1.9), (0.1, neck - 1.8), (-0.1, neck - 1.8)])
    assert overlap_area(probe, parts) == pytest.approx(0.02, rel=1e-6)
    assert plane_slope(np.radians(30), breaking="upward").faces_down is False


@pytest.mark.slow
@pytest.mark.parametrize("name", [PLANE, CONE])
def test_shipped_upward_cases_run_to_their_end(name):
    result = run_scenario(load_scenario(name))
    assert sum(e.kind == "circumferential" for e in result.events) >= 4
    assert result.ledger["mass_error"] < 1e-14
    assert result.by_phase["sliding"].value[0] > 1e5
    assert result.peaks.value[2] < 0.0 < result.peaks.value[0]
    assert result.peaks.value[0] < 2e6
