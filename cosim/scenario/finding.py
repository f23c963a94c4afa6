"""Where scenarios lie: in a folder, in a file, or shipped with the project by name."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from cosim.scenario.errors import ScenarioError


def find_scenarios(folders: Sequence[str | Path] = ()) -> list[Path]:
    """Scenario folders in ``folders``; default ``scenarios`` here and beside the package."""
    homes = [Path(f) for f in folders] or [Path("scenarios"), Path(__file__).parents[2] / "scenarios"]
    found = {file.parent.resolve() for home in homes for file in home.glob("*/scenario.toml")}
    return sorted(found, key=lambda folder: folder.name)


def locate(path: str | Path) -> Path:
    """The file of a scenario that is named by folder, file or name; ScenarioError if there is none."""
    file = Path(path)
    if not file.exists() and len(file.parts) == 1:
        file = next((p for p in find_scenarios() if p.name == file.name), file)
    if file.is_dir():
        file = file / "scenario.toml"
    if not file.is_file():
        raise ScenarioError(
            f"{file}: no such scenario; give a folder with scenario.toml or a TOML file "
            "(`cosim list` shows what is here)"
        )
    return file
