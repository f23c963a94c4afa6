"""Reference files: features that others have measured or computed, with their sources.

A feature names a function of `cosim.analysis.features` and its arguments. Values are quantities with unit; a pair is a
range.
"""

from __future__ import annotations

import inspect
import math
import tomllib
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, get_type_hints

from pydantic import TypeAdapter, ValidationError
from pydantic_core import PydanticCustomError

from cosim.analysis.features import QUANTITIES
from cosim.analysis.run_data import COMPONENTS
from cosim.errors import InputError
from cosim.nearest import hint
from cosim.scenario.units import Unit, to_si
from coupling.interface import PHASES

OWN_KEYS = ("name", "quantity", "unit", "thesis", "measured", "source", "tolerance", "over")


class FeatureError(InputError):
    """A reference file that cannot be used; the message is one line with its remedy."""


@dataclass(frozen=True)
class Feature:
    """One number to compare."""

    name: str
    quantity: str  #: function of `cosim.analysis.features`
    unit: str  #: SI unit of all its values
    source: str
    arguments: dict[str, Any] = field(default_factory=dict)  #: of the function
    thesis: tuple[float, float] | None = None  #: computed by the source, as range [SI]
    measured: tuple[float, float] | None = None  #: as range [SI]
    tolerance: float | None = None  #: relative, for those who test
    over: float | None = None  #: loads are means over this time [s]; without it, over a window


@dataclass(frozen=True)
class Reference:
    """What a reference file holds."""

    title: str
    features: tuple[Feature, ...]


def load_reference(path: str | Path) -> Reference:
    """Read a reference file, or the reference.toml of a folder."""
    file = Path(path)
    file = file / "reference.toml" if file.is_dir() else file
    if not file.is_file():
        raise FeatureError(f"{file}: no such reference; give a reference.toml or a folder that holds one")
    try:
        text = file.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise FeatureError(f"{file}: not UTF-8: {error}; save it as UTF-8") from None
    return parse_reference(text, str(file))


def parse_reference(text: str, origin: str) -> Reference:
    """Strictly: unknown quantities and arguments are refused."""
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise FeatureError(f"{origin}: not valid TOML: {error}; correct that line") from None
    features = data.get("feature")
    if not isinstance(features, list) or not features:
        raise FeatureError(f"{origin}: no features; add at least one [[feature]] with name, quantity, unit, source")
    return Reference(str(data.get("title", "")), tuple(_feature(entry, origin) for entry in features))


def _feature(entry: Any, origin: str) -> Feature:
    if not isinstance(entry, dict):
        raise FeatureError(f"{origin}: feature = {entry!r}: not a table; write [[feature]] and its keys below")
    where = f"{origin}: feature {entry.get('name', '?')}"
    for key in ("name", "quantity", "unit", "source"):
        if not isinstance(entry.get(key), str):
            raise FeatureError(f"{where}: {key} is missing or no text; add it")
    tolerance = entry.get("tolerance")
    if tolerance is not None and (type(tolerance) not in (int, float) or not 0.0 <= tolerance < math.inf):
        raise FeatureError(f"{where}: tolerance = {tolerance!r}: give a number >= 0, for example 0.1")
    quantity = entry["quantity"]
    if quantity not in QUANTITIES:
        raise FeatureError(f"{where}: unknown quantity {quantity!r}; {hint(quantity, QUANTITIES)}")
    arguments = {key: value for key, value in entry.items() if key not in OWN_KEYS}
    _check_arguments(where, quantity, arguments)
    ranges = {key: _range(f"{where}: {key}", entry.get(key), entry["unit"]) for key in ("thesis", "measured")}
    return Feature(
        entry["name"],
        quantity,
        entry["unit"],
        entry["source"],
        arguments,
        tolerance=tolerance,
        over=_time(f"{where}: over", entry.get("over")),
        **ranges,
    )


def _time(where: str, value: Any) -> float | None:
    found = _range(where, value, "s")
    if found is not None and not found[0] > 0.0:
        raise FeatureError(f'{where} = {value!r}: give a time > 0, for example "0.5 s"')
    return None if found is None else found[0]


def _check_arguments(where: str, quantity: str, arguments: dict[str, Any]) -> None:
    parameters = inspect.signature(QUANTITIES[quantity]).parameters
    hints = get_type_hints(QUANTITIES[quantity])
    known = tuple(parameters)[1:]
    for key, value in arguments.items():
        if key not in known:
            raise FeatureError(f"{where}: unknown key {key!r}; {hint(key, known + OWN_KEYS)}")
        try:
            TypeAdapter(hints[key]).validate_python(value, strict=True)
        except ValidationError as error:
            raise FeatureError(f"{where}: {key} = {value!r}: {error.errors()[0]['msg'].lower()}") from None
    for key, names in (("component", COMPONENTS), ("phase", PHASES)):
        if key in arguments and arguments[key] not in names:
            raise FeatureError(f"{where}: {key} = {arguments[key]!r}: use one of {', '.join(names)}")
    if "event" in known and parameters["event"].default is inspect.Parameter.empty and "event" not in arguments:
        raise FeatureError(f'{where}: event is missing; add for example event = "split"')


def _range(where: str, value: Any, unit: str) -> tuple[float, float] | None:
    if value is None:
        return None
    ends = value if isinstance(value, list) else [value, value]
    try:
        low, high = (to_si(end, Unit(unit, f"1 {unit}")) for end in ends)
    except PydanticCustomError as error:
        raise FeatureError(f"{where} = {value!r}: {error.message()}") from None
    except ValueError:
        raise FeatureError(f"{where} = {value!r}: give one value or a pair") from None
    if low > high:
        raise FeatureError(f"{where} = {value!r}: from high to low; turn the pair round")
    return low, high
