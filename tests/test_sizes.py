"""How large a room may be: lines of a file, lines of a function, values that a function takes.

A file has at most 250 lines. A function has at most 40, a kernel (decorated with `compiled` or `callback`) 60, counted
from its ``def`` to its last line; what is defined inside counts with it. A function takes at most 8 values, ``self``
and ``cls`` aside, and a call gives at most 8 by position: more are told apart by names, in a group or by keyword.
"""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PACKAGES = ("cosim", "coupling", "lattice", "rubble")
FILE, FUNCTION, KERNEL, VALUES = 250, 40, 60, 8
KERNELS = ("compiled", "callback")
SOURCES = sorted(file for package in PACKAGES for file in (ROOT / package).rglob("*.py"))


def is_kernel(node: ast.FunctionDef) -> bool:
    called = [d.func if isinstance(d, ast.Call) else d for d in node.decorator_list]
    return any(ast.unparse(name).split(".")[-1] in KERNELS for name in called)


def values(node: ast.FunctionDef | ast.AsyncFunctionDef) -> int:
    """Number of parameters, ``*more`` and ``**more`` as one each, without ``self`` and ``cls``."""
    a = node.args
    names = [p.arg for p in (*a.posonlyargs, *a.args, *a.kwonlyargs)]
    return len([name for name in names if name not in ("self", "cls")]) + (a.vararg is not None) + (a.kwarg is not None)


def too_large(source: str) -> set[str]:
    """What breaks the rule above: ``file``, ``function f``, ``values f``, ``call f``."""
    found = {"file"} if len(source.splitlines()) > FILE else set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            if node.end_lineno - node.lineno + 1 > (KERNEL if is_kernel(node) else FUNCTION):
                found.add(f"function {node.name}")
            if values(node) > VALUES:
                found.add(f"values {node.name}")
        elif isinstance(node, ast.Call) and len(node.args) > VALUES:
            found.add(f"call {ast.unparse(node.func)}")
    return found


@pytest.mark.parametrize("file", SOURCES, ids=lambda f: str(f.relative_to(ROOT)))
def test_nothing_is_too_large(file):
    assert too_large(file.read_text(encoding="utf-8")) == set()


LONG = "\n".join(f"    x{k} = {k}" for k in range(40))
NAMES = ", ".join(f"a{k}" for k in range(9))


@pytest.mark.parametrize(
    ("source", "what"),
    [
        ("x = 0\n" * 251, {"file"}),
        ("x = 0\n" * 250, set()),
        (f"def f():\n{LONG}", {"function f"}),
        (f"@compiled()\ndef f():\n{LONG}", set()),
        (f"@compiled()\ndef f():\n{LONG}\n{LONG}", {"function f"}),
        (f"class A:\n  def f(self):\n   def g():\n{LONG}", {"function f", "function g"}),
        (f"def f({NAMES}): ...", {"values f"}),
        (f"def f(self, {NAMES[4:]}): ...", set()),
        (f"def f(*, {NAMES}): ...", {"values f"}),
        (f"def f({NAMES[4:]}, **more): ...", {"values f"}),
        (f"a.f({NAMES})", {"call a.f"}),
        (f"f({NAMES[4:]}, x=0, y=1)", set()),
    ],
)
def test_what_is_too_large_is_found(source, what):
    assert too_large(source) == what
