"""A structure that moves in whole runs: the limits of a rigid one and of ice at rest, balances, files, recordings."""

from dataclasses import replace

import numpy as np
import pytest

import coupling.rubble_port.hand_over
from cosim.build import build
from cosim.build_motion import build_motion
from cosim.errors import InputError
from cosim.scenario.errors import ScenarioError
from cosim.scenario.loading import load_scenario

CASE = "van_vliet_2018_floe_55m_centre"
MESH = ("sheet.nodes=[14, 14]", "contact.strength='800 kPa'")
SHEET = (*MESH, "rubble.enabled=false", "fracture.longest_step='50 ms'")
FAST = "drift.velocity='0.4 m/s'"
SURGE = ("structure.motion.kind='spring'", "structure.motion.surge.mass='1000 t'")
SOFT = (*SURGE, "structure.motion.surge.stiffness='4 MN/m'", "structure.motion.surge.damping='40 kN*s/m'")
CARRIAGE = (
    "structure.motion.kind='prescribed'",
    "structure.motion.velocity=['-0.4 m/s', '0 m/s', '0 m/s']",
    "drift.velocity='0 m/s'",
)


def run(windows, *overrides, case=CASE):
    s = build(load_scenario(case, list(overrides)))
    frames = [s.macro_step() for _ in range(windows)]
    return s, frames, np.array([f.load for f in frames])


def off(a, b):
    return np.abs(a - b).max() / np.abs(b).max()


@pytest.fixture(scope="module")
def rigid():
    return run(30, *SHEET, FAST)


def test_a_very_stiff_structure_bears_what_a_rigid_one_bears(rigid):
    stiff = run(30, *SHEET, FAST, *SURGE, "structure.motion.surge.stiffness='1e18 N/m'")
    assert off(stiff[2], rigid[2]) < 1e-6
    soft = run(30, *SHEET, FAST, *SOFT)  # twin
    assert off(soft[2], rigid[2]) > 1e-2


def test_a_cone_that_moves_through_ice_at_rest(rigid):
    """Water goes with the ice in both, so that it drags on nothing."""
    drifts = run(30, *SHEET, FAST, "water.current=['0.4 m/s', '0 m/s']")
    moves = run(30, *SHEET, *CARRIAGE, "water.current=['0 m/s', '0 m/s']")
    assert off(moves[2], drifts[2]) < 1e-9
    books = moves[1][-1].ledger
    assert books["structure_work"] == pytest.approx(books["structure_drive_work"], rel=1e-9)
    assert books["structure_work"] > 1e4
    assert moves[0].ledger.energy.relative < 1e-9
    assert moves[1][-1].motion[0] == pytest.approx([-0.4 * 1.5, 0, 0, 0, 0, 0])


def with_ice_at_rest_and_in_motion(windows):
    """Loads of `first_cone` in ice that drifts, and moved through ice at rest; pieces that have broken off."""
    drift = ("drift.velocity='0.5 m/s'", "water.current=['0.5 m/s', '0 m/s']")
    carriage = (*CARRIAGE, "structure.motion.velocity=['-0.5 m/s', '0 m/s', '0 m/s']")
    drifts = run(windows, *drift, case="first_cone")
    moves = run(windows, *carriage, "water.current=['0 m/s', '0 m/s']", case="first_cone")
    return drifts[2], moves[2], (drifts[0].fragments, moves[0].fragments)


def test_a_cone_that_moves_through_ice_at_rest_past_hand_overs():
    """Rounding of places, which are other numbers, and its growth in contacts."""
    drifts, moves, pieces = with_ice_at_rest_and_in_motion(50)
    assert pieces == (3, 3)
    assert off(moves, drifts) < 1e-9


def test_hand_overs_about_the_centre_of_what_is_left_are_told_apart(monkeypatch):
    """Twin: a plate without the ice that was crushed off it, with the nodes' angular momentum about its own centre."""
    room = coupling.rubble_port.hand_over
    known, motion = room.births, room._motion

    def other(whole, still, left):
        shift = np.cross(left.centre - whole.position, left.linear)
        return motion(whole, still, replace(left, spin=left.spin + shift))

    monkeypatch.setattr(room, "births", lambda *a: (replace(b, whole=b.polygon) for b in known(*a)))
    monkeypatch.setattr(room, "_motion", other)
    drifts, moves, _ = with_ice_at_rest_and_in_motion(20)
    assert off(moves, drifts) > 1e-5


@pytest.mark.parametrize(("repeats", "closes"), [(0, 2e-2), (2, 1e-6)])
def test_energy_over_the_interface(repeats, closes):
    s, frames, _ = run(30, *SHEET, FAST, *SOFT, f"structure.motion.repeats={repeats}")
    books = frames[-1].ledger
    assert abs(books["structure_interface_lost"]) < closes * books["structure_interface_exchanged"]
    assert abs(books["structure_energy_residual"]) < 1e-9 * books["structure_interface_exchanged"]
    assert s.ledger.energy.relative < 1e-9
    spent = sum(books[f"structure_{name}"] for name in ("kinetic", "elastic", "damping_loss", "interface_lost"))
    assert -books["structure_work"] == pytest.approx(spent, rel=1e-9)


def test_moments_are_those_about_the_waterline_point():
    """A structure that pitches alone is turned by the moment of the ice's forces at their places."""
    s, frames, loads = run(
        20, *SHEET, FAST, "structure.motion.kind='spring'", "structure.motion.pitch.inertia='1e8 kg*m^2'"
    )
    arms = [np.cross(f.contact.position, -f.contact.force).sum(axis=0)[1] for f in frames]
    turned = sum(arms) * 0.05 / 1e8
    assert frames[-1].motion[1, 4] == pytest.approx(turned, rel=1e-2)
    assert np.abs(loads).max() > 1e5
    assert s.ledger.energy.relative < 1e-6


SLOW_CASES = [
    ("first_cone", ("fracture.longest_step='20 ms'",)),
    ("basin_2010_floe_165m", ("sheet.nodes=[26, 26]", "rubble.initial_volume='800 m^3'")),
]


@pytest.mark.slow
@pytest.mark.parametrize(("case", "more"), SLOW_CASES)
def test_a_very_stiff_structure_with_rubble(case, more):
    """Every scheme of contact: sheet, blocks, lockstep."""
    rests = run(40, *more, "scenario.duration='4 s'", case=case)
    stiff = run(40, *more, "scenario.duration='4 s'", *SURGE, "structure.motion.surge.stiffness='1e18 N/m'", case=case)
    assert off(stiff[2], rests[2]) < 1e-6


@pytest.mark.slow
@pytest.mark.parametrize("scheme", ["serial-explicit", "parallel-explicit", "serial-implicit"])
def test_balances_with_rubble_in_every_scheme(scheme):
    more = ("scenario.duration='4 s'", f"coupling.scheme='{scheme}'", "coupling.unconverged='count'")
    small = ("structure.motion.kind='spring'", "structure.motion.surge.mass='100 t'")
    small += ("structure.motion.surge.stiffness='400 kN/m'", "structure.motion.pitch.inertia='1e7 kg*m^2'")
    small += ("structure.motion.pitch.stiffness='50 MN*m'", "structure.motion.repeats=3")
    s, frames, _ = run(60, *more, *small, case="first_cone")
    books = frames[-1].ledger
    assert abs(books["structure_interface_lost"]) < 1e-6 * books["structure_interface_exchanged"]
    assert s.ledger.energy.relative < 1e-4
    assert s.ledger.mass_error < 1e-12
    assert s.fragments > 0


@pytest.mark.parametrize(
    ("overrides", "says"),
    [
        (["structure.motion.kind='spring'"], "spring needs one of: a table"),
        (["structure.motion.kind='modal'"], "modal needs file"),
        ([*SURGE, "structure.motion.velocity=['1 m/s','0 m/s','0 m/s']"], "a spring structure has none"),
        (["structure.motion.surge.mass='1 t'"], "a rigid structure has none"),
        ([*CARRIAGE, "structure.motion.repeats=1"], "a prescribed structure does not answer"),
        (["drift.velocity='0 m/s'"], "must be greater than zero where no structure.motion"),
        (["structure.motion.kind='spring'", "structure.motion.pitch.inertia='1 t'"], "structure.motion.pitch.inertia"),
    ],
)
def test_keys_that_fit_no_motion(overrides, says):
    with pytest.raises(ScenarioError, match=says):
        load_scenario(CASE, overrides)


MODES = "frequency_Hz,damping_ratio,mass_kg,surge,pitch\n0.3,0.01,8e5,1.0,0.01\n1.4,0.01,3e5,0.6,-0.05\n"
MATRICES = 'freedoms = ["surge", "pitch"]\nmass = [[4e6, 3e7], [3e7, 2e9]]\nstiffness = [[3e5, 0.0], [0.0, 4e8]]\n'
SERIES = "time_s,surge_m,pitch_rad\n0,0,0\n10,-4,0.1\n100,-4,0.1\n"


def motion_of(tmp_path, kind, name, text):
    (tmp_path / "scenario.toml").write_text((load_scenario(CASE).text), encoding="utf-8")
    (tmp_path / name).write_text(text, encoding="utf-8")
    overrides = [f"structure.motion.kind='{kind}'", f"structure.motion.file='{name}'"]
    return build_motion(load_scenario(str(tmp_path), overrides))


def test_files_of_motions(tmp_path):
    load = np.array([1e5, 0, 0, 0, 1e6, 0])
    for kind, name, text in (
        ("modal", "t.csv", MODES),
        ("spring", "m.toml", MATRICES),
        ("prescribed", "s.csv", SERIES),
    ):
        motion = motion_of(tmp_path, kind, name, text)
        motion.advance(0.0, 1.0, load)
        moved = motion.displacement
        assert moved[0] != 0.0
        assert moved[4] != 0.0
        assert not moved[[1, 2, 3, 5]].any()
    assert moved == pytest.approx([-0.4, 0, 0, 0, 0.01, 0])


@pytest.mark.parametrize(
    ("kind", "name", "text", "says"),
    [
        ("modal", "t.csv", MODES.replace("mass_kg", "mass"), "has no column mass_kg"),
        ("modal", "t.csv", MODES.replace("0.3,", "-0.3,"), "must not be negative"),
        ("modal", "t.csv", MODES.replace("1.0,0.01\n", "0,0\n"), "mode 1 does not move the waterline"),
        ("spring", "m.toml", MATRICES.replace('"pitch"', '"trim"'), "name some of surge, sway"),
        ("spring", "m.toml", MATRICES.replace("3e7], [3e7", "3e7], [0.0"), "mass is not symmetric"),
        ("spring", "m.toml", "mass = 1", "give freedoms, mass"),
        ("spring", "m.toml", MATRICES.replace("[4e6, 3e7]", "[4e6]"), "not 2 rows of 2 numbers"),
        ("prescribed", "s.csv", SERIES.replace("100,", "11,"), "ends at 11 s, the run at 60 s"),
        ("prescribed", "s.csv", SERIES.replace("\n0,0,0", "\n0,1,0"), "begins with zeros"),
        ("prescribed", "s.csv", "time_s,x\n0,0\n100,1\n", "has no column of a motion"),
    ],
)
def test_files_that_describe_none(tmp_path, kind, name, text, says):
    with pytest.raises(InputError, match=says):
        motion_of(tmp_path, kind, name, text)
