"""How many small faults do the tests notice? Mutants of the four packages' main files, made by cosmic-ray.

    uv run --with cosmic-ray python tests/benchmarks/mutants.py [--per-file 6] [--seed 10] [--only PART] [--again JSON]

The sources are copied to a scratch folder; each mutant is put into a file there, and the few fast tests run that
exercise this file (`FILES`). Of every place of a file one mutant is taken, and of these a random sample. Left out:
annotations, decorators, messages of errors, which no test should pin, and operators of whole numbers put between
floats, which no program survives. ``--again`` runs the survivors of a result
once more, after tests were added.

A mutant in a file with kernels is compiled anew (or runs as plain Python where its kernels allow that, ``plain``). The
others take the kernels of the unchanged sources, which they cannot change.
"""

from __future__ import annotations

import argparse
import ast
import json
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[2]
PACKAGES = ("cosim", "lattice", "rubble", "coupling")


class Main(NamedTuple):
    """A main file and the tests that exercise it."""

    file: str
    tests: str
    plain: bool = False  #: its kernels run as plain Python
    most: int = 99  #: mutants, where each is dear


FILES = (
    Main("lattice/ice.py", "lattice/test_ice.py verification/test_failure_criteria.py"),
    Main("lattice/grid.py", "lattice/test_fragments.py lattice/test_strain.py lattice/test_fronts.py"),
    Main("lattice/fragments.py", "lattice/test_fragments.py"),
    Main("lattice/strain.py", "lattice/test_strain.py verification/test_failure_criteria.py", plain=True),
    Main("lattice/criteria/laws.py", "verification/test_failure_criteria.py lattice/test_criteria.py"),
    Main("lattice/criteria/mohr.py", "verification/test_failure_criteria.py", plain=True),
    Main("lattice/criteria/crack_tips.py", "lattice/test_criteria.py lattice/test_crack_tips.py"),
    Main("lattice/assembly.py", "lattice/test_fronts.py verification/test_plate_on_water.py"),
    Main("lattice/stiffness.py", "verification/test_plate_on_water.py verification/test_failure_criteria.py"),
    Main("lattice/contact.py", "lattice/test_contact_height.py coupling/test_front.py"),
    Main("lattice/implicit/step.py", "lattice/test_engine.py lattice/test_sheet.py"),
    Main("lattice/floe.py", "lattice/test_sheet.py lattice/test_loads.py"),
    Main("lattice/sheet.py", "lattice/test_sheet.py lattice/test_loads.py"),
    Main("coupling/contact.py", "coupling/test_contact.py"),
    Main("coupling/contact_friction.py", "coupling/test_energy.py lattice/test_contact_height.py"),
    Main("coupling/ledger.py", "coupling/test_scheduler.py coupling/test_handover.py"),
    Main("coupling/scheduler.py", "coupling/test_scheduler.py coupling/test_steering.py coupling/test_schemes.py"),
    Main("coupling/schemes.py", "coupling/test_schemes.py coupling/test_scheduler.py"),
    Main("coupling/steering.py", "coupling/test_steering.py"),
    Main("coupling/sheet_port/crushed_edge.py", "coupling/test_edge.py"),
    Main("coupling/sheet_port/front.py", "coupling/test_front.py coupling/test_handover.py"),
    Main("coupling/sheet_port/yielding.py", "coupling/test_yielding.py"),
    Main("coupling/structure/revolved.py", "coupling/test_structure.py coupling/test_contact.py", plain=True),
    Main("coupling/rubble_port/births.py", "coupling/test_handover.py"),
    Main("rubble/geometry.py", "rubble/test_geometry.py", plain=True),
    Main("rubble/prism.py", "rubble/test_water.py"),
    Main("rubble/block.py", "rubble/test_water.py rubble/test_crushing.py rubble/test_layer.py"),
    Main("rubble/physics.py", "rubble/test_water.py rubble/test_backfill.py cosim/test_build.py", most=4),
    Main("rubble/cut.py", "rubble/test_facets.py rubble/test_phases.py", most=3),
    Main("rubble/phases.py", "rubble/test_phases.py", most=4),
    Main("rubble/pressure.py", "rubble/test_pressure.py", most=5),
    Main("rubble/water.py", "rubble/test_water.py", most=4),
    Main("rubble/friction.py", "rubble/test_friction.py rubble/test_facets.py", most=4),
    Main("rubble/initial.py", "rubble/test_initial.py"),
    Main("rubble/layer.py", "rubble/test_layer.py rubble/test_contacts.py"),
    Main("cosim/build.py", "cosim/test_build.py"),
    Main("cosim/scenario/units.py", "cosim/test_units.py cosim/test_scenario.py"),
    Main("cosim/scenario/coupling.py", "cosim/test_scenario.py"),
    Main("cosim/analysis/peaks.py", "cosim/test_peaks.py"),
    Main("cosim/analysis/instants.py", "cosim/test_compare.py cosim/test_cycles.py"),
    Main("cosim/analysis/cycles.py", "cosim/test_cycles.py"),
    Main("cosim/analysis/features.py", "cosim/test_compare.py cosim/test_cycles.py"),
    Main("cosim/analysis/sustained.py", "cosim/test_sustained.py"),
    Main("cosim/baselines/croasdale.py", "baselines/test_formulas.py"),
    Main("cosim/baselines/ralston.py", "baselines/test_formulas.py"),
)


def main() -> None:
    """Runs the sample and prints one line per mutant, then the score."""
    ask = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    ask.add_argument("--per-file", type=int, default=6)
    ask.add_argument("--seed", type=int, default=10)
    ask.add_argument("--only", default="", help="files whose path holds this")
    ask.add_argument("--again", type=Path, help="a result whose survivors are run once more")
    ask.add_argument("-o", "--output", type=Path, default=Path("mutants.json"))
    a = ask.parse_args()
    before = json.loads(a.again.read_text()) if a.again else None
    wanted = {(r["file"], r["operator"], r["occurrence"]) for r in before or () if r["survived"]}
    results = []
    with tempfile.TemporaryDirectory() as folder:
        here = _copy(Path(folder) / "sources")
        for main_file in FILES:
            if a.only in main_file.file and (before is None or any(w[0] == main_file.file for w in wanted)):
                results += _judge_file(here, main_file, a, wanted if before is not None else None)
                a.output.write_text(json.dumps(results, indent=1))
    _report(results)


def _copy(here: Path) -> Path:
    """The files under version control, with the kernels that are compiled already."""
    names = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout.split()
    for name in names:
        if (ROOT / name).is_file():
            (here / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, here / name)
    return here


def _judge_file(here: Path, m: Main, a: argparse.Namespace, wanted: set[tuple[str, str, int]] | None) -> list[dict]:
    from cosmic_ray.work_db import WorkDB, use_db
    from cosmic_ray.work_item import WorkerOutcome, WorkResult

    tests = [f"tests/{t}" for t in m.tests.split() if (here / "tests" / t).exists()]
    source, stamp = here / m.file, (here / m.file).stat()
    command = f"{sys.executable} tests/benchmarks/mutants_judge.py {m.file} {int(m.plain)} {' '.join(tests)}"
    if subprocess.run(command.split(), cwd=here, env=_environment(here), capture_output=True).returncode:
        raise SystemExit(f"{m.file}: its tests fail on the unchanged sources: {command}")
    config, session = here / "mutants.toml", here / "mutants.sqlite"
    config.write_text(
        f'[cosmic-ray]\nmodule-path = "{m.file}"\ntimeout = 180.0\nexcluded-modules = []\n'
        f'test-command = "{command}"\n[cosmic-ray.distributor]\nname = "local"\n'
    )
    session.unlink(missing_ok=True)
    cosmic_ray = [sys.executable, "-m", "cosmic_ray.cli"]
    subprocess.run([*cosmic_ray, "init", str(config), str(session)], cwd=here, check=True, capture_output=True)
    with use_db(session, WorkDB.Mode.open) as db:
        items = list(db.work_items)
        taken = _sample(items, source, m, a) if wanted is None else _same(items, m, wanted)
        for item in items:
            if item.job_id not in taken:
                db.set_result(item.job_id, WorkResult(WorkerOutcome.SKIPPED))
    start = time.time()
    subprocess.run([*cosmic_ray, "exec", str(config), str(session)], cwd=here, check=True, env=_environment(here))
    os.utime(source, ns=(stamp.st_atime_ns, stamp.st_mtime_ns))
    out = []
    with use_db(session, WorkDB.Mode.open) as db:
        lines = source.read_text().splitlines()
        found = dict(db.results)
        for item in items:
            if item.job_id in taken:
                out.append(_row(item, found[item.job_id], lines, m))
                print(_line(out[-1]), flush=True)
    print(f"  {m.file}: {time.time() - start:.0f} s", flush=True)
    return out


def _sample(items: list, source: Path, m: Main, a: argparse.Namespace) -> set[str]:
    """Of every place one mutant at random, then a random sample of these."""
    rng, out_of_bounds = random.Random(f"{a.seed} {m.file}"), _left_out(source)
    groups: dict[tuple, list] = {}
    for item in items:
        mutation = item.mutations[0]
        kind, *change = mutation.operator_name.split("/")[1].split("_")
        crude = kind == "ReplaceBinaryOperator" and change[-1] not in ("Add", "Sub", "Mul", "Div")
        if kind != "RemoveDecorator" and not crude and mutation.start_pos[0] not in out_of_bounds:
            groups.setdefault((*mutation.start_pos, kind), []).append(item)
    one = [rng.choice(groups[key]) for key in sorted(groups)]
    return {item.job_id for item in rng.sample(one, min(len(one), a.per_file, m.most))}


def _same(items: list, m: Main, wanted: set[tuple[str, str, int]]) -> set[str]:
    return {i.job_id for i in items if (m.file, i.mutations[0].operator_name, i.mutations[0].occurrence) in wanted}


def _left_out(source: Path) -> set[int]:
    """Lines of annotations and of errors that are raised."""
    lines: set[int] = set()
    for node in ast.walk(ast.parse(source.read_text())):
        notes = []
        if isinstance(node, ast.FunctionDef):
            arguments = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]
            notes = [n for n in (node.returns, *(g.annotation for g in arguments)) if n is not None]
        elif isinstance(node, ast.AnnAssign):
            notes = [node.annotation] if node.value is None else []
        elif isinstance(node, ast.Raise):
            notes = [node]
        for n in notes:
            lines.update(range(n.lineno, (n.end_lineno or n.lineno) + 1))
    return lines


def _row(item, result, lines: list[str], m: Main) -> dict:
    mutation = item.mutations[0]
    line = mutation.start_pos[0]
    return {
        "file": m.file,
        "operator": mutation.operator_name,
        "occurrence": mutation.occurrence,
        "line": line,
        "column": mutation.start_pos[1],
        "text": lines[line - 1].strip(),
        "diff": [d for d in (result.diff or "").splitlines() if d[:1] in "+-" and d[:3] not in ("+++", "---")],
        "survived": result.test_outcome is not None and result.test_outcome.value == "survived",
    }


def _line(r: dict) -> str:
    word = "SURVIVED" if r["survived"] else "noticed "
    return f"{word} {r['file']}:{r['line']} {r['operator'].split('/')[1]}: {' => '.join(d.strip() for d in r['diff'])}"


def _report(results: list[dict]) -> None:
    for package in (*PACKAGES, ""):
        of = [r for r in results if r["file"].startswith(package)]
        noticed = sum(not r["survived"] for r in of)
        if of:
            print(f"{package or 'all':9s} {noticed} of {len(of)} noticed, {noticed / len(of):.0%}")


def _environment(here: Path) -> dict[str, str]:
    return {
        **os.environ,
        "PYTHONPATH": str(here),
        "PYTHONDONTWRITEBYTECODE": "1",
        "MUTANTS_KERNELS": str(here / "kernels"),
    }


if __name__ == "__main__":
    main()
