"""`series.toml`: what a measured series is, as far as its file does not say so itself. Read strictly.

Every key can be set on the command line as well: ``--set fx.unit=kN``. Times with units; SI inside.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any, Literal

from pydantic import Field, ValidationError
from pydantic_core import PydanticCustomError

from cosim.nearest import hint
from cosim.scenario.files import read_toml
from cosim.scenario.overrides import apply
from cosim.scenario.section import Section
from cosim.scenario.units import Time, TimeOrZero, Unit, to_si
from cosim.series.told import SeriesError


class Text(Section):
    """[text] How a text file is written, where that cannot be told from it."""

    encoding: str | None = None  #: for example utf-8, utf-16, cp1252
    delimiter: str | None = Field(None, max_length=10)  #: one character, or "space" for any white space, or "tab"
    decimal: Literal[".", ","] | None = None  #: decimal point
    thousands: Literal[".", ",", " ", "'"] | None = None  #: what groups digits; without it grouped digits are refused
    comment: str | None = Field(None, min_length=1, max_length=3)  #: begins a remark; default #, %, // and !


class TimeColumn(Section):
    """[time] Where the time stands."""

    column: str | int | None = None  #: name or number from 1
    unit: str | None = None  #: of plain numbers
    format: str | None = None  #: of stamps, as of strptime; with it the order of day and month is told
    step: Time | None = None  #: distance of the rows, for a file without times [s]


class LoadColumn(Section):
    """[fx], [fy], [fz], [f] Where a component of the load stands."""

    column: str | int | None = None  #: name or number from 1
    unit: str | None = None  #: overrules what the file says
    sign: Literal[1, -1] = 1  #: -1: the sensor counts the other way


class Sensor(Section):
    """[sensor] Zero and drift."""

    #: parts of the record, in its own time, in which the structure is not loaded [s]: the mean of one is taken off as
    #: zero, a straight line through several as zero and drift
    unloaded: Any = None


class Scale(Section):
    """[scale] From model scale to that of the run."""

    #: froude: gravity; cauchy-froude: gravity and elasticity, E and strengths of the model's ice are smaller by factor.
    #: Forces and times scale alike in both
    law: Literal["froude", "cauchy-froude"] = "froude"
    factor: float = Field(1.0, gt=0, le=1e6)  #: lengths of the run over those of the series
    density: float = Field(1.0, gt=0, le=10)  #: density of the run's water over that of the model's


class Align(Section):
    """[align] How the series is laid on the run."""

    by: Literal["contact", "peak", "event", "correlation", "hand"] = "contact"
    component: Literal["fx", "fy", "fz", "f"] | None = None  #: that is looked at; default the first of the series
    threshold: float = Field(0.05, gt=0, lt=1)  #: contact: share of the largest load above which there is contact
    event: str | None = None  #: event: kind, the first of the run
    at: TimeOrZero | None = None  #: event: when it was, in the series' own time [s]
    shift: Any = None  #: hand: by how much the series is later than the run, in the time of the run [s]


class Metrics(Section):
    """[metrics] What is taken from both."""

    over: TimeOrZero | None = None  #: both are means over this time [s]; default as the peaks of the run
    above: float = Field(0.1, ge=0, lt=1)  #: peaks lie above this share of the largest load of the measured series
    prominence: float = Field(0.1, gt=0, le=1)  #: and stand out by this share of it
    wohler: float = Field(4.0, ge=1, le=20)  #: slope m of the S-N curve, for the damage-equivalent load
    rate: float = Field(1.0, gt=0, le=1000)  #: cycles per second of the damage-equivalent load
    below_tail: float = Field(0.5, ge=0, lt=1)  #: share of the peaks below those to which the extreme load is fitted
    return_period: Time = 3600.0  #: of the extreme load [s]
    confidence: float = Field(0.9, gt=0, lt=1)  #: of its interval


class Description(Section):
    """What a series is."""

    file: str | None = None  #: the data, beside the description
    title: str = Field("", max_length=200)
    source: str = Field("", max_length=500)  #: who measured it, where it is published
    text: Text = Text.model_validate({})
    time: TimeColumn = TimeColumn.model_validate({})
    fx: LoadColumn | None = None
    fy: LoadColumn | None = None
    fz: LoadColumn | None = None
    f: LoadColumn | None = None
    sensor: Sensor = Sensor.model_validate({})
    scale: Scale = Scale.model_validate({})
    align: Align = Align.model_validate({})
    metrics: Metrics = Metrics.model_validate({})

    @property
    def unloaded(self) -> tuple[tuple[float, float], ...]:
        """Parts of the record without load [s]."""
        given = self.sensor.unloaded or ()
        return tuple((float(a), float(b)) for a, b in given)


def load_description(path: Path, settings: Iterable[str] = ()) -> tuple[Description, Path]:
    """The description of a data file or of a `series.toml`, and the data file. Settings are ``a.b=v``.

    Beside ``name.csv`` a file ``name.series.toml`` or, if its ``file`` is ``name.csv``, ``series.toml`` is taken.
    """
    told = path if path.suffix == ".toml" else _beside(path)
    raw = read_toml(told, SeriesError)[1] if told else {}
    for item in settings:
        apply(raw, item)
    origin = str(told or path)
    made = _validated(raw, origin)
    if path.suffix != ".toml":
        return made, path
    if made.file is None:
        raise SeriesError(f'{origin}: file is missing; name the data, for example file = "measured.csv"')
    return made, told.parent / made.file if told else path


def _beside(path: Path) -> Path | None:
    own, common = path.with_suffix(".series.toml"), path.with_name("series.toml")
    if own.is_file():
        return own
    if common.is_file() and read_toml(common, SeriesError)[1].get("file") == path.name:
        return common
    return None


def _validated(raw: dict[str, Any], origin: str) -> Description:
    try:
        made = Description.model_validate(_with_times(raw))
    except PydanticCustomError as error:
        raise SeriesError(f"{origin}: {error.message()}") from None
    except ValidationError as error:
        raise SeriesError(f"{origin}: {_line(error)}") from None
    align = made.align
    if align.by == "hand" and align.shift is None:
        raise SeriesError(f'{origin}: align.shift is missing; say by how much the series is later, for example "7.3 s"')
    if align.by == "event" and (align.event is None or align.at is None):
        raise SeriesError(f"{origin}: align.event and align.at are missing; give the kind and its time in the series")
    for begin, end in made.unloaded:
        if not begin < end:
            raise SeriesError(f"{origin}: sensor.unloaded: from {begin:g} s to {end:g} s is no time; turn it round")
    return made


def _with_times(raw: dict[str, Any]) -> dict[str, Any]:
    """Times that may be negative or stand in pairs as seconds."""
    out = dict(raw)
    if isinstance(align := raw.get("align"), dict) and "shift" in align:
        out["align"] = {**align, "shift": _seconds("align.shift", align["shift"])}
    if isinstance(sensor := raw.get("sensor"), dict) and "unloaded" in sensor:
        parts = sensor["unloaded"]
        well = isinstance(parts, list) and parts and all(isinstance(p, list) and len(p) == 2 for p in parts)
        if not well:
            raise PydanticCustomError("pairs", 'sensor.unloaded: give pairs of times, for example [["0 s", "5 s"]]')
        out["sensor"] = {
            **sensor,
            "unloaded": tuple(tuple(_seconds("sensor.unloaded", end) for end in part) for part in parts),
        }
    return out


def _seconds(key: str, value: object) -> float:
    """A time of any sign [s]."""
    try:
        return to_si(value, Unit("s", "5 s"))
    except PydanticCustomError as error:
        raise PydanticCustomError("quantity", "{text}", {"text": f"{key} = {value!r}: {error.message()}"}) from None


def _line(error: ValidationError) -> str:
    """The first thing that is wrong, with its key."""
    first = error.errors()[0]
    key = ".".join(str(part) for part in first["loc"])
    if first["type"] == "extra_forbidden":
        model: Any = Description
        for part in first["loc"][:-1]:
            kind = model.model_fields[str(part)].annotation
            model = LoadColumn if str(part) in ("fx", "fy", "fz", "f") else kind
        return f"unknown key {key}; {hint(first['loc'][-1], model.model_fields)}"
    return f"{key} = {first['input']!r}: {first['msg'].lower()}"
