"""Every kernel is compiled for one set of types: a second one would cost seconds at the start of a run, unseen."""

import subprocess
import sys
from pathlib import Path

RUN = """
import importlib, pkgutil, sys
from numba.core.registry import CPUDispatcher
sys.path.insert(0, sys.argv[1])
import rubble
from cone_scene import drive, filled
from rubble.snapshot import checkpoint
layer = filled()
drive(layer, 5)
layer, _ = checkpoint(layer)
drive(layer, 5)
for name in [m.name for m in pkgutil.walk_packages(rubble.__path__, "rubble.")]:
    for key, kernel in vars(importlib.import_module(name)).items():
        if isinstance(kernel, CPUDispatcher) and kernel.__module__ == name:
            print(name, key, len(kernel.signatures))
"""


def test_one_specialisation_of_each_kernel():
    root = Path(__file__).parents[2]
    command = [sys.executable, "-c", RUN, str(Path(__file__).parent)]
    done = subprocess.run(command, cwd=root, capture_output=True, text=True, check=True)
    found = [line.split() for line in done.stdout.splitlines()]
    assert len(found) > 30
    assert [line for line in found if int(line[2]) > 1] == []
    assert ["rubble.stepping", "advance_substeps", "1"] in found
