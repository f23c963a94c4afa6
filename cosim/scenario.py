"""Scenarios: a TOML file, read strictly, becomes a frozen `Scenario` with SI floats.

Nothing is silently repaired. Whatever is wrong is one `ScenarioError` with one line: file, key, value, what to do.

    >>> scenario = load_scenario("scenarios/van_vliet_2018_floe_165m", ["coupling.window=20 ms"])
    >>> scenario.ice.thickness, scenario.window_ns
    (3.0, 20000000)
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

from pydantic import ValidationError, model_validator

from cosim.scenario_baseline import Baseline
from cosim.scenario_errors import ScenarioError, explain
from cosim.scenario_sections import (
    Case,
    Contact,
    Coupling,
    Drift,
    Fracture,
    Ice,
    Recording,
    Rubble,
    Section,
    Sheet,
    Structure,
    Water,
    fault,
    nearest_multiples,
)
from cosim.scenario_text import complete, to_toml

__all__ = ["Scenario", "ScenarioError", "find_scenarios", "load_scenario"]


class ScenarioModel(Section):
    """All sections of a scenario and the checks that span them."""

    scenario: Case
    ice: Ice
    water: Water
    sheet: Sheet
    structure: Structure
    contact: Contact
    drift: Drift
    fracture: Fracture = Fracture.model_validate({})
    rubble: Rubble = Rubble.model_validate({})
    coupling: Coupling = Coupling.model_validate({})
    recording: Recording = Recording.model_validate({})
    baseline: Baseline = Baseline.model_validate({})

    @model_validator(mode="after")
    def _times_are_whole_multiples(self) -> Self:
        window = self.coupling.window
        _whole("coupling.window", window, "rubble sub-step", self.rubble.substep)
        for bound in ("shortest_window", "longest_window"):
            if (value := getattr(self.coupling, bound)) is not None:
                _whole(f"coupling.{bound}", value, "rubble sub-step", self.rubble.substep)
        _whole("scenario.duration", self.scenario.duration, "time window", window)
        _whole("recording.every", self.recording.every, "time window", window)
        return self

    @model_validator(mode="after")
    def _upward_breaking_can_run(self) -> Self:
        draft, toe = self.ice.thickness * self.ice.density / self.water.density, self.structure.toe_depth
        if self.structure.breaking == "downward":
            return self
        if toe is not None and toe <= draft:
            raise fault("structure.toe_depth", f"the ice passes under the slope; use more than its draft {draft:g} m")
        if self.rubble.initial_volume > 0.0:
            raise fault(
                "rubble.initial_volume",
                "initial rubble settles under the sheet, before a downward-breaking "
                'structure; start an upward-breaking one without: "0 m^3"',
            )
        return self

    @model_validator(mode="after")
    def _ice_floats(self) -> Self:
        if self.ice.density >= self.water.density:
            raise fault("ice.density", f"this ice sinks; use less than the water's {self.water.density:g} kg/m^3")
        return self


def _whole(key: str, value: float, name: str, step: float) -> None:
    nearest = nearest_multiples(value, step)
    if nearest:
        shown = " or ".join(f"{t * 1e3:g} ms" if t < 1 else f"{t:g} s" for t in nearest)
        raise fault(key, f"not a whole multiple of the {name} {step * 1e3:g} ms; nearest: {shown}")


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
        return self.model.scenario.title

    @property
    def seed(self) -> int:
        return self.model.scenario.seed

    @property
    def duration_ns(self) -> int:
        return round(self.model.scenario.duration * 1e9)

    @property
    def window_ns(self) -> int:
        return round(self.model.coupling.window * 1e9)

    @property
    def substeps(self) -> int:
        """Sub-steps of the rubble in one time window."""
        return self.window_ns // round(self.model.rubble.substep * 1e9)

    def resolved_toml(self) -> str:
        """The scenario as it ran: overrides applied, every default written out. Loads to the same model."""
        return to_toml(complete(self.raw, self.model))


def load_scenario(path: str | Path, overrides: Iterable[str] = ()) -> Scenario:
    """Read a scenario folder, a TOML file, or a shipped scenario by name; ``overrides`` are ``a.b=v`` texts."""
    file = _locate(path)
    text, raw = _read(file)
    overrides = tuple(overrides)
    overridden = {_apply(raw, item) for item in overrides}
    try:
        model = ScenarioModel.model_validate(raw)
    except ValidationError as error:
        raise ScenarioError(explain(error, ScenarioModel, str(file), raw, overridden)) from None
    name = file.parent.name if file.name == "scenario.toml" else file.stem
    return Scenario(name, text, raw, model, overrides, file.parent, _warnings(model))


def find_scenarios(folders: Sequence[str | Path] = ()) -> list[Path]:
    """Scenario folders in ``folders``; default ``scenarios`` here and beside the package."""
    homes = [Path(f) for f in folders] or [Path("scenarios"), Path(__file__).parents[1] / "scenarios"]
    found = {file.parent.resolve() for home in homes for file in home.glob("*/scenario.toml")}
    return sorted(found, key=lambda folder: folder.name)


def _read(file: Path, inner: tuple[Path, ...] = ()) -> tuple[str, dict[str, Any]]:
    """Text and tables of a file on top of those of its ``base``, a path beside it: for what cases have in common."""
    if file.resolve() in inner:
        raise ScenarioError(f"{file}: is its own base; leave the key base out of one of the files")
    try:
        text = file.read_text(encoding="utf-8")
        raw = tomllib.loads(text)
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ScenarioError(f"{file}: not valid TOML: {error}; correct that line") from None
    base = raw.pop("base", None)
    if base is None:
        return text, raw
    under = file.parent / base if isinstance(base, str) else file
    if not isinstance(base, str) or not under.is_file():
        raise ScenarioError(f"{file}: base = {base!r} is no file; give a path from the folder of this file")
    common, table = _read(under, (*inner, file.resolve()))
    return f"{common}\n# ---- {file.name} ----\n{text}", _merged(table, raw)


def _merged(under: dict[str, Any], over: dict[str, Any]) -> dict[str, Any]:
    """Tables of ``under`` with the keys of ``over`` in their place."""
    out = dict(under)
    for key, value in over.items():
        old = out.get(key)
        out[key] = _merged(old, value) if isinstance(old, dict) and isinstance(value, dict) else value
    return out


def _locate(path: str | Path) -> Path:
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


def _apply(raw: dict[str, Any], item: str) -> str:
    """Set one ``a.b=v`` in the parsed file; returns the key. ``v`` is read as TOML, else taken as a string."""
    key, equals, text = item.partition("=")
    parts = key.strip().split(".")
    if not equals or len(parts) < 2 or not all(parts):
        raise ScenarioError(f"--set {item}: not of the form section.key=value; for example --set ice.thickness='2 m'")
    try:
        value = tomllib.loads(f"v = {text}")["v"]
    except tomllib.TOMLDecodeError:
        value = text.strip()
    table = raw
    for part in parts[:-1]:
        table = table.setdefault(part, {})
        if not isinstance(table, dict):
            raise ScenarioError(f"--set {item}: {part} is a value and not a section; remove the last part of the key")
    table[parts[-1]] = value
    return ".".join(parts)


def _warnings(model: ScenarioModel) -> tuple[str, ...]:
    nu = model.ice.poisson_ratio
    if nu < 1 / 3 - 1e-9:
        return (
            f"ice.poisson_ratio = {nu:g} is below 1/3: in-plane shear springs resist rigid rotation, "
            "so that a turning floe is strained; use 1/3 unless this is what you study",
        )
    return ()
