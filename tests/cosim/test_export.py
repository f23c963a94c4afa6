"""Recordings in other forms, each read back by the library that its users use."""

import json

import numpy as np
import pytest

from cosim.export.tables import TABLES
from cosim.recording.reader import read_run, recorded_pictures
from cosim.recording.writer import Recorder
from cosim.scenario.loading import load_scenario
from cosim.simulation import run_scenario
from coupling.interface import PHASES, Phase

CASE = "van_vliet_2018_floe_55m_centre"
TINY = ("sheet.nodes=[12, 12]", "drift.velocity='0.4 m/s'", "scenario.duration='4 s'", "rubble.initial_volume='60 m^3'")
TINY += ("recording.moment_point=['0 m', '0 m', '-20 m']",)


@pytest.fixture(scope="module")
def recording(tmp_path_factory):
    path = tmp_path_factory.mktemp("export") / "run.mcap"
    with Recorder(path) as recorder:
        run_scenario(load_scenario(CASE, TINY), [recorder])
    return path


@pytest.fixture(scope="module")
def run(recording):
    return read_run(recording)


@pytest.fixture
def exported(cosim, recording, tmp_path):
    """exported(name, *options) -> the file."""

    def export(name, *options):
        code, _, err = cosim("export", recording, "-o", tmp_path / name, *options)
        assert (code, err) == (0, "")
        return tmp_path / name

    return export


@pytest.mark.parametrize(("name", "reader"), [("run.csv", "read_csv"), ("run.parquet", "read_parquet")])
def test_pandas_reads_loads_with_their_units(exported, run, name, reader):
    import pandas as pd

    table = getattr(pd, reader)(exported(name))
    assert table["time [s]"].to_numpy() == pytest.approx(run.t, rel=1e-15)
    for axis in ("fx", "fy", "fz", "f"):
        assert np.array_equal(table[f"{axis} [N]"], run.component(axis)), axis
    assert np.array_equal(table["sliding_my [N m]"], run.component("my", "sliding"))
    parts = sum(table[f"{phase}_fx [N]"] for phase in PHASES)
    assert np.allclose(parts, table["fx [N]"], rtol=1e-12, atol=1e-12 * abs(table["fx [N]"]).max())
    places = table[["attack_x [m]", "attack_z [m]"]].dropna().to_numpy()
    assert len(places) > 40
    assert (places[:, 0] < 0.0).all()  # in front of the axis


@pytest.mark.parametrize("name", sorted(TABLES))
def test_every_table_is_there(exported, run, name):
    import pandas as pd

    table = pd.read_parquet(exported(f"{name}.parquet", "--table", name))
    assert table.columns[0] == "time [s]"
    rows = len(run.events) if name == "events" else len(run.t)
    assert len(table) == rows
    if name == "ledger":
        assert {"drift_work [J]", "rubble_mass [kg]", "mass_error [1]", "power_to_sheet [W]"} <= set(table.columns)


def test_events_are_a_table(run_file, tmp_path, cosim):
    import pandas as pd

    assert cosim("export", run_file, "-o", tmp_path / "e.csv", "--table", "events")[0] == 0
    table = pd.read_csv(tmp_path / "e.csv")
    assert table["kind"].tolist() == ["split", "circumferential", "hand_over"]
    assert table["cells [1]"].tolist() == [24, 31, 0]


@pytest.mark.parametrize("name", ["run.nc", "run.h5"])
def test_xarray_reads_the_run(exported, run, name):
    import xarray as xr

    with xr.open_dataset(exported(name), engine="h5netcdf") as data:
        data.load()
    assert np.array_equal(data["force"], run.load)
    assert np.array_equal(data["moment"].sum("phase").sel(axis="y"), run.component("my"))
    assert data["force"].sel(phase="sliding", axis="x").attrs["units"] == "N"
    assert data["time"].dtype == float
    assert data.attrs["Conventions"].startswith("CF-")
    bounds = data[data["time"].attrs.get("bounds", data["time"].encoding.get("bounds"))]
    assert np.array_equal(bounds[:, 1], run.t)
    assert np.array_equal(bounds[1:, 0], run.t[:-1])
    assert data["moment_point"].values.tolist() == [0.0, 0.0, -20.0]
    assert data["ledger_drift_work"].attrs["units"] == "J"
    assert json.loads(data.attrs["overrides"]) == list(TINY)
    impulse = (data["force"].sum("phase") * (bounds[:, 1] - bounds[:, 0])).sum("time")
    assert impulse.values == pytest.approx(run.load.sum(axis=1).sum(axis=0) * 0.05, rel=1e-12, abs=1e-6)


def test_hdf5_without_xarray(exported, run):
    import h5py

    with h5py.File(exported("run.h5")) as file:
        assert np.array_equal(file["force"][:], run.load)
        assert file["force"].attrs["units"] in ("N", b"N")


def test_paraview_series(exported, recording, run):
    """The sheet has the volume of its cells, blocks are closed, forces are the load."""
    import pyvista as pv

    reader = pv.PVDReader(exported("run.pvd"))
    pictures = list(recorded_pictures(recording))
    assert reader.time_values == pytest.approx([p.t_ns / 1e9 for p in pictures])
    reader.set_active_time_point(len(pictures) - 1)
    sheet, blocks, forces, structure = reader.read()
    last, thickness = pictures[-1], float(run.metadata["thickness_m"])
    d = float(run.metadata["spacing_m"])
    assert sheet.n_cells == last.sheet.intact.sum()
    assert sheet.compute_cell_sizes()["Volume"].sum() == pytest.approx(sheet.n_cells * d * d * thickness, rel=0.01)
    assert sheet.point_data["utilisation"].max() == pytest.approx(last.sheet.utilisation[last.sheet.present].max())
    assert blocks.n_open_edges == 0
    outlines = [last.blocks.outline[a:b] for a, b in zip(last.blocks.offset, last.blocks.offset[1:], strict=False)]
    area = np.array([0.5 * np.sum(o[:, 0] * np.roll(o[:, 1], -1) - np.roll(o[:, 0], -1) * o[:, 1]) for o in outlines])
    assert blocks.volume == pytest.approx((area * last.blocks.width).sum(), rel=1e-6)
    assert set(np.unique(blocks.cell_data["phase"])) <= {Phase.ROTATING, Phase.SLIDING}
    load = np.abs(run.load[-1]).max()
    assert forces.point_data["force"].sum(axis=0) == pytest.approx(run.load[-1].sum(axis=0), abs=1e-3 * load)
    assert structure.n_cells > 100


def test_openfast_series(exported, run):
    """As OpenFAST reads it: lines that begin with one of #!% are comments, seven columns, linear between rows."""
    path = exported("run.dat")
    rows = np.loadtxt(path, comments=["#", "!", "%"])
    assert rows.shape == (len(run.t), 7)
    assert (np.diff(rows[:, 0]) > 0).all()
    assert rows[:, 1:4] == pytest.approx(run.load.sum(axis=1), rel=1e-9, abs=1e-6)
    assert rows[:, 5] == pytest.approx(run.component("my"), rel=1e-9, abs=1e-6)
    interpolated = np.trapezoid(rows[:, 1], rows[:, 0])
    assert interpolated == pytest.approx(run.component("fx").sum() * 0.05, rel=0.02)
    names = next(line for line in path.read_text().splitlines() if "Time" in line).strip("# ").split(", ")
    assert names == ["Time", "FX", "FY", "FZ", "MX", "MY", "MZ"]
    assert "z = -20 m" in path.read_text()


@pytest.mark.parametrize(
    ("name", "options", "what"),
    [
        ("run.xls", (), "the ending says the form"),
        ("run.nc", ("--table", "loads"), "--table belongs to .csv and .parquet"),
        ("run.csv", ("--table", "load"), "did you mean"),
    ],
)
def test_what_cannot_be_exported_is_told(cosim, run_file, tmp_path, name, options, what):
    code, out, err = cosim("export", run_file, "-o", tmp_path / name, *options)
    assert (code, out) == (2, "")
    assert what in err
    assert list(tmp_path.iterdir()) == []


def test_an_export_replaces_one_of_its_kind_only(cosim, run_file, tmp_path):
    mine = tmp_path / "run.csv"
    mine.write_text("my own\n")
    assert cosim("export", run_file, "-o", mine)[0] == 2
    assert mine.read_text() == "my own\n"
    for _ in range(2):
        assert cosim("export", run_file, "-o", tmp_path / "again.csv")[0] == 0
    folder = tmp_path / "run_vtk"
    folder.mkdir()
    code, _, err = cosim("export", run_file, "-o", tmp_path / "run.pvd")
    assert (code, "is there already and is kept" in err) == (2, True)
    assert list(folder.iterdir()) == []


def test_a_truncated_recording_is_exported_and_told_of(cosim, run_file, tmp_path):
    import pandas as pd

    cut = tmp_path / "cut.mcap"
    cut.write_bytes(run_file.read_bytes()[:-200_000])
    code, _, err = cosim("export", cut, "-o", tmp_path / "cut.csv")
    assert code == 0
    assert "truncated" in err
    assert 0 < len(pd.read_csv(tmp_path / "cut.csv")) < 240
