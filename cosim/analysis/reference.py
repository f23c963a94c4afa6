"""Reference files: features that others have measured or computed, with their sources.

A feature names a function of `cosim.analysis.features` and its arguments. Values are quantities with unit; a pair is a
range.
"""

from __future__ import annotations

import inspect
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, get_type_hints

from pydantic import ConfigDict, TypeAdapter, ValidationError
from pydantic_core import PydanticCustomError

from cosim.analysis.features import QUANTITIES, UNITS
from cosim.analysis.run_data import COMPONENTS
from cosim.errors import InputError
from cosim.nearest import hint
from cosim.scenario.errors import short
from cosim.scenario.files import is_file, parse_toml, read_toml
from cosim.scenario.units import Unit, to_si
from coupling.interface import PHASES

HEAD = ("title", "over", "series", "feature")  #: keys of a file
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
    #: loads are means over this time [s]; 0: over single windows, at the instants of events; None: as the run's peaks
    over: float | None = None


@dataclass(frozen=True)
class Reference:
    """What a reference file holds."""

    title: str
    features: tuple[Feature, ...]
    series: Path | None = None  #: a measured series, or its `series.toml`, beside the reference file


def load_reference(path: str | Path) -> Reference:
    """Read a reference file, or the reference.toml of a folder."""
    file = Path(path)
    file = file / "reference.toml" if file.is_dir() else file
    if not is_file(file):
        raise FeatureError(f"{file}: no such reference; give a reference.toml or a folder that holds one")
    data = read_toml(file, FeatureError)[1]
    found = _reference(data, str(file))
    return replace(found, series=file.parent / data["series"]) if "series" in data else found


def parse_reference(text: str, origin: str) -> Reference:
    """Strictly: unknown quantities and arguments are refused."""
    return _reference(parse_toml(text, origin, FeatureError), origin)


def _reference(data: dict[str, Any], origin: str) -> Reference:
    if unknown := [key for key in data if key not in HEAD]:
        raise FeatureError(f"{origin}: unknown key {unknown[0]!r}; {hint(unknown[0], HEAD)}")
    _text(f"{origin}: series", data.get("series", ""))
    features = data.get("feature")
    if not isinstance(features, list) or not features:
        raise FeatureError(f"{origin}: no features; add at least one [[feature]] with name, quantity, unit, source")
    title = _text(f"{origin}: title", data.get("title", ""))
    over = _time(f"{origin}: over", data.get("over"))
    return Reference(title, tuple(_feature(entry, origin, over) for entry in features))


def _feature(entry: Any, origin: str, over: float | None) -> Feature:
    if not isinstance(entry, dict):
        raise FeatureError(f"{origin}: feature = {short(entry)}: write each as a table [[feature]]")
    where = f"{origin}: feature {short(entry.get('name', '?'))}"
    for key in ("name", "quantity", "unit", "source"):
        if key not in entry:
            raise FeatureError(f"{where}: {key} is missing; add it")
        _text(f"{where}: {key}", entry[key])
    quantity = entry["quantity"]
    if quantity not in QUANTITIES:
        raise FeatureError(f"{where}: unknown quantity {short(quantity)}; {hint(quantity, QUANTITIES)}")
    unit = UNITS[quantity]
    if entry["unit"] != unit:
        raise FeatureError(f'{where}: unit = {short(entry["unit"])}: {quantity} is measured in {unit}; write "{unit}"')
    arguments = {key: value for key, value in entry.items() if key not in OWN_KEYS}
    _check_arguments(where, quantity, arguments)
    ranges = {key: _range(f"{where}: {key}", entry.get(key), unit) for key in ("thesis", "measured")}
    own = _time(f"{where}: over", entry.get("over"))
    return Feature(
        entry["name"],
        quantity,
        unit,
        entry["source"],
        arguments,
        tolerance=_tolerance(where, entry.get("tolerance")),
        over=over if own is None else own,
        **ranges,
    )


def _text(where: str, value: Any) -> str:
    if not isinstance(value, str) or not value.isprintable() or len(value) > 500:
        raise FeatureError(f"{where} = {short(value)}: one line of plain text is wanted")
    return value


def _tolerance(where: str, value: Any) -> float | None:
    if value is None:
        return None
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0.0 < value < 100.0:
        raise FeatureError(f"{where}: tolerance = {short(value)}: a number above 0 is wanted, relative")
    return float(value)


def _time(where: str, value: Any) -> float | None:
    """A time [s]; 0 stands for single windows, and for the instant of an event."""
    found = _range(where, value, "s")
    if found is not None and (isinstance(value, list) or not 0.0 <= found[0] <= 1e6):
        raise FeatureError(f'{where} = {short(value)}: give a time, for example "0.5 s", or "0 s" for single windows')
    return None if found is None else found[0]


def _check_arguments(where: str, quantity: str, arguments: dict[str, Any]) -> None:
    function = QUANTITIES[quantity]
    kinds = get_type_hints(function)
    parameters = inspect.signature(function).parameters
    known = tuple(parameters)[1:]
    for key, value in arguments.items():
        if key not in known:
            raise FeatureError(f"{where}: unknown key {short(key)}; {hint(key, known + OWN_KEYS)}")
        _check_kind(f"{where}: {short(key)[1:-1]} = {short(value)}", value, kinds[key])
    for key, names in (("component", COMPONENTS), ("phase", PHASES)):
        if arguments.get(key, names[0]) not in names:
            raise FeatureError(f"{where}: {key} = {short(arguments[key])}: use one of {', '.join(names)}")
    if "event" in known and parameters["event"].default is inspect.Parameter.empty and "event" not in arguments:
        raise FeatureError(f'{where}: event is missing; add for example event = "split"')


def _check_kind(where: str, value: Any, kind: Any) -> None:
    """Whether a value is what a feature takes: a text, some texts, a whole number, a number."""
    try:
        TypeAdapter(kind, config=ConfigDict(strict=True, allow_inf_nan=False)).validate_python(value)
    except ValidationError as error:
        raise FeatureError(f"{where}: {error.errors()[0]['msg'].lower()}") from None
    if isinstance(value, int | float) and not 0.0 <= value <= 1e6:
        raise FeatureError(f"{where}: use a value from 0 to 1e6")


def _range(where: str, value: Any, unit: str) -> tuple[float, float] | None:
    if value is None:
        return None
    ends = value if isinstance(value, list) else [value, value]
    try:
        low, high = (to_si(end, Unit(unit, f"1 {unit}")) for end in ends)
    except PydanticCustomError as error:
        raise FeatureError(f"{where} = {short(value)}: {error.message()}") from None
    except ValueError:
        raise FeatureError(f"{where} = {short(value)}: give one value or a pair") from None
    if low > high:
        raise FeatureError(f"{where} = {short(value)}: a range goes from the lower to the higher value; turn it round")
    return low, high
