"""A new scenario with its comments: a file that runs, and tells what each of its lines means.

The comments are those of the models. What is not written has its default: `cosim keys` lists them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from cosim.scenario.errors import ScenarioError
from cosim.scenario.files import is_file, parse_toml, read_toml
from cosim.scenario.finding import locate
from cosim.scenario.keys import keys_of
from cosim.scenario.loading import load_scenario
from cosim.scenario.model import ScenarioModel
from cosim.scenario.text import value_text

SCHEMA = "scenario.schema.json"  #: beside the file, for editors
COMMON: dict[str, Any] = {
    "ice.thickness": "0.8 m",
    "ice.density": "900 kg/m^3",
    "ice.youngs_modulus": "5 GPa",
    "ice.poisson_ratio": 0.3333333333333333,
    "ice.flexural_strength": "500 kPa",
    "ice.compressive_strength": "2.5 MPa",
    "ice.material_damping": "1 ms",
    "water.density": "1025 kg/m^3",
}
MET: dict[str, Any] = {
    "contact.model": "crushing",
    "contact.strength": "2.5 MPa",
    "contact.friction": 0.1,
    "drift.velocity": "0.3 m/s",
    "rubble.friction_structure": 0.1,
    "recording.every": "0.5 s",
}
CONE: dict[str, Any] = {
    "scenario.title": "Upward-breaking cone",
    "scenario.duration": "30 s",
    **COMMON,
    "sheet.length": "60 m",
    "sheet.width": "60 m",
    "sheet.nodes": [41, 41],
    "sheet.back": "held",
    "sheet.sides": "held",
    "structure.kind": "cone",
    "structure.breaking": "upward",
    "structure.slope": "55 deg",
    "structure.waterline_radius": "5 m",
    "structure.neck_radius": "2 m",
    "structure.toe_depth": "4 m",
    "structure.top": "6 m",
    **MET,
}
SLOPE: dict[str, Any] = {
    "scenario.title": "Downward-breaking slope",
    "scenario.duration": "30 s",
    **COMMON,
    "sheet.length": "72 m",
    "sheet.width": "18 m",
    "sheet.nodes": [61, 16],
    "sheet.back": "held",
    "sheet.sides": "roller",
    "structure.kind": "plane",
    "structure.breaking": "downward",
    "structure.slope": "45 deg",
    "structure.toe_depth": "12 m",
    "structure.top": "4 m",
    **MET,
}
HEAD = """#:schema ./{schema}
# {title}
#
# Every value stands with its unit, as text: "0.8 m" or "80 cm". What is left out has its default; `cosim keys` lists
# all keys with meaning, unit, range and default. With this folder as DIR: `cosim check DIR`, then
# `cosim run DIR -o run.mcap`, `cosim info run.mcap`, `cosim report run.mcap -o report.html`.

"""


def scenario_text(values: Mapping[str, Any]) -> str:
    """A scenario file of these values by key, each line with the meaning of its key."""
    meaning = {key.name: key.about for key in keys_of(ScenarioModel)}
    lines: list[str] = []
    section = ""
    for name, value in sorted(values.items(), key=lambda item: list(meaning).index(item[0])):
        table, _, key = name.rpartition(".")
        if table != section:
            lines.append(f"{'' if not lines else chr(10)}[{table}]")
            section = table
        lines.append(f"{key} = {value_text(value)}  # {meaning[name]}")
    return HEAD.format(schema=SCHEMA, title=values["scenario.title"]) + "\n".join(lines) + "\n"


def copied_texts(name: str) -> dict[str, str]:
    """The files of a scenario by name, ready to be changed: itself and the reference beside it."""
    file = locate(name)
    texts = {"scenario.toml": _copied(file)}
    reference = file.parent / "reference.toml"
    if is_file(reference):
        texts["reference.toml"] = read_toml(reference, ScenarioError)[0]
    return texts


def _copied(file: Path) -> str:
    """The text of a scenario; of one that stands on a base as one file."""
    scenario = load_scenario(file)
    if "base" not in parse_toml(file.read_text("utf-8-sig"), str(file), ScenarioError):
        return f"#:schema ./{SCHEMA}\n" + scenario.text
    return scenario_text(dict(_leaves(scenario.raw)))


def _leaves(table: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    for key, value in table.items():
        if isinstance(value, Mapping):
            yield from _leaves(value, f"{prefix}{key}.")
        else:
            yield prefix + key, value
