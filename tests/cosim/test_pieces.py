"""Pieces of ice between two runs, and a floe that comes over a gap."""

import json

import numpy as np
import pytest

from cosim.build import build
from cosim.errors import InputError
from cosim.ice.pieces import read, write
from cosim.scenario.loading import load_scenario
from cosim.simulation import run_scenario
from rubble.roster import roster

#: breaks within two seconds; a coarse sheet
CASE = "first_cone"
SMALL = ("sheet.nodes=[25,19]", "sheet.length='36 m'", "sheet.width='27 m'")
CLOSING = ("fracture.cracks=closing", "fracture.layer_strength='400 kPa'")
BACK = "60 m"  #: gap over which the second floe stands clear of all pieces


@pytest.fixture(scope="module")
def first(tmp_path_factory):
    """A run, the file that it has left, and what it had then."""
    path, kept = tmp_path_factory.mktemp("pieces") / "pieces.json", {}
    scenario = load_scenario(CASE, [*SMALL, "scenario.duration='4 s'"])

    def at_end(scheduler):
        kept["mass"] = scheduler.sheet.mass + scheduler.rubble.mass
        kept["broken"] = len(scheduler.rubble.layer.blocks)
        write(scheduler, scenario, path)
        kept["roster"] = roster(scheduler.rubble.layer)
        kept["momentum"] = scheduler.rubble.layer.momentum

    run_scenario(scenario, at_end=at_end)
    return path, kept


def follows(path, *overrides):
    return load_scenario(CASE, [*SMALL, f"rubble.pieces='{path}'", f"sheet.gap='{BACK}'", *overrides])


def test_what_is_left_of_the_sheet_is_among_the_pieces(first):
    """Ice of sheet and rubble, less what the structure cuts off the rest of the sheet."""
    path, kept = first
    assert kept["broken"] > 0
    assert len(read(path).plates) > kept["broken"]
    layer = build(follows(path)).rubble.layer
    assert 0.99 * kept["mass"] < layer.mass <= (1.0 + 1e-12) * kept["mass"]


def test_cracks_that_close_hold_what_is_left_together(tmp_path):
    """Cells that have cracked join their nodes until they are through and open: a floe is no heap of single nodes."""
    scenario = load_scenario(CASE, [*SMALL, *CLOSING, "scenario.duration='1.5 s'"])
    kept = {}

    def at_end(scheduler):
        kept["begun"] = int((~scheduler.sheet.sheet.intact).sum())
        kept["rubble"] = len(scheduler.rubble.layer.blocks)
        write(scheduler, scenario, tmp_path / "p.json")

    run_scenario(scenario, at_end=at_end)
    assert kept["begun"] > 20
    assert len(read(tmp_path / "p.json").plates) <= kept["rubble"] + 3


def test_pieces_come_back_where_and_as_they_moved(first):
    path, kept = first
    layer = build(follows(path)).rubble.layer
    found = roster(layer)
    assert len(found) == len(kept["roster"]) == len(read(path).plates)
    for here, there in zip(found, kept["roster"], strict=True):
        for name in ("position", "quaternion", "velocity", "omega"):
            np.testing.assert_allclose(getattr(here, name), getattr(there, name), rtol=0.0, atol=1e-12)
        assert (here.flooded, here.aligned, here.sliding) == (there.flooded, there.aligned, there.sliding)
        for p, q in zip(here.prisms, there.prisms, strict=True):
            np.testing.assert_allclose(p.outline, q.outline, rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(layer.momentum, kept["momentum"], rtol=1e-12)


def test_a_run_with_pieces_closes_its_books(first):
    """Mass of floe and pieces, and energy, from the first window on; pieces that touch the structure load it."""
    path, _ = first
    scheduler = build(follows(path))
    before = scheduler.rubble.mass
    assert scheduler.ledger.initial_mass == pytest.approx(scheduler.sheet.initial_mass + before, rel=1e-14)
    for _ in range(20):
        frame = scheduler.macro_step()
    assert scheduler.ledger.mass_error < 1e-12
    assert abs(scheduler.ledger.energy.relative) < 1e-3
    assert not frame.load[0].any()  # the floe is 60 m away


def test_a_floe_does_not_begin_on_pieces(first):
    """The line says how much gap there must be, and with it the run begins."""
    path, _ = first
    with pytest.raises(InputError, match=r"give sheet\.gap of [0-9.]+ m or more") as error:
        build(follows(path, "sheet.gap='1 m'"))
    assert "\n" not in str(error.value)
    asked = float(str(error.value).split("sheet.gap of ")[1].split(" m")[0])
    assert build(follows(path, f"sheet.gap='{asked:.2f} m'")).rubble.layer.mass > 0.0


@pytest.mark.parametrize(("sunk", "tilt"), [(0.0, 0.0), (0.05, 0.0), (0.0, 0.02), (0.8, 0.9)])
def test_flat_and_standing_ice_in_the_floe_is_seen(first, tmp_path, sunk, tilt):
    """Ice that floats level with the floe has corners at its top and bottom only; ice under it lies in nothing."""
    data = json.loads(first[0].read_text())
    plate, (x, y, z) = data["plates"][0], (-14.0, 0.3, -0.5 * 0.5 + 0.5 * (1.0 - 900.0 / 1025.0))
    outline = [[-2.0, -0.25], [2.0, -0.25], [2.0, 0.25], [-2.0, 0.25]]
    plate["prisms"] = [{"outline": outline, "y": 0.0, "cuts": [-2.0, 2.0], "widths": [1.5]}]
    half = 0.5 * tilt
    plate |= {"position": [x, y, z - 0.5 * sunk], "quaternion": [np.cos(half), 0.0, -np.sin(half), 0.0]}
    data["plates"] = [plate]
    path = tmp_path / "flat.json"
    path.write_text(json.dumps(data))
    front = build(follows(path)).sheet.sheet.grid
    edge = front.x0 + (front.nx - 1) * front.d + 60.0  # where it would touch
    with pytest.raises(InputError, match=r"sheet\.gap") as error:
        build(follows(path, "sheet.gap='0.1 m'"))
    asked = float(str(error.value).split("sheet.gap of ")[1].split(" m")[0])
    assert asked == pytest.approx(edge - (x - 2.0 * np.cos(tilt)), abs=1.2 if tilt > 0.1 else 0.02)
    plate["position"][2] -= 2.0
    path.write_text(json.dumps(data))
    assert build(follows(path, "sheet.gap='0 m'")).rubble.layer.mass > 0.0


def test_a_gap_is_a_delay():
    """Loads of a floe that comes over a gap are those of one that touches at once, later by gap over velocity."""
    base = [*SMALL, "rubble.enabled=false"]
    scenario = load_scenario(CASE, base)
    windows = 10
    way = windows * scenario.coupling.window * scenario.drift.velocity
    loads = {}
    for name, gap in (("at once", 0.0), ("later", way)):
        scheduler = build(load_scenario(CASE, [*base, f"sheet.gap='{gap!r} m'"]))
        loads[name] = np.array([scheduler.macro_step().load.sum(axis=0) for _ in range(windows + 25)])
    assert np.abs(loads["later"][:windows]).max() < 1e-9 * np.abs(loads["at once"]).max()
    size = np.abs(loads["at once"][:25]).max()
    np.testing.assert_allclose(loads["later"][windows:], loads["at once"][:25], rtol=0.0, atol=1e-6 * size)


def changed(path, to, **values):
    data = json.loads(path.read_text())
    for key, value in values.items():
        at = data
        *way, last = (int(k) if k.isdigit() else k for k in key.split("__"))
        for k in way:
            at = at[k]
        at[last] = value
    to.write_text(json.dumps(data))
    return to


@pytest.mark.parametrize(
    ("values", "says"),
    [
        ({"thickness": 7.0}, "a thickness of 7 m"),
        ({"density": 500.0}, "a density of 500 kg/m3"),
        ({"format": "pieces"}, "format: Input should be 'brash pieces 1'"),
        ({"plates__0__quaternion": [1.0, 1.0, 0.0, 0.0]}, r"plates\.0\.quaternion has not the length 1"),
        ({"plates__0__position": [1.0, None, 0.0]}, r"plates\.0\.position\.1"),
        ({"plates__0__mass": 1.0}, r"plates\.0\.mass"),
        ({"plates__0__prisms": []}, r"plates\.0\.prisms"),
        (
            {"plates__1__prisms__0__outline": [[0, 0], [1, 0], [0.4, 0.2], [0, 1]]},
            r"plates\.1\.prisms\.0: .* not convex",
        ),
        ({"plates__1__prisms__0__cuts": [1.0, 0.0]}, r"plates\.1\.prisms\.0: 1 strips with cuts"),
    ],
)
def test_a_wrong_file_is_one_line(first, tmp_path, values, says):
    path = changed(first[0], tmp_path / "wrong.json", **values)
    with pytest.raises(InputError, match=says) as error:
        build(follows(path))
    assert "\n" not in str(error.value)
    assert str(path) in str(error.value)


@pytest.mark.parametrize(
    ("overrides", "says"),
    [
        (["rubble.initial_volume='20 m^3'"], "rubble.pieces.*give one of the two"),
        (["rubble.enabled=false"], "rubble.pieces.*remove one of the two"),
        (["rubble.pieces=''", "rubble.initial_volume='20 m^3'"], "sheet.gap.*give one of the two"),
    ],
)
def test_rubble_comes_from_one_place(first, overrides, says):
    with pytest.raises(InputError, match=says):
        follows(first[0], *overrides)


def test_no_file_and_no_json_are_one_line(tmp_path):
    with pytest.raises(InputError, match="no such file"):
        build(follows(tmp_path / "none.json"))
    (tmp_path / "text.json").write_text("pieces")
    with pytest.raises(InputError, match="Invalid JSON"):
        build(follows(tmp_path / "text.json"))


def test_the_command_writes_pieces_and_another_begins_with_them(cosim, tmp_path):
    """Nothing but such a file is written over; a run without rubble has none to write."""
    path, mine = tmp_path / "pieces.json", tmp_path / "mine.json"
    mine.write_text("{}")
    sets = [part for text in (*SMALL, "scenario.duration='0.2 s'") for part in ("--set", text)]
    code, _, err = cosim("run", CASE, "-q", "--pieces", path, *sets)
    assert code == 0, err
    again = ["run", CASE, "-q", *sets, "--set", f"rubble.pieces='{path}'", "--set", f"sheet.gap='{BACK}'"]
    for extra, says in (
        (["--pieces", mine], "is no .pieces file"),
        (["--pieces", path], "does not overwrite its source"),
        (["--pieces", tmp_path / "p.json", "--set", "rubble.enabled=false"], "rubble.enabled"),
    ):
        code, out, err = cosim(*again, *extra)
        assert (code, out) == (2, "")
        assert says in err
        assert err.count("\n") == 1, err
    assert mine.read_text() == "{}"
    code, _, err = cosim(*again, "--pieces", tmp_path / "p.json")
    assert code == 0, err
    assert len(read(tmp_path / "p.json").plates) == len(read(path).plates) + 1
