"""How many small faults do the tests notice? Mutants of the four packages' main files, made by cosmic-ray.

    uv run --with cosmic-ray python tests/benchmarks/mutants.py [--per-file 3] [--seed 10] [--only PART] [--again JSON]

The sources are copied to a scratch folder; each mutant is put into a file there, and the few fast tests run that
exercise this file (`FILES`). Of every place of a file one mutant is taken, and of these a random sample. Left out:
annotations, decorators, messages of errors, which no test should pin, and operators of whole numbers put between
floats, which no program survives. ``--again`` runs the survivors of a result once
more, after tests were added.

A mutant in a file with kernels is compiled anew (or runs as plain Python where its kernels allow that, ``plain``). The
others take the kernels of the unchanged sources, which they cannot change.
"""

from __future__ import annotations

import argparse
import ast
import importlib
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

import numba  # and three more, loaded once: each mutant is judged in a fork of this process
import pydantic  # noqa: F401
import pymunk  # noqa: F401
import pytest
import scipy.sparse.linalg  # noqa: F401
from cosmic_ray.commands.init import _all_work_items
from cosmic_ray.mutating import use_mutation
from cosmic_ray.plugins import get_operator

ROOT = Path(__file__).parents[2]
PACKAGES = ("cosim", "lattice", "rubble", "coupling")
LONGEST = 120  #: of the tests of one mutant; one that hangs is noticed [s]


class Main(NamedTuple):
    """A main file and the tests that exercise it."""

    file: str
    tests: str
    plain: bool = False  #: its kernels run as plain Python
    most: int = 99  #: mutants, where each is dear


FILES = (
    Main("lattice/ice.py", "lattice/test_ice.py verification/test_failure_criteria.py"),
    Main("lattice/grid.py", "lattice/test_grid.py lattice/test_fragments.py"),
    Main("lattice/fragments.py", "lattice/test_fragments.py"),
    Main("lattice/strain.py", "lattice/test_strain.py verification/test_failure_criteria.py", plain=True),
    Main("lattice/criteria/laws.py", "verification/test_failure_criteria.py lattice/test_criteria.py"),
    Main("lattice/criteria/mohr.py", "verification/test_failure_criteria.py", plain=True),
    Main("lattice/criteria/crack_tips.py", "lattice/test_crack_tips.py"),
    Main("lattice/assembly.py", "lattice/test_fronts.py verification/test_plate_on_water.py"),
    Main("lattice/stiffness.py", "verification/test_plate_on_water.py verification/test_failure_criteria.py"),
    Main("lattice/contact.py", "lattice/test_contact_height.py coupling/test_front.py"),
    Main("lattice/implicit/step.py", "lattice/test_engine.py lattice/test_sheet.py"),
    Main("lattice/floe.py", "lattice/test_sheet.py lattice/test_loads.py"),
    Main("lattice/sheet.py", "lattice/test_sheet.py lattice/test_loads.py"),
    Main("coupling/contact.py", "coupling/test_contact.py"),
    Main("coupling/contact_friction.py", "coupling/test_energy.py lattice/test_contact_height.py"),
    Main("coupling/ledger.py", "coupling/test_ledger.py"),
    Main("coupling/scheduler.py", "coupling/test_scheduler.py coupling/test_steering.py coupling/test_schemes.py"),
    Main("coupling/schemes.py", "coupling/test_schemes.py coupling/test_scheduler.py"),
    Main("coupling/steering.py", "coupling/test_steering.py"),
    Main("coupling/sheet_port/crushed_edge.py", "coupling/test_edge.py"),
    Main("coupling/sheet_port/front.py", "coupling/test_front.py coupling/test_handover.py"),
    Main("coupling/sheet_port/yielding.py", "coupling/test_yielding.py"),
    Main("coupling/structure/revolved.py", "coupling/test_structure.py coupling/test_contact.py", plain=True),
    Main("coupling/rubble_port/births.py", "coupling/test_handover.py"),
    Main("rubble/geometry.py", "rubble/test_geometry.py", plain=True),
    Main("rubble/prism.py", "rubble/test_prism.py rubble/test_water.py"),
    Main("rubble/block.py", "rubble/test_prism.py rubble/test_water.py rubble/test_crushing.py"),
    Main("rubble/physics.py", "rubble/test_physics.py"),
    Main("rubble/cut.py", "rubble/test_cut.py", most=3),
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
    ask.add_argument("--per-file", type=int, default=3)
    ask.add_argument("--seed", type=int, default=10)
    ask.add_argument("--only", default="", help="files whose path holds this")
    ask.add_argument("--again", type=Path, help="a result whose survivors are run once more")
    ask.add_argument("-o", "--output", type=Path, default=Path("mutants.json"))
    a = ask.parse_args()
    results: list[dict] = json.loads(a.again.read_text()) if a.again else []
    survivors = {(r["file"], r["operator"], r["occurrence"]) for r in results if r["survived"]}
    results = [r for r in results if not r["survived"]]
    with tempfile.TemporaryDirectory() as folder:
        here = _copy(Path(folder) / "sources")
        os.chdir(here)
        for m in FILES:
            wanted = {w for w in survivors if w[0] == m.file} if a.again else None
            if a.only in m.file and wanted != set():
                results += _judge_file(here, m, a, wanted)
                (ROOT / a.output).write_text(json.dumps(results, indent=1))
    _report(results)


def _copy(here: Path) -> Path:
    """The files under version control."""
    names = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout.split()
    for name in names:
        if (ROOT / name).is_file():
            (here / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, here / name)
    return here


def _judge_file(here: Path, m: Main, a: argparse.Namespace, wanted: set[tuple[str, str, int]] | None) -> list[dict]:
    source, start = here / m.file, time.time()
    stamp, lines = source.stat(), source.read_text().splitlines()
    if not _pass(here, m):
        raise SystemExit(f"{m.file}: its tests fail on the unchanged sources ({m.tests})")
    every = [i.mutations[0] for i in _all_work_items([Path(m.file)], {})]
    taken = (
        _sample(every, source, m, a)
        if wanted is None
        else [x for x in every if (m.file, x.operator_name, x.occurrence) in wanted]
    )
    out = []
    for mutation in taken:
        with use_mutation(source, get_operator(mutation.operator_name)(**mutation.operator_args), mutation.occurrence):
            changed = source.read_text().splitlines()
            out.append(_row(mutation, lines, changed, survived=_pass(here, m), m=m))
            print(_line(out[-1]), flush=True)
        os.utime(source, ns=(stamp.st_atime_ns, stamp.st_mtime_ns))
    print(f"  {m.file}: {time.time() - start:.0f} s", flush=True)
    return out


def _sample(every: list, source: Path, m: Main, a: argparse.Namespace) -> list:
    """Of every place one mutant at random, then a random sample of these."""
    rng, out_of_bounds = random.Random(f"{a.seed} {m.file}"), _left_out(source)
    groups: dict[tuple, list] = {}
    for mutation in every:
        kind, *change = mutation.operator_name.split("/")[1].split("_")
        crude = kind == "ReplaceBinaryOperator" and not {*change} <= {"Add", "Sub", "Mul", "Div", "Pow"}
        if kind != "RemoveDecorator" and not crude and mutation.start_pos[0] not in out_of_bounds:
            groups.setdefault((*mutation.start_pos, kind), []).append(mutation)
    one = [rng.choice(groups[key]) for key in sorted(groups)]
    return rng.sample(one, min(len(one), a.per_file, m.most))


def _left_out(source: Path) -> set[int]:
    """Lines of annotations, of decorators and of errors that are raised."""
    lines: set[int] = set()
    for node in ast.walk(ast.parse(source.read_text())):
        notes: list = []
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            lines.update(n.lineno for n in node.decorator_list)
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


def _pass(here: Path, m: Main) -> bool:
    """Whether the tests of a file pass on the sources as they are now, in a process of their own."""
    child = os.fork()
    if child == 0:
        os.setsid()
        signal.alarm(LONGEST)
        quiet = os.open(os.devnull, os.O_WRONLY)
        os.dup2(quiet, 1)
        os.dup2(quiet, 2)
        os._exit(_tests(here, m))
    return os.waitpid(child, 0)[1] == 0


def _tests(here: Path, m: Main) -> int:
    sys.path.insert(0, str(here))
    sys.dont_write_bytecode, numba.config.DISABLE_JIT = True, int(m.plain)
    package, kept = m.file.split("/")[0], here / "kernels"
    has_kernels = any(f"@{word}(" in (here / m.file).read_text() for word in ("compiled", "callback"))
    if not has_kernels and package != "cosim" and (kept / package).exists():
        shutil.copytree(kept / package, _kernels(here, package), dirs_exist_ok=True)
    code = int(pytest.main(["-q", "-x", "-p", "no:cacheprovider", *(f"tests/{t}" for t in m.tests.split())]))
    if code == 0:
        for name in ("lattice", "rubble", "coupling"):
            if name != package or not has_kernels:
                shutil.copytree(_kernels(here, name), kept / name, dirs_exist_ok=True)
    return code


def _kernels(here: Path, package: str) -> Path:
    return importlib.import_module(f"{package}.compiled").cache_folder(here / package)


def _row(mutation, lines: list[str], changed: list[str], *, survived: bool, m: Main) -> dict:
    line = mutation.start_pos[0]
    new = [c.strip() for b, c in zip(lines, changed, strict=False) if b != c]
    return {
        "file": m.file,
        "operator": mutation.operator_name,
        "occurrence": mutation.occurrence,
        "line": line,
        "old": lines[line - 1].strip(),
        "new": new[0] if new else "",
        "survived": survived,
    }


def _line(r: dict) -> str:
    word = "SURVIVED" if r["survived"] else "noticed "
    return f"{word} {r['file']}:{r['line']}  {r['old']}  =>  {r['new']}"


def _report(results: list[dict]) -> None:
    for package in (*PACKAGES, ""):
        of = [r for r in results if r["file"].startswith(package)]
        noticed = sum(not r["survived"] for r in of)
        if of:
            print(f"{package or 'all':9s} {noticed} of {len(of)} noticed, {noticed / len(of):.0%}")


if __name__ == "__main__":
    main()
