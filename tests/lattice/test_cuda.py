"""The explicit engine on a card: in numba's simulator against the host, and compiled for a card that is not there."""

import json
import os
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

pytest.importorskip("numba_cuda")

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def told():
    env = {**os.environ, "NUMBA_ENABLE_CUDASIM": "1", "PYTHONPATH": str(ROOT)}
    script = Path(__file__).with_name("on_card.py")
    done = subprocess.run([sys.executable, script], env=env, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_the_card_breaks_the_same_cells_and_lets_the_same_pieces_go(told):
    host, card = told["cells"]
    assert len(host) > 5
    assert card == host
    assert told["left"][0] == told["left"][1] != []


def test_the_card_gives_the_numbers_of_the_host(told):
    """State, energy, forces and times to 1e-12 of the largest: the order of a sum is all that differs."""
    assert max(told["apart"].values()) < 1e-12
    assert min(told["twin"].values()) > 1e-11, "a sheet whose water damps 1e-4 more is told apart"


@pytest.mark.skipif(find_spec("nvidia") is None, reason="no compiler for cards: it comes with the extra gpu")
def test_kernels_compile_for_a_card(monkeypatch):
    """To the card's assembly, typed as the engine calls them; the simulator runs what no card would take."""
    from numba import cuda, typeof
    from numba.cuda import dispatcher

    from lattice.cuda import kernels as k
    from lattice.explicit.layout import HalfSprings, Intact, Motion, Pace, PerNode
    from lattice.explicit.screen import Screen

    ampere = 8, 0
    monkeypatch.setattr(dispatcher, "get_current_device", lambda: SimpleNamespace(compute_capability=ampere))
    one, two, three, whole = *(np.zeros((1,) * n) for n in (1, 2, 3)), np.zeros(1, np.int64)
    of_nodes, pace = PerNode(two, two, two), Pace(*[1.0] * 4)
    lattice = k.Lattice(Intact(two, two), of_nodes, two, two, Screen(1.0, two), HalfSprings(*[1.0] * 8), pace)
    motion, entries = Motion(three, three), k.Entries(whole, whole, two, one, two)
    calls = {
        k.move: (1, whole, motion, three, three, 1, lattice),
        k.overloaded: (1, whole, motion, lattice),
        k.push: (1, whole, motion, lattice, entries, k.Order(whole, whole)),
    }
    for kernel, arguments in calls.items():
        assembly, _ = cuda.compile_ptx(kernel.py_func, tuple(map(typeof, arguments)), cc=ampere)
        assert "f64" in assembly
        assert "call" not in assembly.replace(".callprototype", ""), "all is one kernel"
