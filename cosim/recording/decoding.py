"""Messages of a recording become the arrays of a run."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from cosim.analysis.run_data import RunData
from cosim.recording import messages
from coupling.interface import NS, Array, Event, IntArray

NAMED = ("/ledger", "/load/budget", "/structure/motion")  #: topics of numbers by name
DATA_TOPICS = ("/load/structure", "/events", *NAMED)
KEPT = (*messages.LOAD_FIELDS[3:], *messages.MOMENT_FIELDS[3:], *messages.GRIP_FIELDS[:4])  #: of a load; others follow
Stored = tuple[str, int, bytes]  #: topic, time [ns], serialised message


def decode(name: str, metadata: Mapping[str, str], texts: Mapping[str, str], stored: Iterable[Stored]) -> RunData:
    """From serialised messages; other topics are passed over. ValueError: they do not make a run."""
    end = int(metadata["duration_ns"])
    t_ns: list[int] = []
    loads: list[list[float]] = []
    events: list[Event] = []
    named: dict[str, list[tuple[int, dict[str, float]]]] = {topic: [] for topic in NAMED}
    for topic, time, data in stored:
        if topic == "/load/structure":
            if not (t_ns[-1] if t_ns else 0) < time <= end:
                raise ValueError(f"a window at {time / NS:g} s after {len(t_ns)} others of a run of {end / NS:g} s")
            t_ns.append(time)
            loads.append(_load(time, data))
        elif topic == "/events":
            if not time <= end:
                raise ValueError(f"an event at {time / NS:g} s of a run of {end / NS:g} s")
            events.append(_event(time, messages.Event.FromString(data)))
        elif topic in named:
            message = messages.Ledger.FromString(data)
            named[topic].append((time, dict(zip(message.name, message.value, strict=True))))
    times = np.array(t_ns, np.int64)
    columns = np.array(loads, float).reshape(-1, len(KEPT))
    return RunData(
        name,
        metadata,
        times,
        columns[:, :9].reshape(-1, 3, 3),
        tuple(events),
        _columns(times, named["/ledger"]),
        texts,
        _columns(times, named["/load/budget"]),
        moment=columns[:, 9:18].reshape(-1, 3, 3),
        motion=_columns(times, named["/structure/motion"]),
        weight=columns[:, 18:],
    )


def _load(t_ns: int, data: bytes) -> list[float]:
    """Forces [N] and moments [N m] of the phases, weights of the point of attack."""
    message = messages.Load.FromString(data)
    forces: list[float] = [getattr(message, key) for key in KEPT]
    if not all(map(math.isfinite, forces)):
        raise ValueError(f"the load at {t_ns / NS:g} s is not finite")
    return forces


def _event(t_ns: int, m: Any) -> Event:
    force, place = (m.fx, m.fy, m.fz), (m.x, m.y, m.z)
    return Event(t_ns, m.kind, force, m.cells, place, m.text, length=m.length, area=m.area, cause=m.cause)


def _columns(times: IntArray, rows: list[tuple[int, dict[str, float]]]) -> dict[str, Array]:
    """The ledger as one column per term, aligned with the windows."""
    names = list(dict.fromkeys(name for _, row in rows for name in row))
    columns = {name: np.full(len(times), np.nan) for name in names}
    index = {t: k for k, t in enumerate(times.tolist())}
    for t, row in rows:
        for name, value in row.items():
            if t in index:
                columns[name][index[t]] = value
    return columns
