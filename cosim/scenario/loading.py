"""Scenarios: a TOML file, read strictly, becomes a frozen `Scenario` with SI floats.

Nothing is silently repaired. Whatever is wrong is one `ScenarioError` with one line: file, key, value, what to do.

    >>> scenario = load_scenario("scenarios/van_vliet_2018_floe_165m", ["coupling.window=20 ms"])
    >>> scenario.ice.thickness, scenario.window_ns
    (3.0, 20000000)
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from cosim.scenario.errors import ScenarioError, explain
from cosim.scenario.finding import locate
from cosim.scenario.model import ScenarioModel
from cosim.scenario.overrides import apply
from cosim.scenario.scenario import Scenario


def load_scenario(path: str | Path, overrides: Iterable[str] = ()) -> Scenario:
    """Read a scenario folder, a TOML file, or a shipped scenario by name; ``overrides`` are ``a.b=v`` texts."""
    file = locate(path)
    text, raw = read(file)
    overrides = tuple(overrides)
    overridden = {apply(raw, item) for item in overrides}
    try:
        model = ScenarioModel.model_validate(raw)
    except ValidationError as error:
        raise ScenarioError(explain(error, ScenarioModel, str(file), raw, overridden)) from None
    name = file.parent.name if file.name == "scenario.toml" else file.stem
    return Scenario(name, text, raw, model, overrides, file.parent, _warnings(model))


def read(file: Path, inner: tuple[Path, ...] = ()) -> tuple[str, dict[str, Any]]:
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
    common, table = read(under, (*inner, file.resolve()))
    return f"{common}\n# ---- {file.name} ----\n{text}", _merged(table, raw)


def _merged(under: dict[str, Any], over: dict[str, Any]) -> dict[str, Any]:
    """Tables of ``under`` with the keys of ``over`` in their place."""
    out = dict(under)
    for key, value in over.items():
        old = out.get(key)
        out[key] = _merged(old, value) if isinstance(old, dict) and isinstance(value, dict) else value
    return out


def _warnings(model: ScenarioModel) -> tuple[str, ...]:
    nu = model.ice.poisson_ratio
    if nu < 1 / 3 - 1e-9:
        return (
            f"ice.poisson_ratio = {nu:g} is below 1/3: in-plane shear springs resist rigid rotation, "
            "so that a turning floe is strained; use 1/3 unless this is what you study",
        )
    return ()
