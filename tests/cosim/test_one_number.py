"""A peak is one number: the same one, with the time over which it is a mean, wherever the program tells it."""

import json
import re
import tomllib

import numpy as np
import pytest

from cosim.analysis.sustained import averaging_time
from cosim.recording.metadata import fault
from cosim.recording.reader import read_run
from cosim.recording.writer import Recorder
from cosim.scenario.loading import load_scenario, read_scenario
from cosim.show.figures import draw_loads
from cosim.show.report import content, write_report
from cosim.simulation import run_scenario
from cosim.study.task import Study, run_variant
from cosim.study.variants import Variant

CASE = "van_vliet_2018_floe_55m_centre"
TINY = ("sheet.nodes=[12, 12]", "drift.velocity='0.4 m/s'", "scenario.duration='6 s'")
TINY += ("rubble.initial_volume='60 m^3'", "recording.averaging='0.3 s'")


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """A run of 6 s in which rubble hits: single windows differ much from means. The result and its recording."""
    path = tmp_path_factory.mktemp("one") / "run.mcap"
    with Recorder(path) as recorder:
        result = run_scenario(load_scenario(CASE, TINY), [recorder])
    return result, path


def test_every_command_tells_the_same_peaks(cosim, run, tmp_path):
    result, path = run
    found = result.to_json()
    fx, fz = (found["peaks"][axis]["value"] for axis in ("fx", "fz"))
    windows = np.array([load.sum(axis=0) for _, load in result.loads])
    assert np.abs(windows[:, 0]).max() > 1.02 * fx  # otherwise nothing is told apart here
    info = json.loads(cosim("info", path, "--json")[1])
    beside = json.loads(cosim("compare", path, "--json")[1])
    features = {f["name"]: f for f in beside["features"]}
    swept = run_variant(Study(read_scenario(CASE), TINY), 0, Variant())
    report = content(read_run(path))
    told = {
        "info": (info["peaks"]["fx"]["value"], info["peaks"]["fz"]["value"], info["averaging_s"]),
        "compare": (features["peak_fx"]["simulated"], features["peak_fz"]["simulated"], features["peak_fx"]["over"]),
        "compare, peaks": (beside["peaks"]["fx"]["value"], beside["peaks"]["fz"]["value"], beside["averaging_s"]),
        "design": (*(beside["design"]["simulated"][a] for a in ("fx", "fz")), beside["design"]["averaging_s"]),
        "sweep": (swept["fx_peak"], swept["fz_peak"], swept["averaging_s"]),
        "report": (report["shares"]["fx"]["value"], report["shares"]["fz"]["value"], 0.3),
    }
    for who, numbers in told.items():
        assert numbers == pytest.approx((fx, fz, 0.3), rel=1e-12), who
    for method in beside["design"]["methods"].values():
        if "fx" in method:
            assert method["ratio_fx"] == pytest.approx(fx / method["fx"], rel=1e-12)


def test_text_for_people_shows_that_number_and_its_time(cosim, run, tmp_path):
    result, path = run
    peak = f"{result.peaks.value[0] / 1e6:.2f}"
    for text in (cosim("info", path)[1], cosim("compare", path)[1]):
        assert peak in text
        assert "0.3 s" in text
    write_report(read_run(path), tmp_path / "r.html")
    page = (tmp_path / "r.html").read_text()
    assert f"<td>{peak}</td>" in page
    assert "means over 0.3 s" in page


def test_the_curves_of_pictures_reach_the_peak_and_no_more(run):
    from matplotlib.figure import Figure

    result, path = run
    figure = Figure()
    draw_loads(figure, read_run(path))
    total = figure.axes[0].lines[-1].get_ydata()
    assert np.abs(total).max() * 1e6 == pytest.approx(abs(result.peaks.value[0]), rel=1e-9)
    assert "0.3 s" in figure.axes[1].get_xlabel()


def test_the_curves_of_the_replay_are_those_means_and_the_viewer_adds_no_other(run, monkeypatch):
    from cosim.show import replay

    result, path = run
    sent, lines = {}, []

    class Stream:
        def log(self, path, item, static=False):
            lines.append(item)

        def send_columns(self, path, indexes, columns):
            sent[path] = next(iter(columns)).as_arrow_array().values.to_numpy(zero_copy_only=False)

    data = read_run(path)
    replay._send_loads(Stream(), data)
    assert np.abs(sent["load/fx/all"]).max() * 1e6 == pytest.approx(abs(result.peaks.value[0]), rel=1e-9)
    assert len(sent["load/fx/all"]) == len(data.t)
    assert all(line.aggregation_policy.as_arrow_array().to_pylist() == [1] for line in lines)  # off


def test_no_event_has_a_larger_load_than_the_peak(run):
    found = run[0].to_json()
    assert found["events"]
    for axis in ("fx", "fz"):
        assert max(abs(e[axis]) for e in found["events"]) <= abs(found["peaks"][axis]["value"])


@pytest.mark.parametrize("form", ["csv", "parquet", "nc", "python"])
def test_exported_events_have_the_loads_of_info_and_those_of_the_instant(cosim, run, tmp_path, form):
    import pandas as pd
    import xarray as xr

    from cosim import open as opened

    path = run[1]
    told = json.loads(cosim("info", path, "--json")[1])["events"]
    raw = read_run(path).events
    if form == "python":
        table = opened(path).events
        table = table.rename(columns={n: f"{n} [{u}]" if u else n for n, u in table.attrs["units"].items()})
    else:
        out, more = tmp_path / f"e.{form}", () if form == "nc" else ("--table", "events")
        assert cosim("export", path, "-o", out, *more)[0] == 0
        if form == "nc":
            with xr.open_dataset(out, engine="h5netcdf") as data:
                assert "mean over event_averaging" in data["event_fx"].attrs["long_name"]
                units = {n: v.attrs.get("units") for n, v in data.items() if n.startswith("event_")}
                names = {n: f"{n.removeprefix('event_')} [{u}]" for n, u in units.items() if u}
                table = pd.DataFrame({name: data[n].values for n, name in names.items()})
        else:
            table = getattr(pd, f"read_{form}")(out)
    assert set(table["averaging [s]"]) == {0.3}
    for k, axis in enumerate(("fx", "fy", "fz")):
        assert table[f"{axis} [N]"].to_numpy() == pytest.approx([e[axis] for e in told], rel=1e-12)
        assert table[f"{axis}_instant [N]"].to_numpy() == pytest.approx([e.force[k] for e in raw], rel=1e-12)
    parted = np.abs(table["fx [N]"] - table["fx_instant [N]"]).max()
    assert parted > 0.01 * np.abs(table["fx [N]"]).max()  # otherwise nothing is told apart here


def test_the_averaging_time_follows_froude_from_the_thickness(tmp_path):
    assert averaging_time(1.0) == 0.5
    assert averaging_time(0.04) == pytest.approx(0.1, rel=1e-12)  # 1:25
    s = load_scenario(CASE, ["ice.thickness='4 m'"])
    text = tomllib.loads(s.resolved_toml())
    assert "averaging" in text["recording"]  # stated by the case
    file = tmp_path / "s.toml"
    file.write_text(re.sub(r"^averaging.*$", "", s.resolved_toml(), flags=re.M))
    assert load_scenario(file).averaging == pytest.approx(1.0, rel=1e-12)
    assert load_scenario(file, ["water.gravity='39.24 m/s^2'"]).averaging == pytest.approx(0.5, rel=1e-12)


def test_a_recording_says_its_averaging_time_and_its_length(run):
    told = dict(read_run(run[1]).metadata)
    assert (told["averaging_s"], fault(told)) == ("0.3", None)
    for key in ("averaging_s", "characteristic_length_m"):
        assert fault({k: v for k, v in told.items() if k != key}) == f"metadata {key} = None"
        for bad in ("-1.0", "nan", "inf", "x"):
            assert fault(told | {key: bad}) == f"metadata {key} = {bad!r}"


def test_units_follow_the_size_of_the_case(cosim, run, tmp_path):
    """The same run with loads of a thousandth and a millionth."""
    import dataclasses

    from cosim.analysis.summary import summary
    from cosim.show.tables import peaks_table

    data = read_run(run[1])
    for factor, unit in ((1.0, "MN"), (1e-3, "kN"), (1e-6, "N")):
        small = dataclasses.replace(data, load=data.load * factor)
        table = peaks_table(summary(small))
        assert f"Fx [{unit}]" in str(table.columns[1].header)
        first = str(next(iter(table.columns[1].cells)))
        assert len(first.replace(".", "").lstrip("0")) in (2, 3)  # three digits at the largest of the table
        report = content(small)
        assert report["loads"].unit == unit


def test_no_number_has_digits_that_nobody_knows():
    """A feed of 31023.31 kg/s is 31.0 t/s."""
    from cosim.show.scale import scale_of

    shown = [scale_of((value,), unit).labelled(value) for value, unit in ((31023.31, "kg/s"), (0.0412345, "kg/s"))]
    assert shown == ["31.0 t/s", "41.2 g/s"]
    assert scale_of((123456.789,), "N").labelled(123456.789) == "123 kN"


def test_lengths_of_events_have_three_digits_at_any_scale():
    from coupling.sheet_port.events import told

    assert [told(x) for x in (180.4, 0.28864, 15.25, 1234.0, 2.0)] == ["180", "0.289", "15.2", "1230", "2"]
