"""A checked scenario, ready to run."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from cosim.analysis.sustained import averaging_time
from cosim.scenario.model import ScenarioModel
from cosim.scenario.text import complete, to_toml
from cosim.scenario.variation import FIELDS


@dataclass(frozen=True)
class Scenario:
    """A checked scenario. Sections are attributes: ``scenario.ice.thickness`` [SI]."""

    name: str  #: of the folder or file, without path
    text: str  #: of the file, and of its base, as written, with their sources as comments
    raw: dict[str, Any]  #: parsed text with the overrides applied
    model: ScenarioModel
    overrides: tuple[str, ...] = ()
    folder: Path | None = None  #: where reference.toml may lie; never recorded
    warnings: tuple[str, ...] = ()

    def __getattr__(self, section: str) -> Any:
        if section in ScenarioModel.model_fields:
            return getattr(self.model, section)
        raise AttributeError(section)

    @property
    def title(self) -> str:
        """For people."""
        return self.model.scenario.title

    @property
    def seed(self) -> int:
        """Of every random number of the run."""
        return self.model.scenario.seed

    @property
    def duration_ns(self) -> int:
        """Simulated time [ns]."""
        duration: float = self.model.scenario.duration
        return round(duration * 1e9)

    @property
    def averaging(self) -> float:
        """Peaks are those of the mean load over this time [s]; see `cosim.analysis.sustained`."""
        given: float | None = self.model.recording.averaging
        return averaging_time(self.model.ice.thickness, self.model.water.gravity) if given is None else given

    @property
    def moment_point(self) -> tuple[float, float, float]:
        """Moments are told about this point; the waterline on the axis unless the scenario says another [m]."""
        given: tuple[float, float, float] | None = self.model.recording.moment_point
        return (0.0, 0.0, 0.0) if given is None else given

    @property
    def window_ns(self) -> int:
        """Length of the first time window [ns]."""
        window: float = self.model.coupling.window
        return round(window * 1e9)

    @property
    def substeps(self) -> int:
        """Sub-steps of the rubble in one time window."""
        substep: float = self.model.rubble.substep
        return self.window_ns // round(substep * 1e9)

    @property
    def named_files(self) -> list[tuple[str, str]]:
        """Keys that name files of places on the sheet or of pieces, and these files."""
        named = [(f"ice.{f}.file", field.file) for f in FIELDS if (field := getattr(self.ice, f)) is not None]
        named += [("sheet.broken", self.sheet.broken), ("rubble.pieces", self.rubble.pieces)]
        return [(key, name) for key, name in named if name]

    @property
    def inputs(self) -> list[Path]:
        """Files that a run of it reads, besides its own: none of them is written over, whatever is forced."""
        motion = self.structure.motion
        moved = [motion.file] if motion is not None and motion.file else []
        return [(self.folder or Path()) / name for name in (*(name for _, name in self.named_files), *moved)]

    def resolved_toml(self) -> str:
        """The scenario as it ran: overrides applied, every default written out. Loads to the same model."""
        return to_toml(complete(self.raw, self.model))
