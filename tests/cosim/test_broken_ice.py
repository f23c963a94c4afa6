"""Cracks and lost ice from before a run: from tables, from the end of an earlier run, and from its recording."""

import numpy as np
import pyarrow as pa
import pytest

from cosim.build import build
from cosim.errors import InputError
from cosim.ice.broken import as_table, broken, cell_damage, directions
from cosim.scenario.loading import load_scenario
from cosim.simulation import run_scenario
from lattice.grid import Grid

GRID = Grid(25, 19, 1.5)  # 36 m x 27 m
CASE = "first_cone"
SMALL = ("sheet.nodes=[25,19]", "sheet.length='36 m'", "sheet.width='27 m'")
OPEN = (*SMALL, "fracture.cracks=open")
CLOSING = (*SMALL, "fracture.cracks=closing", "fracture.layer_strength='400 kPa'")


def cell(i, j):
    return i * (GRID.ny - 1) + j


def write(path, *rows, head="x,y,what,angle"):
    path.write_text("\n".join([head, *rows]) + "\n")
    return path


def sheet(path, *overrides):
    return build(load_scenario(CASE, [*overrides, f"sheet.broken='{path}'"])).sheet.sheet


def test_a_table_names_cells_and_nodes_by_place(tmp_path):
    path = write(
        tmp_path / "b.csv", "3.1,4.4,crack,30", "3.7,5.3,crack,", "36,27,gone,", "35.4,26.6,gone,", "0,0,crack,0"
    )
    found = broken(path, GRID)
    assert found.cracked.tolist() == [cell(0, 0), cell(2, 2), cell(2, 3)]
    assert found.angle[:2] == pytest.approx([0.0, np.deg2rad(30)])
    assert np.flatnonzero(found.gone).tolist() == [GRID.node(24, 18)]
    assert broken(write(tmp_path / "c.csv", "3,4,crack", head="x,y,what"), GRID).cracked.tolist() == [cell(2, 2)]


@pytest.mark.parametrize(
    ("rows", "says"),
    [
        (["3,4,cracked,"], "row 1 has what = 'cracked'"),
        (["3,4,crack,", "37,4,crack,"], "row 2 lies at x = 37 m"),
        (["3,,crack,"], "row 1 has no number in column y"),
        ([f"{1.5 * i},{1.5 * j},gone," for i in range(25) for j in range(19)], "nothing of the sheet is left"),
    ],
)
def test_a_wrong_table_is_one_line(tmp_path, rows, says):
    with pytest.raises(InputError, match=says) as error:
        broken(write(tmp_path / "b.csv", *rows), GRID)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("cells", "normal"),
    [
        ([(5, j) for j in range(3, 12)], 0.0),
        ([(i, 7) for i in range(3, 12)], 90.0),
        ([(i, i) for i in range(3, 12)], 135.0),
        ([(i, 15 - i) for i in range(3, 12)], 45.0),
        ([(5, 5)], 0.0),
    ],
)
def test_the_normal_of_a_crack_is_across_it(cells, normal):
    cracked = np.zeros(GRID.cells, bool)
    numbers = np.array([cell(i, j) for i, j in cells])
    cracked[numbers] = True
    found = np.rad2deg(directions(GRID, cracked, numbers)) % 180.0
    np.testing.assert_allclose(np.abs((found - normal + 90) % 180 - 90), 0.0, atol=1e-6)


def test_an_open_crack_carries_nothing_and_a_closed_one_carries_thrust_but_no_tension(tmp_path):
    """A crack across the whole floe, pulled and pressed along x at its front: the springs behind it feel it or not."""
    rows = [f"{1.5 * 12.5},{1.5 * (j + 0.5)},crack,0" for j in range(18)]
    path = write(tmp_path / "b.csv", *rows, "0,0,crack,0")
    floe = sheet(path, *CLOSING, "sheet.sides=free")
    layered = floe.engine.layered
    assert layered.count == 19
    assert layered.depth == pytest.approx(1.0)
    assert (layered.angle == 0.0).all()
    assert not floe.intact[layered.cell].any()
    assert floe.joins.all()
    k = int(np.flatnonzero(layered.cell == cell(12, 9))[0])
    for stretch in (1e-5, -1e-5):
        u, q = np.zeros((GRID.nodes, 2)), np.zeros((GRID.nodes, 3))
        u[:, 0] = stretch * (GRID.xy[:, 0] - GRID.xy[0, 0])
        e = floe.engine
        floe._set_cells()
        e.put(e.motion.y, np.hstack((u, q)))
        e.put(e.motion.v, np.zeros((GRID.nodes, 5)))
        from lattice.cracks.motion import evaluate_at

        evaluate_at(k, e._nodes(), layered.view())
        stored = layered._cracks.thrust[k, 0]
        whole = 5e9 * 0.5 * 1e-5 / (1 - 1 / 9)  # plane stress, nothing across
        assert stored == pytest.approx(whole if stretch < 0 else 0.0, rel=1e-9)


def test_open_cracks_that_cut_a_piece_off_are_refused(tmp_path):
    ring = [
        f"{1.5 * (i + 0.5)},{1.5 * (j + 0.5)},crack,"
        for i in range(8, 13)
        for j in range(6, 11)
        if i in (8, 12) or j in (6, 10)
    ]
    with pytest.raises(InputError, match="cut 1 pieces off that nothing holds"):
        sheet(write(tmp_path / "b.csv", *ring), *OPEN)
    assert sheet(tmp_path / "b.csv", *CLOSING).joins.all()


@pytest.mark.parametrize("how", [OPEN, CLOSING])
def test_a_floe_with_a_broken_edge_lies_before_the_structure_and_its_balances_close(tmp_path, how):
    """Its front has a bay of 3 rows where the structure stands; mass is that of what is left."""
    bay = [f"{1.5 * i},{1.5 * j},gone," for i in (22, 23, 24) for j in range(3, 16)]
    crack = [f"{1.5 * (i + 0.5)},13.5,crack," for i in range(12, 20)]
    path = write(tmp_path / "b.csv", *bay, *crack)
    scenario = load_scenario(CASE, [*how, f"sheet.broken='{path}'", "scenario.duration='4 s'"])
    scheduler = build(scenario)
    floe = scheduler.sheet.sheet
    assert (~floe.present).sum() == len(bay)
    front = floe.front[8:11]
    assert (front == 21).all()
    lead = GRID.d / 2
    place = floe.grid.x0 + 21 * GRID.d + lead
    assert place == pytest.approx(scheduler.sheet.contact._s.foremost_x(floe.ice.freeboard), abs=1e-6)
    run = run_scenario(scenario)
    area = floe.grid.area[floe.present].sum()
    assert run.ledger["initial_mass"] == pytest.approx(900.0 * 0.5 * area, rel=1e-12)
    assert abs(run.ledger["mass_error"]) < 1e-9
    assert abs(run.ledger["sheet_energy_residual"]) < 2e-3
    first = np.array([t for t, load in run.loads if load[0, 0] > 0.0])
    assert first[0] <= 0.1e9  # it touches at once


@pytest.fixture(scope="module", params=[OPEN, CLOSING], ids=["open", "closing"])
def ended(request, tmp_path_factory):
    """A run that breaks, its recording and its sheet at the end."""
    from cosim.recording.writer import Recorder

    path, kept = tmp_path_factory.mktemp("run") / "run.mcap", []
    scenario = load_scenario(CASE, [*request.param, "scenario.duration='6 s'", "recording.every='1 s'"])
    recorder = Recorder(path)
    try:
        run_scenario(scenario, [recorder], lambda scheduler: kept.append(scheduler.sheet.sheet))
    finally:
        recorder.on_close()
    return request.param, path, kept[0]


def test_the_end_of_a_run_is_the_start_of_the_next(ended, tmp_path):
    how, _, floe = ended
    table = as_table(floe)
    assert "gone" in table["what"].to_pylist()
    pa.parquet.write_table(table, tmp_path / "b.parquet")
    again = sheet(tmp_path / "b.parquet", *how)
    assert (again.present == floe.present).all()
    deep = floe.hinges.cells if how is CLOSING else np.flatnonzero(~floe.intact)
    live = floe.present[floe.grid.cell_nodes].all(axis=1)
    assert sorted(np.flatnonzero(~again.intact & live)) == sorted(c for c in deep if live[c])
    if how is CLOSING:
        angle = dict(zip(floe.engine.layered.cell.tolist(), floe.engine.layered.angle, strict=True))
        for c, a in zip(again.engine.layered.cell.tolist(), again.engine.layered.angle, strict=True):
            assert a == pytest.approx(angle[c])


def test_a_recording_tells_nearly_the_same(ended):
    how, recording, floe = ended
    found, g = broken(recording, GRID), floe.grid
    assert (found.gone == ~floe.present).all()
    live = floe.present[g.cell_nodes].all(axis=1)
    deep = np.zeros(g.cells, bool)
    deep[floe.hinges.cells if how is CLOSING else np.flatnonzero(~floe.intact)] = True
    told = np.zeros(g.cells, bool)
    told[found.cracked] = True
    assert (told != (deep & live)).sum() <= 0.1 * (deep & live).sum() + 2
    with pytest.raises(InputError, match=r"cells of 1\.5 m, this one of 2 m"):
        broken(recording, Grid(25, 19, 2.0))


def test_damage_of_cells_follows_from_that_of_nodes():
    rng = np.random.default_rng(2)
    damage = np.where(rng.random(GRID.cells) < 0.2, rng.random(GRID.cells), 0.0)
    share = np.bincount(GRID.cell_nodes.ravel(), minlength=GRID.nodes)
    nodes = np.bincount(GRID.cell_nodes.ravel(), np.repeat(damage, 4), GRID.nodes) / share
    everywhere = np.ones(GRID.nodes, bool)
    assert cell_damage(GRID, everywhere, nodes.astype(np.float32)) == pytest.approx(damage, abs=1e-3)


def test_a_run_writes_its_ice_and_the_next_one_reads_it(cosim, tmp_path):
    out = tmp_path / "end.csv"
    options = [x for item in (*OPEN, "scenario.duration='5 s'") for x in ("--set", item)]
    assert cosim("run", CASE, *options, "--ice", out, "-q")[0] == 0
    assert out.read_text().startswith('"x","y","what","angle"\n')
    code, _, err = cosim("run", CASE, *options, "--set", f"sheet.broken='{out}'", "-q")
    assert (code, err) == (0, "") or "not trustworthy" in err
    (tmp_path / "mine.csv").write_text("a,b\n1,2\n")
    code, _, err = cosim("run", CASE, *options, "--ice", tmp_path / "mine.csv")
    assert (code, "is not written over" in err) == (2, True)
