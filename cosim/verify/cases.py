"""`cosim verify`: the lattice against the tables and figures of van Vliet (2018), chapters 2 to 5 and appendices.

A case is a module with ``PARAMETERS`` and ``run(parameters, quick) -> CaseResult``; it is registered by its line below.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from types import ModuleType
from typing import Any

from threadpoolctl import threadpool_limits

from cosim.nearest import hint
from cosim.outputs import whole, writable
from cosim.verify import (
    cantilever,
    cone,
    dispersion,
    eigenfrequencies,
    envelope,
    floating,
    frequency_response,
    froude,
    l_beam,
    lock_in,
    mohr_plane,
    momentum,
    pile,
    poisson,
    pusher,
    slope,
    splitting,
    static_deflection,
    terminal_velocity,
    wedge,
)
from cosim.verify.case import CaseResult
from cosim.verify.cracks import (
    arch,
    beam_test,
    centre_crack,
    cone_breaking,
    first_encounter,
    friction,
    hinged_ring,
    narrow_cone,
    pressed_edge,
    spacing,
    thrust,
    wedge_beams,
)
from cosim.verify.settings import merged, parse

CASES: dict[str, ModuleType] = {
    "eigenfrequencies": eigenfrequencies,
    "static-deflection": static_deflection,
    "dispersion": dispersion,
    "frequency-response": frequency_response,
    "poisson": poisson,
    "envelope": envelope,
    "splitting": splitting,
    "cantilever": cantilever,
    "l-beam": l_beam,
    "froude": froude,
    "wedge": wedge,
    "float": floating,
    "slope": slope,
    "terminal-velocity": terminal_velocity,
    "cone": cone,
    "momentum": momentum,
    "pile": pile,
    "pusher": pusher,
    "mohr-plane": mohr_plane,
    "crack-thrust": thrust,
    "crack-friction": friction,
    "crack-arch": arch,
    "beam-test": beam_test,
    "wedge-beams": wedge_beams,
    "hinged-ring": hinged_ring,
    "centre-crack": centre_crack,
    "crack-spacing": spacing,
    "pressed-edge": pressed_edge,
    "cone-breaking": cone_breaking,
    "narrow-cone": narrow_cone,
    "first-encounter": first_encounter,
    "lock-in": lock_in,
}


def run(
    case: str | None = None,
    settings: Mapping[str, Any] | Iterable[str] | None = None,
    plots_dir: str | Path | None = None,
    quick: bool = False,
    done: Callable[[CaseResult, float], None] = lambda _result, _seconds: None,
) -> list[CaseResult]:
    """Run one case, or all; ``settings`` need a case. ValueError with one line for anything that cannot be run.

    ``done`` is called after each case with the wall time that it took [s].
    """
    changes = parse(settings)
    if case is None and changes:
        raise ValueError("--set needs a case: parameters belong to one case")
    if case is not None and case not in CASES:
        raise ValueError(f"unknown case {case!r}; {hint(case, CASES)}")
    if plots_dir is not None:
        Path(plots_dir).mkdir(parents=True, exist_ok=True)
    results = []
    for name in CASES if case is None else [case]:
        module, began = CASES[name], time.perf_counter()
        with threadpool_limits(1):  # small matrices: threads would cost ten times more than they give
            results.append(module.run(merged(name, module.PARAMETERS, changes), quick))
        if plots_dir is not None:
            save_figures(results[-1], Path(plots_dir))
        done(results[-1], time.perf_counter() - began)
    return results


def save_figures(result: CaseResult, folder: Path) -> list[Path]:
    """Draw the figures of a result as ``<case>_<figure>.png``."""
    from matplotlib.figure import Figure as Sheet  # slow to import

    folder.mkdir(parents=True, exist_ok=True)
    paths = []
    for figure in result.figures:
        sheet = Sheet(figsize=(9.0, 6.0), layout="constrained")
        figure.draw(sheet)
        sheet.suptitle(figure.title)
        paths.append(folder / f"{result.case}_{figure.name}.png")
        with whole(writable(paths[-1], ".png"), ".png") as part:
            sheet.savefig(part, dpi=110)
    return paths
