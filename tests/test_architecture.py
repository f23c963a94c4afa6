"""Imports point one way. Read from the source with ast, so that an import inside a function counts too."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PACKAGES = ("cosim", "coupling", "lattice", "rubble")
#: package -> packages of ours that it may import; the two ports are the exception below
ALLOWED = {
    "lattice": {"lattice"},
    "rubble": {"rubble"},
    "coupling": {"coupling"},
    "cosim": {"cosim", "coupling", "lattice", "rubble"},
}
PORTS = {"coupling/sheet_port/": {"lattice"}, "coupling/rubble_port/": {"rubble"}}
#: library -> the only files that may import it
LIBRARIES = {
    "mcap": {f"cosim/recording/{name}.py" for name in ("writer", "reader", "records", "recover", "retrace")},
    "zstandard": {"cosim/recording/records.py"},
    "mcap_protobuf": {"cosim/recording/writer.py"},
    "rerun": {f"cosim/show/{name}.py" for name in ("replay", "follow", "layout", "viewer")},
    "pyvista": {"cosim/export/vtk.py", "cosim/show/view3d.py"},
    "xarray": {"cosim/export/netcdf.py", "cosim/api/run.py"},
    "rerun_cli": {"cosim/show/viewer.py"},
    "fmpy": {"cosim/fmi/structure.py"},
    "pythonfmu": {"cosim/fmi/brash_ice.py", "cosim/fmi/write.py"},
    "pythonfmu3": {"cosim/fmi/brash_ice_3.py", "cosim/fmi/write.py"},
}
SOLVER_LIBRARIES = {"pymunk": "rubble", "typer": "cosim", "rich": "cosim", "pydantic": "cosim", "pint": "cosim"}
SOURCES = sorted(file for package in PACKAGES for file in (ROOT / package).rglob("*.py"))


def imported(source: str) -> set[str]:
    """Dotted names of everything that a source imports, also ``from a import b`` as ``a.b``."""
    names: set[str] = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            names |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
    return names


def roots(source: str) -> set[str]:
    return {name.split(".")[0] for name in imported(source)}


def forbidden(path: str, source: str) -> set[str]:
    """What a file of ours imports against the rules."""
    used, package = roots(source), path.split("/")[0]
    allowed = ALLOWED[package] | {solver for port, own in PORTS.items() if path.startswith(port) for solver in own}
    bad = {name for name in used & set(PACKAGES) if name not in allowed}
    bad |= {name for name, files in LIBRARIES.items() if name in used and path not in files}
    return bad | {name for name, home in SOLVER_LIBRARIES.items() if name in used and package != home}


@pytest.mark.parametrize("file", SOURCES, ids=lambda f: str(f.relative_to(ROOT)))
def test_imports_point_one_way(file):
    assert not forbidden(file.relative_to(ROOT).as_posix(), file.read_text(encoding="utf-8"))


@pytest.mark.parametrize(
    ("path", "source"),
    [
        ("lattice/engine.py", "import rubble.section"),
        ("lattice/engine.py", "from coupling.interface import Frame"),
        ("rubble/layer.py", "def f():\n    from lattice import sheet"),
        ("coupling/scheduler.py", "import lattice"),
        ("coupling/sheet_port/port.py", "import rubble"),
        ("coupling/structure/plane.py", "import rubble"),
        ("cosim/analysis/compare.py", "import mcap.reader"),
        ("cosim/cli/recordings.py", "def f():\n    import rerun as rr"),
        ("lattice/engine.py", "import pymunk"),
    ],
)
def test_a_wrong_import_is_found(path, source):
    assert forbidden(path, source)


def test_only_the_command_line_exits():
    for file in SOURCES:
        text = file.read_text(encoding="utf-8")
        if file.relative_to(ROOT).as_posix() != "cosim/cli/entry.py":
            assert "SystemExit" not in text, file
            assert "sys.exit" not in text, file


def test_tests_have_no_packages():
    assert not list((ROOT / "tests").rglob("__init__.py"))
