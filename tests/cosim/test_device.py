"""[fracture].device: the explicit engine on a graphics card, or one line why not."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from cosim import build_engine
from cosim.errors import InputError
from cosim.scenario.loading import load_scenario
from lattice.explicit.engine import ExplicitEngine

CASE = "van_vliet_2018_floe_165m"
CARD = ("fracture.device='cuda'", "fracture.propagation='dynamic'")
#: two windows of a coarse floe in the simulator of the card, and on the host
RUN = """
import sys
from cosim.build import build
from cosim.checkpoint.graph import graph_of
from cosim.scenario.loading import load_scenario
states = []
for device in ("cuda", "cpu"):
    case = load_scenario(sys.argv[1], [*sys.argv[2:], f"fracture.device='{device}'"])
    scheduler = build(case)
    print(type(scheduler.sheet.sheet.engine).__name__)
    for _ in range(2):
        scheduler.macro_step()
    graph_of(scheduler)  # a checkpoint keeps it
    states.append(scheduler.sheet.sheet.state.u)
card, host = states
assert abs(host).max() > 0.0
assert abs(card - host).max() < 1e-12 * abs(host).max()
"""


@pytest.mark.parametrize(
    ("overrides", "says"),
    [
        (["fracture.propagation='quasi-static'"], "set fracture.propagation = 'dynamic'"),
        (["fracture.cracks='closing'"], "set fracture.cracks = 'open'"),
        (["fracture.device='gpu'"], "'cpu' or 'cuda'"),
    ],
)
def test_what_the_card_cannot_is_refused_at_load_in_one_line(overrides, says):
    with pytest.raises(InputError, match=says) as error:
        load_scenario(CASE, [*CARD, *overrides])
    assert "\n" not in str(error.value)


def test_without_the_extra_or_a_card_one_line_says_so(monkeypatch):
    assert load_scenario(CASE).fracture.device == "cpu"
    assert build_engine.explicit_engine("cpu") is ExplicitEngine
    monkeypatch.setattr(build_engine, "find_spec", lambda name: None)
    with pytest.raises(InputError, match=r"pip install 'brash-ice\[gpu\]'"):
        build_engine.explicit_engine("cuda")
    monkeypatch.undo()
    pytest.importorskip("numba_cuda")
    from numba import cuda

    monkeypatch.setattr(cuda, "is_available", lambda: False)
    with pytest.raises(InputError, match="no card of NVIDIA"):
        build_engine.explicit_engine("cuda")


def test_a_scenario_runs_on_the_card():
    pytest.importorskip("numba_cuda")
    short = ("rubble.enabled=false", "sheet.nodes=[9,9]", "ice.beam_test.width='12 m'", "ice.material_damping='0 s'")
    short += ("coupling.window='1 ms'", "rubble.substep='1 ms'", "water.current=['1 m/s','0.5 m/s']")
    env = {**os.environ, "NUMBA_ENABLE_CUDASIM": "1", "PYTHONPATH": str(Path(__file__).parents[2])}
    command = [sys.executable, "-c", RUN, CASE, *short, CARD[1]]
    done = subprocess.run(command, env=env, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == ["CardEngine", "ExplicitEngine"]
