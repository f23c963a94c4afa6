"""What mkdocs asks of this project: the scenario reference from the models, and pictures from ``scenarios/``.

A page that holds `MARKER` gets in its place one table for each section of a scenario file. Keys, units, defaults and
limits are those of the models; meanings are the comments ``#:`` that stand beside the fields. A key without a meaning
is an error of the build.
"""

from __future__ import annotations

import ast
import inspect
import re
import types
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from cosim.scenario.model import ScenarioModel
from cosim.scenario.units import Unit

MARKER = "<!-- scenario reference -->"
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
    up = "../" * page.file.src_uri.count("/")
    return re.sub(r"\]\((?:\.\./)+scenarios/", f"]({up}scenarios/", markdown)


def reference(model: type[BaseModel]) -> str:
    """Markdown of all sections of a model, in the order of the file."""
    return "\n\n".join(_section(name, section) for name, section in sections(model))


def sections(model: type[BaseModel], prefix: str = "") -> Iterator[tuple[str, type[BaseModel]]]:
    """Every table of a scenario file: its name and its model."""
    for name, field in model.model_fields.items():
        inner = _model_of(field.annotation)
        if inner is not None:
            yield prefix + name, inner
            yield from sections(inner, f"{prefix}{name}.")


def _model_of(annotation: Any) -> type[BaseModel] | None:
    for kind in (annotation, *get_args(annotation)):
        if isinstance(kind, type) and issubclass(kind, BaseModel):
            return kind
    return None


def _section(name: str, model: type[BaseModel]) -> str:
    about = re.sub(r"^\[[\w.]+\]\s*", "", " ".join((model.__doc__ or "").split()))
    about = about[:1].upper() + about[1:]
    words = meanings(model)
    rows = []
    for key, field in model.model_fields.items():
        if _model_of(field.annotation) is not None:
            continue
        if not words.get(key):
            raise ValueError(f"scenario key {name}.{key} has no meaning: write a comment #: beside it in {model}")
        unit = _unit(field)
        words_of_key = re.sub(r"\s*\[[^\]]*\]$", "", words[key]) if unit else words[key]
        cells = (f"`{key}`", unit.si if unit else "-", _value(field), _default(field), _cell(words_of_key))
        rows.append("| " + " | ".join(cells) + " |\n")
    return f"## [{name}]\n\n{about}\n\n{HEAD}{''.join(rows)}"


@cache
def meanings(model: type[BaseModel]) -> dict[str, str]:
    """The comments ``#:`` at the end of a field's line and on the lines before it, by field."""
    lines = inspect.getsource(model).splitlines()
    tree = ast.parse("\n".join(lines))
    body = tree.body[0]
    assert isinstance(body, ast.ClassDef)
    found = {}
    for item in body.body:
        if isinstance(item, ast.AnnAssign) and isinstance(item.target, ast.Name) and item.end_lineno:
            first = item.lineno - 1
            while lines[first - 1].strip().startswith("#:"):
                first -= 1
            texts = [line.partition("#:")[2] for line in lines[first : item.end_lineno]]
            found[item.target.id] = " ".join(" ".join(texts).split())
    return found


def _value(field: FieldInfo) -> str:
    """What may be written: number with unit, words, limits."""
    unit = _unit(field)
    if unit is not None:
        return f"`{unit.written}`"
    words = [w for kind in _flat(field.annotation) if get_origin(kind) is Literal for w in get_args(kind)]
    kinds = [k for k in _flat(field.annotation) if get_origin(k) is not Literal and k is not type(None)]
    shown = [f'`"{w}"`' for w in words] + [_kind(k) for k in kinds]
    limits = _limits(field)
    return " or ".join(shown) + (f", {limits}" if limits else "")


def _flat(annotation: Any) -> list[Any]:
    """The members of a union, without their annotations."""
    if get_origin(annotation) is Annotated:
        return _flat(get_args(annotation)[0])
    if get_origin(annotation) in (Union, types.UnionType):
        return [kind for part in get_args(annotation) for kind in _flat(part)]
    return [annotation]


def _kind(kind: Any) -> str:
    if get_origin(kind) is tuple:
        return "`[60, 60]`"
    return {bool: "`true` or `false`", int: "whole number", float: "number", str: "text"}.get(kind, str(kind))


def _constraints(field: FieldInfo) -> list[Any]:
    """Of the field and of the members of its union."""
    inner = [
        m
        for part in (field.annotation, *get_args(field.annotation))
        if get_origin(part) is Annotated
        for m in get_args(part)[1:]
    ]
    nested = [n for m in (*field.metadata, *inner) for n in getattr(m, "metadata", [m])]
    return nested


def _limits(field: FieldInfo) -> str:
    signs = {"ge": ">=", "gt": ">", "le": "<=", "lt": "<"}
    return " and ".join(
        f"{signs[name]} {getattr(c, name):g}" for c in _constraints(field) for name in signs if hasattr(c, name)
    )


def _unit(field: FieldInfo) -> Unit | None:
    return next((m for m in _constraints(field) if isinstance(m, Unit)), None)


def _default(field: FieldInfo) -> str:
    if field.is_required():
        return "**required**"
    if field.default is None or field.default == "":
        return "-"
    unit = _unit(field)
    if unit is not None:
        return f"{field.default:g} {unit.si}"
    return f"`{field.default!r}`".replace("'", '"').replace("True", "true").replace("False", "false")


def _cell(text: str) -> str:
    return text.replace("|", "\\|")
