"""No file imports itself again over others, whether at its top, inside a function or under TYPE_CHECKING.

An edge is what a source names: ``import a.b`` and ``from a.b import c`` lead to the file of ``a.b.c`` if there is one,
else to that of ``a.b``. The ``__init__`` of a package that is only passed through is no edge.
"""

from __future__ import annotations

import ast
from collections.abc import Mapping
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PACKAGES = ("cosim", "coupling", "lattice", "rubble")
#: cycles that are there still; one that is gone fails the test
KNOWN: set[frozenset[str]] = set()


def sources() -> dict[str, str]:
    """Text by dotted name of module; a package is its ``__init__``."""
    files = [file for package in PACKAGES for file in (ROOT / package).rglob("*.py")]
    return {dotted(file.relative_to(ROOT)): file.read_text(encoding="utf-8") for file in files}


def dotted(path: Path) -> str:
    parts = path.with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def targets(module: str, is_package: bool, source: str) -> set[str]:
    """Dotted names that a source asks for, the longest it may mean; relative ones made absolute."""
    names: set[str] = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            home = module.split(".") if is_package else module.split(".")[:-1]
            above = home[: len(home) - node.level + 1] if node.level else []
            base = ".".join([*above, *([node.module] if node.module else [])])
            names |= {f"{base}.{alias.name}" for alias in node.names}
    return names


def graph(texts: Mapping[str, str]) -> dict[str, set[str]]:
    """Modules that each module imports."""
    packages = {name.rpartition(".")[0] for name in texts}

    def file_of(name: str) -> str | None:
        while name and name not in texts:
            name = name.rpartition(".")[0]
        return name or None

    return {
        module: {found for name in targets(module, module in packages, text) if (found := file_of(name)) is not None}
        for module, text in texts.items()
    }


def cycles(edges: Mapping[str, set[str]]) -> set[frozenset[str]]:
    """Groups of modules that reach each other, and modules that import themselves."""

    def reached(start: str) -> set[str]:
        seen: set[str] = set()
        todo = list(edges[start])
        while todo:
            if (now := todo.pop()) not in seen:
                seen.add(now)
                todo += edges[now]
        return seen

    reach = {module: reached(module) for module in edges}
    return {frozenset(b for b in reach[a] if a in reach[b]) for a in edges if a in reach[a]}


def test_no_file_imports_itself_over_others():
    assert cycles(graph(sources())) == KNOWN


def test_the_graph_holds_what_is_there():
    """A resolver that finds nothing would find no cycle either."""
    edges = graph(sources())
    assert "cosim.scenario.loading" in edges["cosim.study.task"]  # inside a function
    assert "coupling.scheduler" in edges["cosim.build"]
    assert sum(map(len, edges.values())) > 200


@pytest.mark.parametrize(
    "planted",
    [
        {"p.a": "import p.b", "p.b": "import p.a"},
        {"p.a": "from p.b import f", "p.b": "def g():\n    from p import a"},
        {"p.a": "from p import b", "p.b": "if TYPE_CHECKING:\n    from p.a import A"},
        {"p.a": "import p.b", "p.b": "import q.c", "q.c": "from p.a import x"},
        {"p.a": "from . import b", "p.b": "from .a import x"},
        {"p": "from p.a import x", "p.a": "from p import y"},
        {"p.a": "import p.a"},
    ],
)
def test_a_planted_cycle_is_found(planted):
    everything = {**sources(), **planted}
    assert cycles(graph(everything)) - KNOWN == {frozenset(planted)}


def test_imports_one_way_are_none():
    assert cycles(graph({"p": "from p.a import x", "p.a": "from p.b import y", "p.b": "import numpy"})) == set()
