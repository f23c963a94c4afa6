"""`cosim fmu`: a case as an FMU for co-simulation, FMI 2.0.

The FMU holds the resolved scenario and the files that it names, and runs in a Python that has this program (extra
``fmi``): it is a way into other simulations, no program of its own.
"""

from __future__ import annotations

import shutil
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from cosim.errors import InputError
from cosim.scenario.scenario import Scenario

SCRIPT = Path(__file__).with_name("brash_ice.py")


def write_fmu(scenario: Scenario, out: Path) -> None:
    """Writes it. InputError for a case that moves its own structure, or without the extra ``fmi``."""
    try:
        from pythonfmu import FmuBuilder
    except ImportError:
        raise InputError("writing an FMU needs pythonfmu: pip install 'brash-ice[fmi]'") from None
    motion = scenario.structure.motion
    if motion is not None and motion.moves:
        raise InputError("structure.motion: the motion of the structure comes from the other side; remove it")
    with tempfile.TemporaryDirectory() as folder:
        script = Path(folder) / SCRIPT.name
        shutil.copy(SCRIPT, script)
        text = Path(folder) / "scenario.toml"
        text.write_text(scenario.resolved_toml(), encoding="utf-8")
        options: dict[str, Any] = {"canGetAndSetFMUstate": True, "canBeInstantiatedOnlyOncePerProcess": False}
        with _tidy(folder):
            FmuBuilder.build_FMU(script, out, [text, *_files(scenario)], None, None, **options)


@contextmanager
def _tidy(folder: str) -> Iterator[None]:
    """Takes back what the builder leaves in this process: a folder to import from, and what came from it."""
    try:
        yield
    finally:
        sys.path[:] = [place for place in sys.path if place != folder]
        sys.modules.pop(SCRIPT.stem, None)


def _files(scenario: Scenario) -> list[Path]:
    """Files that the scenario names, which lie beside it."""
    names = [name for _, name in scenario.named_files]
    for name in names:
        if Path(name).name != name:
            raise InputError(f"{name}: a file of an FMU must lie beside the scenario; move it there")
    return [(scenario.folder or Path()) / name for name in names]
