"""What identifies a recorded run: written first, sealed by a checksum of its own, checked when it is read."""

from __future__ import annotations

import json
import math
import zlib
from collections.abc import Callable, Mapping
from typing import Any

from cosim import provenance
from cosim.observer import RunInfo
from cosim.scenario.lengths import told_lengths

FORMAT = "3"  #: of recordings; goes up with every change that an older reader would misread
RUN, END = "run", "end"  #: names of the records: what was asked, how it ended
COMPLETE = "complete"  #: how a run ended that reached its duration and did not fail there
SEAL = "crc32"


def run_metadata(info: RunInfo, texts: Mapping[str, str]) -> dict[str, str]:
    """Strings, as MCAP wants them; ``texts`` are the attachments."""
    scenario = info.scenario
    return {
        "format": FORMAT,
        "version": provenance.version(),
        "commit": provenance.commit(),
        "libraries": json.dumps(provenance.libraries()),
        "scenario": scenario.name,
        "title": scenario.title,
        "seed": str(scenario.seed),
        "overrides": json.dumps(list(scenario.overrides)),
        "nodes": json.dumps(list(info.sheet_shape)),
        "spacing_m": repr(float(info.d)),
        "thickness_m": repr(info.thickness),
        "drift_m_s": repr(float(scenario.drift.velocity)),
        "ice_density": repr(float(scenario.ice.density)),
        "duration_ns": str(info.duration_ns),
        "window_ns": str(info.window_ns),
        "averaging_s": repr(float(scenario.averaging)),
        **told_lengths(scenario.model),
        "units": json.dumps({"force": "N", "moment": "N m", "length": "m", "time": "s", "energy": "J", "mass": "kg"}),
        "moment_point_m": json.dumps(scenario.moment_point),
        "attachments": json.dumps(list(texts)),
    }


def sealed(values: Mapping[str, str]) -> dict[str, str]:
    """The same with a checksum: a record of MCAP's own has none in a file that is not finished."""
    return {**values, SEAL: _checksum(values)}


def _checksum(values: Mapping[str, str]) -> str:
    return f"{zlib.crc32(json.dumps(values, sort_keys=True).encode()):08x}"


def opened(values: Mapping[str, str]) -> dict[str, str]:
    """Without the checksum; ValueError if it is wrong, KeyError if there is none."""
    bare = {key: value for key, value in values.items() if key != SEAL}
    if values[SEAL] != _checksum(bare):
        raise ValueError("a byte of the metadata is wrong")
    return bare


def fault(values: Mapping[str, str]) -> str | None:
    """What is wrong with the metadata of a run, as part of a line; None if nothing is."""
    for key, check in CHECKS.items():
        try:
            good = check(values[key])
        except (KeyError, ValueError, TypeError):
            good = False
        if not good:
            return f"metadata {key} = {values.get(key)!r}"
    return None


def _whole(least: int) -> Callable[[str], bool]:
    return lambda text: least <= int(text) < 2**63


def _length(text: str) -> bool:
    return 0.0 < float(text) < math.inf


def _list_of(kind: type, count: int | None = None) -> Callable[[str], bool]:
    def check(text: str) -> bool:
        items: Any = json.loads(text)
        return isinstance(items, list) and all(type(i) is kind for i in items) and count in (None, len(items))

    return check


CHECKS: dict[str, Callable[[str], bool]] = {
    "version": bool,
    "commit": bool,
    "libraries": lambda text: isinstance(json.loads(text), dict),
    "scenario": bool,
    "title": lambda _: True,
    "seed": _whole(0),
    "overrides": _list_of(str),
    "nodes": _list_of(int, 2),
    "spacing_m": _length,
    "thickness_m": _length,
    "drift_m_s": lambda text: 0.0 <= float(text) < math.inf,
    "ice_density": _length,
    "duration_ns": _whole(1),
    "window_ns": _whole(1),
    "averaging_s": lambda text: 0.0 <= float(text) < math.inf,
    "characteristic_length_m": _length,
    "units": lambda text: isinstance(json.loads(text), dict),
    "moment_point_m": _list_of(float, 3),
    "attachments": _list_of(str),
}
