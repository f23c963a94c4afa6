"""What mkdocs asks of this project: the scenario reference from the models, and pictures from ``scenarios/``.

A page that holds `CHANNELS_MARKER` gets the table of what a recording holds. A page that holds `MARKER` gets in its
place one table for each section of a scenario file. Keys, units, defaults and limits are those of the models; meanings
are the comments ``#:`` that stand beside the fields. A key without a meaning is an error of the build.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from cosim.recording import channels
from cosim.scenario.keys import kinds_of, meanings, model_of, range_of, sections, unit_of
from cosim.scenario.model import ScenarioModel

MARKER = "<!-- scenario reference -->"
CHANNELS_MARKER = "<!-- channels -->"
HEAD = "| key | unit | written as | default | meaning |\n|---|---|---|---|---|\n"
ROOT = Path(__file__).parents[1]


def on_files(files: Any, config: Any) -> Any:
    """Pictures lie beside their scenarios and are taken from there, so that each is kept once."""
    from mkdocs.structure.files import File

    for picture in sorted(ROOT.glob("scenarios/*/*.png")):
        place = picture.relative_to(ROOT).as_posix()
        files.append(File.generated(config, place, abs_src_path=str(picture)))
    return files


def on_page_markdown(markdown: str, page: Any, **_: Any) -> str:
    """Fills in the reference; paths to ``scenarios/``, right in the checkout, become those of the site."""
    if MARKER in markdown:
        markdown = markdown.replace(MARKER, reference(ScenarioModel))
    markdown = markdown.replace(CHANNELS_MARKER, channels.table())
    up = "../" * page.file.src_uri.count("/")
    return re.sub(r"\]\((?:\.\./)+scenarios/", f"]({up}scenarios/", markdown)


def reference(model: type[BaseModel]) -> str:
    """Markdown of all sections of a model, in the order of the file."""
    return "\n\n".join(_section(name, section) for name, section in sections(model))


def _section(name: str, model: type[BaseModel]) -> str:
    about = re.sub(r"^\[[\w.]+\]\s*", "", " ".join((model.__doc__ or "").split()))
    about = about[:1].upper() + about[1:]
    words = meanings(model)
    rows = []
    for key, field in model.model_fields.items():
        if model_of(field.annotation) is not None:
            continue
        if not words.get(key):
            raise ValueError(f"scenario key {name}.{key} has no meaning: write a comment #: beside it in {model}")
        unit = unit_of(field)
        words_of_key = re.sub(r"\s*\[[^\]]*\]$", "", words[key]) if unit else words[key]
        cells = (f"`{key}`", unit.si if unit else "-", _value(field), _default(field), _cell(words_of_key))
        rows.append("| " + " | ".join(cells) + " |\n")
    return f"## [{name}]\n\n{about}\n\n{HEAD}{''.join(rows)}"


def _value(field: FieldInfo) -> str:
    """What may be written: number with unit, words, limits."""
    unit = unit_of(field)
    shown = [f"`{unit.written}`"] if unit else [f"`{part}`" if _is_toml(part) else part for part in kinds_of(field)]
    limits = range_of(field)
    return " or ".join(shown) + (f", {limits}" if limits else "")


def _is_toml(part: str) -> bool:
    return part[0] in '"[' or part in ("true", "false")


def _default(field: FieldInfo) -> str:
    if field.is_required():
        return "**required**"
    if field.default is None or field.default == "":
        return "-"
    unit = unit_of(field)
    if unit is not None:
        return f"{field.default:g} {unit.si}"
    return f"`{field.default!r}`".replace("'", '"').replace("True", "true").replace("False", "false")


def _cell(text: str) -> str:
    return text.replace("|", "\\|")
