"""Benchmarks: each runs in a process of its own, what it prints becomes a page, and a failure is told."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from cosim import bench
from cosim.cli.entry import app
from cosim.errors import FailedError, InputError

SCRIPTS = {
    "good.py": "import sys, cosim; print('ratio', sys.argv[1])",
    "bad.py": "print('before'); raise SystemExit(3)",
}


@pytest.fixture
def two(tmp_path, monkeypatch):
    for name, text in SCRIPTS.items():
        (tmp_path / name).write_text(text)
    monkeypatch.setattr(bench, "FOLDER", tmp_path)
    monkeypatch.setattr(bench.run, "__defaults__", (tmp_path,))
    plan = (bench.Benchmark("good", "good.py", ("1.5",), "one"), bench.Benchmark("bad", "bad.py", (), "another"))
    monkeypatch.setattr(bench, "BENCHMARKS", plan)
    return tmp_path


def test_every_benchmark_has_its_script():
    for b in bench.BENCHMARKS:
        assert (Path(bench.FOLDER) / b.script).is_file(), b.name
    assert len({b.name for b in bench.BENCHMARKS}) == len(bench.BENCHMARKS)


def test_what_benchmarks_print_becomes_a_page_and_a_failure_is_told(two):
    page = two / "bench.md"
    done = CliRunner().invoke(app, ["bench", "-o", str(page)])
    assert isinstance(done.exception, FailedError)
    assert "benchmarks failed: bad" in str(done.exception)
    text = page.read_text()
    assert "ratio 1.5" in text
    assert "before" in text
    assert "**failed with exit code 3**" in text
    assert "`python tests/benchmarks/good.py 1.5`" in text
    assert CliRunner().invoke(app, ["bench", "good", "-o", str(page)]).exit_code == 0
    assert "bad" not in page.read_text()
    page.write_text("# A page of one's own")
    assert isinstance(CliRunner().invoke(app, ["bench", "good", "-o", str(page)]).exception, InputError)
    assert page.read_text() == "# A page of one's own"


def test_chosen_ones_as_json(two):
    done = CliRunner().invoke(app, ["bench", "good", "--json", "-o", str(two / "bench.md")])
    assert done.exit_code == 0
    found = json.loads(done.stdout)
    assert [(b["name"], b["text"], b["code"]) for b in found["benchmarks"]] == [("good", "ratio 1.5", 0)]
    listed = json.loads(CliRunner().invoke(app, ["bench", "--list", "--json"]).stdout)
    assert [b["name"] for b in listed["benchmarks"]] == ["good", "bad"]


def test_names_that_are_none_and_installations_without_scripts_are_told(two):
    with pytest.raises(InputError, match="goood: no such benchmark"):
        bench.chosen(["goood"])
    with pytest.raises(InputError, match="benchmarks come with a checkout"):
        bench.run(bench.BENCHMARKS[0], print, two / "nowhere")
