"""The load as a prescribed series for OpenFAST: seven columns, time, FX, FY, FZ, MX, MY, MZ.

The file is what ``PrescribedForcesFile`` of a structural control input (StC) names: OpenFAST documentation, ServoDyn,
"Structural Control: Prescribed Time Series", and its ``ExampleFiles/PrescribedForce.txt``. Lines that begin with one of
``#!%`` are comments, values between two rows are interpolated linearly. The StC file has ``PrescribedForcesCoord`` 1
(global), its place ``StC_P_X, _Y, _Z`` at the point of the moments, and the ``StC_DOF_MODE`` of a prescribed series,
which is 4 until OpenFAST 4 and 6 from OpenFAST 5 on.

OpenFAST's global frame has X downwind, Y to the left of it and Z up: loads are those of ice that drifts downwind.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from cosim.analysis.run_data import MOMENT_AXES, RunData
from cosim.errors import InputError
from coupling.interface import NS

BEGIN = "# Brash: load of ice on a structure"  #: first line of every file
COLUMNS = ("Time", "FX", "FY", "FZ", "MX", "MY", "MZ")


def series(run: RunData) -> np.ndarray:
    """(n, 7): middles of the windows [s], where means stand when rows are interpolated; forces [N], moments [N m]."""
    if run.moment is None:
        raise InputError(f"{run.name}: holds no moments; run the scenario again")
    moments = np.stack([run.component(name) for name in MOMENT_AXES], axis=1)
    return np.column_stack(((run.t_ns + run.begin_ns) / (2 * NS), run.load.sum(axis=1), moments))


def write_openfast(run: RunData, out: Path) -> None:
    """The series, with what an StC file has to say in its head."""
    x, y, z = run.moment_point
    head = [
        BEGIN,
        f"# {run.metadata['title']}; version {run.metadata['version']}, commit {run.metadata['commit']}",
        "# prescribed force and moment series for an OpenFAST StC input file: PrescribedForcesCoord 1 (global),",
        "# StC_DOF_MODE 4 until OpenFAST 4, 6 from OpenFAST 5 on; X is the drift direction of the ice, Z is up",
        f"# moments are about x = {x:g}, y = {y:g}, z = {z:g} m, z = 0 still water; times are middles of windows",
        "# " + ", ".join(COLUMNS),
        "# (s), (N), (N), (N), (N-m), (N-m), (N-m)",
    ]
    rows = (" ".join(f"{value:.9e}" for value in row) for row in series(run))
    with out.open("w", encoding="utf-8", newline="\n") as file:
        file.write("\n".join((*head, *rows)) + "\n")
