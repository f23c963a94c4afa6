"""Where scenarios lie: in a folder, in a file, or shipped with the project by name."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from cosim.scenario.errors import ScenarioError

HERE = Path("scenarios")
PACKAGE = Path(__file__).parents[1]


def shipped() -> Path:
    """The folder of the project's own scenarios: in the package where it is installed, beside it in a checkout."""
    inside = PACKAGE / "shipped"
    return inside if inside.is_dir() else PACKAGE.parent / "scenarios"


def find_scenarios(folders: Sequence[str | Path] = ()) -> list[Path]:
    """Scenario folders in ``folders``, sorted by name; default ``./scenarios``, then those of the project.

    Of two of the same name the one in the earlier folder is found.
    """
    found: dict[str, Path] = {}
    for home in [Path(f) for f in folders] or [HERE, shipped()]:
        for file in home.glob("*/scenario.toml"):
            found.setdefault(file.parent.name, file.parent.resolve())
    return [found[name] for name in sorted(found)]


def locate(path: str | Path) -> Path:
    """The file of a scenario that is named by folder, file or name; ScenarioError if there is none.

    A folder or file of that name comes first, then ``./scenarios``, then the scenarios of the project.
    """
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
