"""A series made from a stored run, changed as measuring changes it, comes back as that run."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from cosim.recording.reader import read_run
from cosim.series.compare import agreement_rows, files, rows
from cosim.series.description import Description, LoadColumn, load_description
from cosim.series.metrics import PAIR, SINGLE
from cosim.series.told import SeriesError

LAMBDA, SHIFT, CALM = 36.0, 7.3, 25.0  #: SHIFT is calm before the run, CALM after it, in seconds of the run
TIME = "sensor.unloaded=[['0 s', '1.1 s'], ['11.4 s', '15 s']]"
ZERO_ONLY = "sensor.unloaded=[['0 s', '1.1 s']]"
COMMON = [f"scale.factor={LAMBDA:g}", "fx.column=Kraft X", "fx.sign=-1", TIME]


@pytest.fixture(scope="module")
def run(record, tmp_path_factory):
    return read_run(
        record(
            tmp_path_factory.mktemp("series") / "run.mcap",
            ("scenario.duration='60 s'", "sheet.nodes=[20,20]", "recording.every='20 s'"),
        )
    )


def measured(run, noise=0.05, drift=0.3):
    """Model time [s] and load [N] as a sensor of the other sign would give them at 200 Hz: calm, run, calm."""
    t = np.arange(0.0, (SHIFT + run.t[-1] + CALM) / np.sqrt(LAMBDA), 0.005)
    full = np.sqrt(LAMBDA) * t - SHIFT
    load = np.concatenate((run.component("fx"), [0.0]))
    y = load[np.minimum(np.searchsorted(run.t, full, side="right"), len(load) - 1)] * (full >= 0.0)
    size = np.abs(y).max()
    y = y + noise * size * np.random.default_rng(12).standard_normal(len(y))
    return t, -(y + size * drift * (0.5 + t / t[-1])) / LAMBDA**3


def write(path, run, **given):
    t, load = measured(run, **given)
    rows = "".join(f"{1000 * a:.3f};{b / 1000:.7f}\n".replace(".", ",") for a, b in zip(t, load, strict=True))
    path.write_text("Basin, test 12\nZeit;Kraft X\n[ms];[kN]\n" + rows, encoding="utf-8")
    return path


def values(comparison):
    return {r["name"]: r for r in rows(comparison.pairs[0])}, {
        r["name"]: r["value"] for r in agreement_rows(comparison.pairs[0])
    }


def test_a_series_made_from_a_run_is_that_run(run, tmp_path):
    """1:36, 7.3 s later, ms and kN, decimal commas, other sign, drifting zero, noise of 5 %: ratio 1.00, shift 50 ms.

    Noise raises the largest of many values, which a ratio of the largest shows and one of means or peaks does not.
    """
    (found,) = files(write(tmp_path / "m.csv", run), [run], [*COMMON, "align.by=correlation"])
    assert found.alignment.shift == pytest.approx(SHIFT, abs=0.05)
    single, pair = values(found)
    for name in ("mean", "std", "mean_peak", "quantile_95", "level_between_peaks", "period_by_spectrum"):
        assert single[name]["ratio"] == pytest.approx(1.0, abs=0.01), name
    assert single["peaks"]["ratio"] == 1.0
    assert 0.97 < single["largest"]["ratio"] < 1.0
    assert pair["slope"] == pytest.approx(1.0, abs=0.01)
    assert pair["correlation"] > 0.995
    told = "\n".join(found.told)
    for line in ("decimal comma", "in ms", "sign turned", "drifting to", "froude 1:36", "series later by 7."):
        assert line in told


@pytest.mark.parametrize("by", ["correlation", "contact", "peak"])
def test_every_alignment_finds_the_shift_of_a_series_without_noise(run, tmp_path, by):
    (found,) = files(write(tmp_path / "m.csv", run, noise=0.0), [run], [*COMMON, f"align.by={by}"])
    assert found.alignment.shift == pytest.approx(SHIFT, abs=0.05)
    single, _ = values(found)
    for name in ("largest", "mean", "mean_peak"):
        assert single[name]["ratio"] == pytest.approx(1.0, abs=0.002), name


def test_by_event_and_by_hand(run, tmp_path):
    """The split of the run is at 4 s, in the series at 11.3 s, which is 1.8833 s of the model."""
    path = write(tmp_path / "m.csv", run)
    event = ["align.by=event", "align.event=split", f"align.at={(4.0 + SHIFT) / 6.0:.4f} s"]
    for settings in (event, ["align.by=hand", "align.shift=7.3 s"]):
        (found,) = files(path, [run], [*COMMON, *settings])
        assert found.alignment.shift == pytest.approx(SHIFT, abs=0.001)
    with pytest.raises(SeriesError, match="no event 'melt' to align with"):
        files(path, [run], [*COMMON, "align.by=event", "align.event=melt", "align.at=1 s"])


@pytest.mark.parametrize(
    ("wrong", "name"),
    [
        ("scale.factor=35", "mean_peak"),
        (ZERO_ONLY, "mean"),
        ("fx.unit=kgf", "mean_peak"),
        ("align.shift=9 s", "slope"),
    ],
)
def test_a_wrong_setting_is_not_that_run(run, tmp_path, wrong, name):
    """Another factor, zero without drift, another unit, another shift: each is off by more than the 1 % above."""
    settings = [*COMMON, "align.by=hand", "align.shift=7.3 s", wrong]
    single, pair = values(files(write(tmp_path / "m.csv", run), [run], settings)[0])
    value = pair[name] if name in pair else single[name]["ratio"]
    assert abs(value - 1.0) > 0.02


def test_a_series_that_shares_no_time_is_refused(run, tmp_path):
    with pytest.raises(SeriesError, match="shares no time with run"):
        files(write(tmp_path / "m.csv", run), [run], [*COMMON, "align.by=hand", "align.shift=-500 s"])


def test_another_run_is_a_series(cosim, run_file, record, tmp_path):
    other = record(tmp_path / "other.mcap")
    code, out, err = cosim("compare", run_file, other, "--json")
    assert code == 0, err
    series = json.loads(out)["series"]
    assert series["shift_s"] == pytest.approx(0.0, abs=1e-9)
    assert set(series["components"]) == {"fx", "fy", "fz"}
    for row in series["components"]["fx"]["metrics"]:
        assert row["ratio"] is None or row["ratio"] == pytest.approx(1.0, rel=1e-9), row["name"]


def test_command_gives_series_json_table_and_pictures(cosim, run, run_file, tmp_path):
    path, settings = write(tmp_path / "m.csv", run), [a for s in COMMON[:3] for a in ("--set", s)]
    code, out, err = cosim("compare", run_file, path, *settings, "--pictures", tmp_path / "p", "--json")
    assert code == 0, err
    content = json.loads(out)
    assert content["features"]
    assert content["series"]["aligned_by"] == "contact"
    names = {row["name"] for row in content["series"]["components"]["fx"]["metrics"]}
    assert {"largest", "peaks", "damage_equivalent_load", "return_level", "period_by_spectrum"} <= names
    pictures = sorted(p.name for p in (tmp_path / "p").iterdir())
    assert pictures == [f"run_fx_{n}.png" for n in ("alignment", "exceedance", "overlay", "scatter", "spectra")]
    code, out, err = cosim("compare", run_file, path, *settings)
    assert code == 0, err
    assert "series: scale: froude 1:36" in out
    assert "damage_equivalent_load" in out


def test_several_runs_give_a_list(cosim, run, run_file, record, tmp_path):
    other, path = record(tmp_path / "other.mcap"), write(tmp_path / "m.csv", run)
    settings = [a for s in COMMON[:3] for a in ("--set", s)]
    code, out, err = cosim("compare", run_file, other, path, *settings, "--json")
    assert code == 0, err
    assert [item["run"] for item in json.loads(out)] == ["run.mcap", "other.mcap"]


def test_a_reference_names_its_series(cosim, run, run_file, tmp_path):
    write(tmp_path / "m.csv", run)
    (tmp_path / "series.toml").write_text(
        'file = "m.csv"\nsource = "made"\n[fx]\ncolumn = "Kraft X"\nsign = -1\n[scale]\nfactor = 36\n'
    )
    (tmp_path / "reference.toml").write_text(
        'series = "series.toml"\n[[feature]]\nname = "a"\nquantity = "peak_load"\nunit = "N"\nsource = "made"\n'
    )
    code, out, err = cosim("compare", run_file, tmp_path, "--json")
    assert code == 0, err
    content = json.loads(out)
    assert content["series"]["source"] == "made"
    assert content["features"][0]["name"] == "a"


def test_report_holds_the_pictures_of_the_series(cosim, run, run_file, tmp_path):
    path, settings = write(tmp_path / "m.csv", run), [a for s in COMMON[:3] for a in ("--set", s)]
    code, _, err = cosim("report", run_file, "-o", tmp_path / "r.html", "--series", path, *settings)
    assert code == 0, err
    page = (tmp_path / "r.html").read_text("utf-8")
    for text in ("Fx beside m.csv", "Exceedance of the peaks", "Scatter", "Spectra", "Simulated and measured"):
        assert text in page


def test_parquet_beside_a_run(run, tmp_path):
    t, load = measured(run, noise=0.0, drift=0.0)
    pq.write_table(pa.table({"t [s]": t, "Fx [N]": -load}), tmp_path / "m.parquet")
    (found,) = files(tmp_path / "m.parquet", [run], ["scale.factor=36", "align.by=correlation"])
    assert found.alignment.shift == pytest.approx(SHIFT, abs=0.05)


@pytest.mark.parametrize(
    ("names", "line"),
    [
        (["a.csv", "b.csv"], "two series"),
        (["a.toml", "b.toml"], "two references"),
        (["no.csv"], "no.csv: cannot be read"),
    ],
)
def test_what_cannot_be_compared_is_one_line(cosim, run_file, tmp_path, names, line):
    code, out, err = cosim("compare", run_file, *[tmp_path / n for n in names])
    assert (code, out) == (2, "")
    assert line in err


def test_settings_without_a_series_are_refused(cosim, run_file):
    code, _, err = cosim("compare", run_file, "--set", "fx.unit=kN")
    assert code == 2
    assert "belong to a series" in err


def test_the_page_names_all_metrics_and_keys_and_its_example_is_read(tmp_path):
    page = (Path(__file__).parents[2] / "docs/series.md").read_text("utf-8")
    named = set(re.findall(r"`([a-z_0-9.]+)`", page))
    assert {*SINGLE, *PAIR} <= named
    for section in ("text", "time", "fx", "sensor", "scale", "align", "metrics"):
        kind = LoadColumn if section == "fx" else Description.model_fields[section].annotation
        assert {f"{section}.{key}" for key in kind.model_fields} <= named
    (tmp_path / "series.toml").write_text(re.search(r'```toml title="series.toml"\n(.*?)```', page, re.S)[1])
    description, file = load_description(tmp_path / "series.toml")
    assert file == tmp_path / "measured.csv"
    assert description.unloaded == ((0.0, 4.0), (95.0, 99.0))
