"""`import cosim`: runs, tables, sweeps, notebooks; the examples of the page do what they say."""

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import cosim
from cosim.export.tables import load_units
from cosim.show.ice.palette import PHASE_COLOURS

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs/python.md").read_text("utf-8")
QUICK = {"scenario.duration": "1 s", "sheet.nodes": [20, 20], "rubble.enabled": False}
CASE = "van_vliet_2018_floe_55m_centre"


def example(title):
    return re.search(rf'```python title="{title}"\n(.*?)```', PAGE, re.S)[1]


def test_importing_it_is_quick():
    """Nothing heavy is imported before something is asked for; asking for what is not there is told."""
    code = (
        "import cosim, sys; print([m for m in ('numpy', 'pandas', 'numba', 'pydantic', 'rerun') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
    assert set(cosim.__all__) <= set(dir(cosim))
    with pytest.raises(AttributeError, match="no attribute 'simulate'"):
        cosim.simulate  # noqa: B018


@pytest.fixture(scope="module")
def run():
    return cosim.run(CASE, set=QUICK)


def test_a_run_has_tables_with_units(run):
    loads = run.loads
    assert loads.index.name == "time"
    assert list(loads.attrs["units"]) == ["time", *loads.columns] == list(load_units())
    assert loads["fx"].to_numpy() == pytest.approx(run.data.component("fx"), rel=1e-15)
    assert np.allclose(loads["f"] ** 2, loads["fx"] ** 2 + loads["fy"] ** 2 + loads["fz"] ** 2)
    assert run.averaged()["fx"].abs().max() == pytest.approx(abs(run.peaks.loc[("total", "fx"), "value"]), rel=1e-12)
    assert run.averaged(0.0).equals(loads)
    assert set(run.events.columns) == set(run.events.attrs["units"])
    peak = abs(run.peaks.loc[("total", "fx"), "value"])
    assert all(abs(load) <= peak * (1 + 1e-12) for load in run.events["fx"])
    assert run.ledger["mass_error"].abs().max() < 1e-12
    assert {"fx_inertia", "fz_pressed_sheet"} <= set(run.budget.columns)
    assert run.dataset()["force"].sizes["time"] == len(loads)
    assert sum(1 for _ in run.pictures()) == 3
    assert "[ice]" in run.scenario


def test_settings_are_those_of_the_command_line(run):
    assert run.data.overrides == ['scenario.duration="1 s"', "sheet.nodes=[20, 20]", "rubble.enabled=false"]
    with pytest.raises(cosim.InputError, match="needs its unit"):
        cosim.run(CASE, set={"ice.thickness": 2})
    with pytest.raises(cosim.InputError, match="no such scenario"):
        cosim.run("first_con")


def test_a_recording_is_kept_where_it_is_asked_for(run, tmp_path):
    kept = run.save(tmp_path / "kept.mcap")
    again = cosim.open(kept)
    assert again.loads.equals(run.loads)
    assert kept.read_bytes() == run.path.read_bytes()
    with pytest.raises(cosim.InputError, match="exists and is kept"):
        run.save(kept)
    assert run.report(tmp_path / "r.html").stat().st_size > 10_000
    assert run.export(tmp_path / "r.csv").is_file()


def test_a_run_without_an_output_leaves_nothing_behind():
    lost = cosim.run(CASE, set={**QUICK, "scenario.duration": "100 ms"})
    path = lost.path
    assert path.is_file()
    del lost
    assert not path.parent.exists()


def test_a_sheet_that_does_not_fit_this_machine_is_not_tried(monkeypatch, tmp_path):
    monkeypatch.setattr("cosim.scenario.cost.memory_of_this_machine", lambda: 1e8)
    with pytest.raises(ValueError, match="this machine has 100 MB; use fewer nodes"):
        cosim.run(CASE, set=QUICK, output=tmp_path / "run.mcap")
    assert list(tmp_path.iterdir()) == []


def test_a_run_shows_itself(run):
    assert repr(run) == f"<cosim.Run {CASE}: 1 s, 20 windows, {len(run.events)} events>"
    page = run._repr_html_()
    assert run.title in page
    assert "not trustworthy" in page
    assert 'src="data:image/png;base64,' in page
    peak = run.peaks.loc[("total", "fx"), "value"]
    figure = run.plot()
    drawn = np.concatenate([line.get_ydata() for line in figure.axes[0].lines[:1]])
    unit = {"MN": 1e6, "kN": 1e3}[re.search(r"\[(\wN)\]", figure.axes[0].get_ylabel())[1]]
    assert np.abs(drawn).max() * unit == pytest.approx(abs(peak), rel=1e-9)


def test_titles_from_outside_are_text(run):
    from dataclasses import replace

    from cosim.show.run_html import run_html

    bad = replace(run.data, metadata={**run.data.metadata, "title": "<script>x</script>"})
    assert "<script>" not in run_html(bad)


def test_a_sweep_is_a_table():
    found = cosim.sweep(CASE, {"ice.thickness": ["2 m", "-1 m"]}, set=QUICK)
    assert list(found.index) == ["base", 'ice.thickness = "2 m"', 'ice.thickness = "-1 m"']
    assert found.loc["base", "fx_ratio"] == 1.0
    assert found["error"].notna().tolist() == [False, False, True]
    assert found["fx_peak"].iloc[1] > 0.0


def test_ten_lines_give_a_plot(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    exec(compile(example("first_plot.py"), "first_plot.py", "exec"), {"__name__": "example"})
    from PIL import Image, ImageColor

    image = np.asarray(Image.open(tmp_path / "load.png").convert("RGB"), int)
    for phase in ("breaking", "rotating"):
        rgb = 0.75 * np.array(ImageColor.getrgb(PHASE_COLOURS[phase])) + 0.25 * 255.0  # seen through
        assert (np.abs(image - rgb).max(axis=2) < 12).sum() > 200, rgb
    assert (tmp_path / "loads.parquet").is_file()
    assert "circumferential" in capsys.readouterr().out


def test_the_lattice_alone_meets_hertz(capsys):
    exec(compile(example("plate_on_water.py"), "plate_on_water.py", "exec"), {})
    found, exact = map(float, re.findall(r"([\d.]+) mm", capsys.readouterr().out))
    assert found == pytest.approx(exact, rel=0.01)


def test_the_rubble_alone_presses_with_its_buoyancy(capsys):
    exec(compile(example("pile_of_blocks.py"), "pile_of_blocks.py", "exec"), {})
    found, exact = map(float, re.findall(r"([\d.]+) kN", capsys.readouterr().out))
    assert found == pytest.approx(exact, rel=0.005)


def test_the_notebook_runs():
    import nbformat
    from nbclient import NotebookClient

    book = nbformat.read(ROOT / "docs/notebooks/first_run.ipynb", as_version=4)
    assert all(not cell.get("outputs") for cell in book.cells)  # kept without
    NotebookClient(book, timeout=300, kernel_name="python3").execute()
    shown = [output for cell in book.cells for output in cell.get("outputs", [])]
    kinds = {kind for output in shown for kind in output.get("data", {})}
    assert {"text/html", "image/png", "text/plain"} <= kinds
    assert any("blocks" in output.get("text", "") for output in shown)
