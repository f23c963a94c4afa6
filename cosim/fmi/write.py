"""`cosim fmu`: a case as an FMU for co-simulation, FMI 2.0 or 3.0.

The FMU holds the resolved scenario and the files that it names, and runs in a Python that has this program (extra
``fmi``): it is a way into other simulations, no program of its own.
"""

from __future__ import annotations

import shutil
import sys
import tempfile
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from cosim.errors import InputError
from cosim.scenario.scenario import Scenario

#: the script inside, by version of FMI
SCRIPTS = {2: Path(__file__).with_name("brash_ice.py"), 3: Path(__file__).with_name("brash_ice_3.py")}
SINGLE = "canBeInstantiatedOnlyOncePerProcess"


def write_fmu(scenario: Scenario, out: Path, version: int = 2) -> None:
    """Writes it. InputError for a case that moves its own structure, another version, or without the extra ``fmi``."""
    if version not in SCRIPTS:
        raise InputError(f"FMI {version}: give one of {', '.join(map(str, SCRIPTS))}")
    motion = scenario.structure.motion
    if motion is not None and motion.moves:
        raise InputError("structure.motion: the motion of the structure comes from the other side; remove it")
    with tempfile.TemporaryDirectory() as folder:
        script = Path(folder) / SCRIPTS[version].name
        shutil.copy(SCRIPTS[version], script)
        text = Path(folder) / "scenario.toml"
        text.write_text(scenario.resolved_toml(), encoding="utf-8")
        with _tidy(folder, script.stem):
            try:
                made = _build(version, script, Path(folder) / "fmu", [text, *_files(scenario)])
            except ImportError:
                raise InputError(
                    "writing an FMU needs pythonfmu and pythonfmu3: pip install 'brash-ice[fmi]'"
                ) from None
        _copy(made, out)


def _build(version: int, script: Path, folder: Path, files: list[Path]) -> Path:
    """Has the FMU built into a folder."""
    if version == 2:
        from pythonfmu import FmuBuilder

        two: dict[str, Any] = {"canGetAndSetFMUstate": True, SINGLE: False}
        folder.mkdir()
        return Path(FmuBuilder.build_FMU(script, folder, files, None, None, **two))
    from pythonfmu3 import FmuBuilder as Builder

    three = {"canGetAndSetFMUState": True, SINGLE: False, "canHandleVariableCommunicationStepSize": True}
    return Path(Builder.build_FMU(script, folder, files, **three))


def _copy(made: Path, out: Path) -> None:
    """Without the sources of the library inside: FMI 3.0 wants a description of how to build them."""
    with zipfile.ZipFile(made) as whole, zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as part:
        for entry in whole.infolist():
            if not entry.filename.startswith("sources/"):
                part.writestr(entry.filename, whole.read(entry))


@contextmanager
def _tidy(folder: str, module: str) -> Iterator[None]:
    """Takes back what the builder leaves in this process: a folder to import from, and what came from it."""
    try:
        yield
    finally:
        sys.path[:] = [place for place in sys.path if place != folder]
        sys.modules.pop(module, None)


def _files(scenario: Scenario) -> list[Path]:
    """Files that the scenario names, which lie beside it."""
    names = [name for _, name in scenario.named_files]
    for name in names:
        if Path(name).name != name:
            raise InputError(f"{name}: a file of an FMU must lie beside the scenario; move it there")
    return [(scenario.folder or Path()) / name for name in names]
