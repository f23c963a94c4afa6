"""The table of a sweep on disk: complete and equal whatever dies on the way, here and on a cluster."""

import json
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pyarrow.parquet as pq
import pytest

from cosim.errors import FailedError, InputError
from cosim.scenario.loading import load_scenario
from cosim.show.talk import QUIET, Talk
from cosim.study import parquet
from cosim.study.cluster import Cluster
from cosim.study.command import Where, is_random, plan, run_sweep, table_of
from cosim.study.design import Design
from cosim.study.parquet import ParquetTable, known_rows
from cosim.study.pool import Processes
from cosim.study.sweep import row_of, sweep
from cosim.study.task import RESULTS
from cosim.study.variants import Axis, Variant

CASE = "van_vliet_2018_floe_55m_centre"
TINY = ("sheet.nodes=[12, 12]", "scenario.duration='0.5 s'", "rubble.initial_volume='60 m^3'")
ABOUT = {"scenario": "s", "base": "abc", "program": "1", "design": "grid"}


def slow(study, number, variant):
    """A task without solver that leaves the number of its process."""
    if study is not None:
        Path(study, f"{number}.pid").write_text(str(os.getpid()))
    time.sleep(0.05)
    return {**dict.fromkeys(RESULTS, 0.1 * number + 1 / 3), "not_trustworthy": "", "fragments": 1, "blocks": 2}


def rows_in(path):
    return [{k: v for k, v in row.items() if k != "wall_s"} for row in pq.read_table(path).to_pylist()]


def many(n):
    return Design().variants([Axis("contact.friction", tuple(f"0.{k:03d}" for k in range(1, n)))], 0)


def table(path, variants, about=ABOUT):
    return ParquetTable(path, variants, ["contact.friction"], [], about)


def swept(path, variants, runner, study=None, known=None):
    with table(path, variants) as out:
        out.begin(known or {})
        return sweep(study, variants, runner, out.add, known, task=slow)


def test_numbers_are_numbers_and_the_base_has_none(tmp_path):
    swept(tmp_path / "t.parquet", many(4), Processes(2))
    found = pq.read_table(tmp_path / "t.parquet")
    assert found["contact.friction"].to_pylist() == [None, 0.001, 0.002, 0.003]
    assert found["fx_peak"].to_pylist() == [0.1 * k + 1 / 3 for k in range(4)]
    assert json.loads(found.schema.metadata[parquet.META]) == ABOUT
    assert [p.name for p in tmp_path.iterdir()] == ["t.parquet"]


@pytest.mark.skipif(os.name != "posix", reason="kills processes")
def test_two_workers_are_killed_and_the_table_is_complete_and_equal(tmp_path):
    variants = many(40)
    swept(tmp_path / "whole.parquet", variants, Processes(2))
    killed = []

    def kill():
        while len(killed) < 2:
            pids = {int(p.read_text() or 0) for p in tmp_path.glob("*.pid")} - {0, *killed}
            if len(list(tmp_path.glob("*.pid"))) > 8 and pids:
                for pid in sorted(pids)[: 2 - len(killed)]:
                    killed.append(pid)
                    os.kill(pid, signal.SIGKILL)
            time.sleep(0.01)

    murderer = threading.Thread(target=kill)
    murderer.start()
    swept(tmp_path / "killed.parquet", variants, Processes(2), study=str(tmp_path))
    murderer.join()
    assert len(killed) == 2
    assert rows_in(tmp_path / "killed.parquet") == rows_in(tmp_path / "whole.parquet")


def test_interrupted_anywhere_and_resumed_it_is_equal(tmp_path, monkeypatch):
    """Broken off with the table up to date, with rows in the journal only, and with the last line of that cut."""
    monkeypatch.setattr(parquet, "EVERY", 1e9)  # after the first row nothing but the journal is written
    variants = many(12)
    swept(tmp_path / "whole.parquet", variants, Processes(2))
    for cut in (0, 20):
        path = tmp_path / f"cut{cut}.parquet"
        out = table(path, variants).__enter__()
        out.begin({})
        for k in (3, 0, 7, 5):
            out.add(row_of(k, variants[k], slow(None, k, variants[k])))
        out._journal.close()  # as a process that is killed leaves it
        journal = out.journal
        journal.write_bytes(journal.read_bytes()[: len(journal.read_bytes()) - cut])
        known = known_rows(path, variants, ABOUT)
        assert sorted(known) == ([0, 3, 5, 7] if cut == 0 else [0, 3, 7])
        swept(path, variants, Processes(2), known=known)
        assert rows_in(path) == rows_in(tmp_path / "whole.parquet")


def test_failed_variants_run_again_and_others_do_not(tmp_path):
    variants = many(3)
    with table(tmp_path / "t.parquet", variants) as out:
        out.begin({})
        out.add(row_of(0, variants[0], {"error": "its process died"}))
        out.add(row_of(2, variants[2], slow(None, 2, variants[2])))
    assert sorted(known_rows(tmp_path / "t.parquet", variants, ABOUT)) == [2]


def test_a_design_may_grow_but_nothing_foreign_is_mixed_in(tmp_path):
    path = tmp_path / "t.parquet"
    swept(path, many(4), Processes(1))
    assert sorted(known_rows(path, many(6), ABOUT)) == [0, 1, 2, 3]
    with pytest.raises(InputError, match="which this sweep does not have"):
        known_rows(path, many(2), ABOUT)
    for name in ABOUT:
        with pytest.raises(InputError, match=f"another {name}"):
            known_rows(path, many(4), {**ABOUT, name: "x"})
    path.write_bytes(b"PAR1 nothing")
    with pytest.raises(InputError, match="no table of a sweep"):
        known_rows(path, many(4), ABOUT)


def test_a_folder_that_takes_no_more_does_not_end_the_sweep(tmp_path, monkeypatch):
    def all_rows():
        with table(tmp_path / "t.parquet", many(3)) as out:
            out.begin({})
            monkeypatch.setattr("pyarrow.parquet.write_table", full)
            for k, v in enumerate(many(3)):
                out.add(row_of(k, v, slow(None, k, v)))

    def full(*_):
        raise OSError(28, "No space")

    with pytest.raises(FailedError, match="No space"):
        all_rows()
    assert len(known_rows(tmp_path / "t.parquet", many(3), ABOUT)) == 3  # the journal holds them


# ---- the real thing ------------------------------------------------------------------------------------------------


def real(path, where, seeds=4):
    where = Where(output=path, **where)
    the = plan(CASE, (), TINY, Design(seeds=seeds), where)
    with table_of(the, where) as out:
        return run_sweep(the, where, out, Talk(QUIET))


def test_an_ensemble_on_a_dask_cluster_is_equal_to_the_last_bit(tmp_path):
    distributed = pytest.importorskip("distributed")
    here = real(tmp_path / "here.parquet", {"jobs": 2, "recordings": tmp_path / "r", "keep": frozenset({1})})
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        real(tmp_path / "there.parquet", {"scheduler": cluster.scheduler_address})
    assert rows_in(tmp_path / "there.parquet") == rows_in(tmp_path / "here.parquet")
    assert [row["error"] for row in here["variants"]] == [None] * 4
    assert len({row["fx_peak"] for row in here["variants"]}) > 1
    assert [p.name for p in (tmp_path / "r").iterdir()] == ["variant_00001.mcap"]
    resumed = real(tmp_path / "here.parquet", {"resume": True, "scheduler": "tcp://nowhere:1"})
    assert [row["fx_peak"] for row in resumed["variants"]] == [row["fx_peak"] for row in here["variants"]]


def test_features_of_a_row_are_those_of_its_recording(cosim, tmp_path):
    """Rates from the ledger as well."""
    case = "basin_2010_floe_165m"
    short = ["scenario.duration='6 s'", "sheet.nodes=[24,24]", "rubble.enabled=false", "fracture.cracks=open"]
    short.append("ice.tensile_strength='750 kPa'")
    where = Where(recordings=tmp_path / "r")
    the = plan(
        case, (), [*short, "ice.strength_field={variation=0.2,correlation_length='10 m'}"], Design(seeds=1), where
    )
    with table_of(the, where) as out:
        (row,) = run_sweep(the, where, out, Talk(QUIET))["variants"]
    assert row["error"] is None
    told = json.loads(cosim("compare", tmp_path / "r" / "variant_00000.mcap", "--json")[1])["features"]
    assert {f["name"]: f["simulated"] for f in told} == {
        name.removeprefix("feature_"): value for name, value in row.items() if name.startswith("feature_")
    }
    assert row["feature_first_encounter_fx"] > 1e6


def dies_once(study, number, variant):
    """A task whose process dies the first time."""
    mark = Path(study, str(number))
    if number == 1 and not mark.exists():
        mark.touch()
        os._exit(9)
    return {"fx_peak": float(number)}


def dies(study, number, variant):
    if number == 1:
        os._exit(9)
    return {"fx_peak": float(number)}


def kills_its_worker_once(study, number, variant):
    """A task with which the worker beside it dies the first time, as when its machine is taken away."""
    mark = Path(study, "killed")
    if number == 1 and not mark.exists():
        mark.touch()
        os.kill(os.getppid(), signal.SIGKILL)
    return {"fx_peak": float(number)}


def test_a_dead_worker_of_a_cluster_costs_nothing_and_a_deadly_task_its_row(tmp_path):
    distributed = pytest.importorskip("distributed")
    chosen = [Variant((("a.x", str(k)),)) for k in range(5)]
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        workers = cluster.scheduler_info["workers"].keys()

        def rows(task):
            done = sweep(str(tmp_path), chosen, Cluster(cluster.scheduler_address, 1), lambda row: None, task=task)
            return [row.get("fx_peak") for row in done], [row.get("error") for row in done]

        assert rows(dies_once) == ([0.0, 1.0, 2.0, 3.0, 4.0], [None] * 5)
        deadly = rows(dies)
        assert deadly[0] == [0.0, None, 2.0, 3.0, 4.0]
        assert deadly[1][1] == "no worker brought it to its end: its process died, exit 9"
        assert workers == cluster.scheduler_info["workers"].keys()
        assert rows(kills_its_worker_once) == ([0.0, 1.0, 2.0, 3.0, 4.0], [None] * 5)


def test_a_scheduler_that_is_not_there_is_one_line(tmp_path, monkeypatch):
    pytest.importorskip("distributed")
    monkeypatch.setattr("cosim.study.cluster.PATIENCE", 0.2)
    with pytest.raises(InputError, match="neither an address nor a file"):
        Cluster(str(tmp_path / "none.json"))
    with pytest.raises(FailedError, match="no scheduler answers") as error:
        list(Cluster("tcp://127.0.0.1:9").run([(0, Variant())], slow))
    assert "\n" not in str(error.value)


def test_a_seed_that_changes_nothing_is_pointed_out():
    def random(*overrides):
        return is_random(load_scenario(CASE, overrides))

    assert random(*TINY)
    assert not random(*TINY, "rubble.initial_volume='0 m^3'")
    assert not random(*TINY, "rubble.enabled=false")
    assert not random(*TINY, "rubble.enabled=false", "ice.modulus_field={variation=0.0}")
    assert random(*TINY, "rubble.enabled=false", "ice.modulus_field={variation=0.1}")


@pytest.mark.parametrize(
    ("options", "says"),
    [
        (("--seeds", "2", "--resume"), "--resume needs the table"),
        (("--seeds", "2", "--resume", "-o", "t.csv"), "--resume goes on with a .parquet"),
        (("--seeds", "2", "--keep", "1"), "--keep needs a folder"),
        (("--seeds", "2", "--keep", "1-x", "--recordings", "r"), "is no number of a variant"),
        (("--seeds", "2", "--keep", "2", "--recordings", "r"), "there are 2 variants"),
        (("--grid", "--design", "sobol", "--vary", "contact.friction=0.1..0.2"), "exclude each other"),
        ((), "nothing varies"),
    ],
)
def test_options_that_do_not_go_together_are_one_line(cosim, tmp_path, monkeypatch, options, says):
    monkeypatch.chdir(tmp_path)
    code, _, err = cosim("sweep", CASE, *options)
    assert (code, err.count("\n")) == (2, 1)
    assert says in err


def test_a_table_that_is_there_is_kept_unless_it_is_gone_on_with(cosim, tmp_path):
    path = tmp_path / "t.parquet"
    given = ("sweep", CASE, *(x for item in TINY for x in ("--set", item)), "-o", str(path), "-q")
    assert cosim(*given, "--seeds", "2")[0] == 0
    code, _, err = cosim(*given, "--seeds", "2")
    assert (code, "give --resume" in err) == (2, True)
    code, out, _ = cosim(*given, "--seeds", "3", "--resume", "--json")
    assert code == 0
    assert [row["seed"] for row in json.loads(out)["variants"]] == ["2018", "2019", "2020"]


def test_a_sweep_needs_no_dask(tmp_path):
    """The extra is asked for where it is used."""
    script = (
        "import sys\nsys.modules['distributed'] = None\nfrom cosim.cli.entry import main\n"
        f"main(['sweep', '{CASE}', '--seeds', '2', '--scheduler', 'tcp://127.0.0.1:9'])"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert "install the extra" in done.stderr
