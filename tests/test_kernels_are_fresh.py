"""A compiled kernel never outlives the sources that it was compiled from, those of kernels that it calls included."""

from __future__ import annotations

import ast
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numba
import numpy as np
import pytest

from lattice.compiled import compiled

ROOT = Path(__file__).parents[1]
COPIES = ("lattice", "rubble", "coupling")
DECORATORS = {"njit", "jit", "cfunc", "vectorize", "guvectorize"}  #: numba's own, with its own cache
INNER = "from {package}.compiled import {decorator}\n\n\n@{decorator}({options})\ndef weight():\n    return {value}\n"
OUTER = (
    "from {package}.compiled import {decorator}\nfrom {package}.inner import weight\n\n\n@{decorator}({options})\n"
    "def total(n):\n    return n * weight()\n"
)


def write(package: Path, value: float, *, keyed: bool) -> None:
    """A package of two kernels in two files, with the project's `compiled` or with numba's own cache."""
    package.mkdir(exist_ok=True)
    (package / "__init__.py").touch()
    shutil.copy(ROOT / "lattice" / "compiled.py", package / "compiled.py")
    words = {
        "package": package.name,
        "decorator": "compiled" if keyed else "njit",
        "options": '"float64()"' if keyed else '"float64()", cache=True',
        "value": value,
    }
    (package / "inner.py").write_text(INNER.format(**words))
    (package / "outer.py").write_text(OUTER.format(**words).replace("float64()", "float64(float64)"))


def run(package: Path) -> float:
    """What the outer kernel gives in a new process; without byte code, which does not see two edits in a second."""
    code = f"from {package.name}.outer import total; print(total(10.0))"
    done = subprocess.run(
        [sys.executable, "-B", "-c", code], cwd=package.parent, capture_output=True, text=True, check=True
    )
    return float(done.stdout)


def test_an_edit_of_an_inner_kernel_is_seen_by_the_outer_one(tmp_path):
    package = tmp_path / "ours"
    write(package, 2.0, keyed=True)
    assert run(package) == 20.0
    write(package, 3.0, keyed=True)
    assert run(package) == 30.0


def test_with_numbas_own_cache_it_is_not(tmp_path):
    """The wrong twin: the outer kernel, whose own file is unchanged, goes on with the old inner one."""
    package = tmp_path / "stale"
    write(package, 2.0, keyed=False)
    assert run(package) == 20.0
    (package / "inner.py").write_text((package / "inner.py").read_text().replace("2.0", "3.0"))
    assert run(package) == 20.0


#: `slices.strayed` calls `plates.times`: a plate that is not turned, cut at y = 0, with this anchor
STRAYED = """
import numpy as np
from rubble.plates import empty
from rubble.slices import CORNERS, Slices, strayed

zero, two, three = np.zeros(1, np.int64), np.zeros((1, CORNERS, 2)), np.zeros((1, CORNERS, 3))
anchor = np.array([[0.0, 2.0, 0.0]])
print(strayed(empty(1), Slices(zero, zero, zero, zero, np.zeros(1), anchor, zero, two, two, three), 0))
"""


def copied(tmp_path: Path, code: str) -> Callable[[], float]:
    """A copy of the rubble in a folder; gives what a new process there prints."""
    shutil.copytree(ROOT / "rubble", tmp_path / "rubble", ignore=shutil.ignore_patterns("__pycache__"))

    def run_there() -> float:
        done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True)
        return float(done.stdout)

    return run_there


def edit(file: Path, before: str, after: str) -> None:
    text = file.read_text()
    assert before in text
    file.write_text(text.replace(before, after))


def test_an_edit_in_a_copy_of_the_rubble_reaches_a_kernel_of_another_file(tmp_path):
    way = copied(tmp_path, STRAYED)
    assert way() == 2.0
    edit(tmp_path / "rubble" / "plates.py", "+ m[1, 1] * y", "+ 3.0 * m[1, 1] * y")
    assert way() == 6.0


#: a block that falls through the air for ten sub-steps; what the kick of its weight adds beside the work along its way
FALL = """
import numpy as np
from rubble.piece import Slab
from rubble.energy import energy_terms
from rubble.layer import RubbleLayer
from rubble.physics import RubblePhysics

layer = RubbleLayer(RubblePhysics(rho_w=1e-9), 1.0)
box = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
layer.add_block(0, Slab(box, np.array([0.0, 1.0]), np.ones(1), 900.0))
layer.advance(10)
print(energy_terms(layer)["stepping_loss"])
"""


@pytest.mark.slow
def test_an_edit_in_a_copy_of_the_rubble_reaches_the_compiled_loop_that_calls_it(tmp_path):
    """`stepping.advance_substeps`, unchanged, calls `books.book_step`: m (g dt)^2 / 2, then thrice it."""
    stepping = copied(tmp_path, FALL)
    gain = 10 * (9.81 * 0.005) ** 2 / 2 * 900.0
    assert stepping() == pytest.approx(-gain, rel=1e-9)
    before = "books.stepping += 0.5 * dt * total"
    edit(tmp_path / "rubble" / "books.py", before, before.replace("0.5", "1.5"))
    assert stepping() == pytest.approx(-3.0 * gain, rel=1e-9)


def test_what_a_kernel_is_called_with_by_kernels_is_compiled_once_and_not_for_python():
    """Numbers that stand in a call are numbers like all; the wrong twin is numba's own, which has a kernel for each."""

    def callee(x, k):
        return x[k]

    def caller_of(inner):
        return lambda x: inner(x, 0) + inner(x, 1) + inner(x, len(x) - 1)

    def names(dispatcher):
        return [str(signature[1]) for signature in dispatcher.signatures]

    ours, numbas = compiled()(callee), numba.njit(callee)
    x = np.arange(3.0)
    assert compiled()(caller_of(ours))(x) == numba.njit(caller_of(numbas))(x) == 3.0
    assert names(ours.inner) == ["int64"]
    assert names(numbas) == ["Literal[int](0)", "Literal[int](1)", "int64"]
    assert names(ours) == []
    assert ours(x, 2) == 2.0
    assert names(ours) == ["int64"]


@pytest.mark.parametrize("package", COPIES)
def test_the_copies_are_equal(package):
    assert (ROOT / package / "compiled.py").read_bytes() == (ROOT / "lattice" / "compiled.py").read_bytes()


def test_teams_are_equal_but_for_the_package():
    """Of lattice and rubble."""
    own, other = ((ROOT / package / "team.py").read_text(encoding="utf-8") for package in ("lattice", "rubble"))
    assert own != other
    assert own.replace("lattice", "rubble") == other


def test_every_kernel_is_compiled_this_way():
    for package in (*COPIES, "cosim"):
        for file in (ROOT / package).rglob("*.py"):
            if file.name == "compiled.py":
                continue
            for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
                names = [alias.name for alias in node.names] if isinstance(node, ast.ImportFrom | ast.Import) else []
                assert not {"njit", "jit", "cfunc", "vectorize", "guvectorize"} & set(names), (
                    f"{file}: use {package}.compiled"
                )


def test_old_folders_go(tmp_path, monkeypatch):
    from lattice import compiled

    monkeypatch.setattr(compiled.config, "CACHE_DIR", str(tmp_path / "cache"))
    package = tmp_path / "thing"
    package.mkdir()
    seen = []
    for k in range(6):
        (package / "a.py").write_text(f"x = {k}\n")
        seen.append(compiled.cache_folder(package))
    assert len(set(seen)) == 6
    assert sum(folder.is_dir() for folder in seen) == compiled.KEPT + 1
    assert seen[-1].is_dir()
    assert compiled.cache_folder(package) == seen[-1]


def test_a_package_that_cannot_be_written_keeps_its_kernels_with_the_user(tmp_path, monkeypatch):
    from lattice import compiled

    monkeypatch.setattr(compiled.config, "CACHE_DIR", "")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    package = tmp_path / "thing"
    package.mkdir()
    assert compiled.cache_folder(package).parent == package / "__pycache__"
    shutil.rmtree(package / "__pycache__")
    (package / "__pycache__").touch()  # root may write to every folder, but not into a file
    assert compiled.cache_folder(package).parent == tmp_path / "cache" / "brash" / "thing"
    shutil.rmtree(tmp_path / "cache")
    (tmp_path / "cache").touch()
    assert compiled.cache_folder(package) is None


def test_where_nothing_can_be_written_all_works_with_one_note(tmp_path):
    for name in ("one", "two"):
        write(tmp_path / name, 2.0, keyed=True)
        (tmp_path / name / "__pycache__").touch()
    (tmp_path / "cache").touch()
    environment = {k: v for k, v in os.environ.items() if k != "NUMBA_CACHE_DIR"}
    done = subprocess.run(
        [sys.executable, "-c", "import one.outer, two.outer; print(one.outer.total(10.0) + two.outer.total(1.0))"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=True,
        env={**environment, "XDG_CACHE_HOME": str(tmp_path / "cache")},
    )
    assert float(done.stdout) == 22.0
    assert done.stderr.count("\n") == 1
    assert "compiled kernels are not kept, every run compiles anew: set NUMBA_CACHE_DIR" in done.stderr
