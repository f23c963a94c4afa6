"""A recorded run as arrays: what `compare`, `replay` and `info` work on."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from cosim import messages
from cosim.errors import InputError
from cosim.sustained import running_mean
from coupling.interface import NS, PHASES, Array, Event, IntArray

DATA_TOPICS = ("/load/structure", "/events", "/ledger", "/load/budget")
Stored = tuple[str, int, bytes]  #: topic, time [ns], serialised message


class RecordingError(InputError):
    """A recording that cannot be used; the message is one line with its remedy."""


@dataclass(frozen=True)
class RunData:
    """Loads of every window, events and ledger of a run."""

    name: str  #: of the file
    metadata: Mapping[str, str]  #: of the run, see `cosim.recording.run_metadata`
    t_ns: IntArray  #: (n,) end of each window [ns]
    load: Array  #: (n, 3, 3) force on the structure: windows, phases, components [N]
    events: tuple[Event, ...] = ()
    ledger: dict[str, Array] = field(default_factory=dict)  #: (n,) by name; nan where a window has no such term
    texts: Mapping[str, str] = field(default_factory=dict)  #: attachments by name: scenario.toml, reference.toml
    budget: dict[str, Array] = field(default_factory=dict)  #: (n,) by term, see `coupling.budget` [N]; empty if unknown

    @property
    def t(self) -> Array:
        """(n,) end of each window [s]."""
        return self.t_ns / NS

    @property
    def begin_ns(self) -> IntArray:
        """(n,) start of each window [ns]; that of the first one from the length that the run began with."""
        if not len(self.t_ns):
            return self.t_ns
        return np.concatenate((self.t_ns[:1] - int(self.metadata["window_ns"]), self.t_ns[:-1]))

    def component(self, name: str, phase: str | None = None) -> Array:
        """(n,) one component, ``fx``, ``fy``, ``fz`` or the resultant ``f``, of all phases or of one [N]."""
        load = self.load.sum(axis=1) if phase is None else self.load[:, PHASES.index(phase)]
        if name == "f":
            return np.linalg.norm(load, axis=1)
        out: Array = load[:, messages.AXES.index(name)]
        return out

    def averaged(self, seconds: float) -> RunData:
        """The run with loads that are means over the last ``seconds``; see `cosim.sustained`."""
        return replace(self, load=running_mean(self.begin_ns, self.t_ns, self.load, seconds))

    @property
    def overrides(self) -> list[str]:
        values: list[str] = json.loads(self.metadata.get("overrides", "[]"))
        return values

    @classmethod
    def decode(
        cls, name: str, metadata: Mapping[str, str], texts: Mapping[str, str], stored: Iterable[Stored]
    ) -> RunData:
        """From serialised messages; other topics are passed over."""
        t_ns: list[int] = []
        loads: list[list[float]] = []
        events: list[Event] = []
        books: dict[str, list[tuple[int, dict[str, float]]]] = {"/ledger": [], "/load/budget": []}
        for topic, time, data in stored:
            if topic == "/load/structure":
                message = messages.Load.FromString(data)
                t_ns.append(time)
                loads.append([getattr(message, key) for key in messages.LOAD_FIELDS[3:]])
            elif topic == "/events":
                events.append(_event(time, messages.Event.FromString(data)))
            elif topic in books:
                message = messages.Ledger.FromString(data)
                books[topic].append((time, dict(zip(message.name, message.value, strict=True))))
        times = np.array(t_ns, np.int64)
        return cls(
            name,
            metadata,
            times,
            np.array(loads, float).reshape(-1, 3, 3),
            tuple(events),
            _columns(times, books["/ledger"]),
            texts,
            _columns(times, books["/load/budget"]),
        )


def _event(t_ns: int, m: Any) -> Event:
    return Event(t_ns, m.kind, (m.fx, m.fy, m.fz), m.cells, (m.x, m.y, m.z), m.text, m.length, m.area)


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
