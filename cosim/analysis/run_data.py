"""A recorded run as arrays: what features, pictures and pages work on."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np

from cosim.analysis.sustained import at_event, running_mean
from coupling.interface import FREEDOMS, NS, PHASES, Array, Event, IntArray

#: components of a load in recordings, and with the resultant ``f``
AXES = ("fx", "fy", "fz")
COMPONENTS = (*AXES, "f")
#: components of a moment, and with the overturning one, about a horizontal axis, ``m``
MOMENT_AXES = ("mx", "my", "mz")
MOMENTS = (*MOMENT_AXES, "m")
#: of a structure that moves: displacements [m], [rad], then velocities
MOTION = (*FREEDOMS, *(f"{name}_rate" for name in FREEDOMS))


@dataclass(frozen=True)
class RunData:
    """Loads of every window, events and ledger of a run."""

    name: str  #: of the file
    metadata: Mapping[str, str]  #: of the run, see `cosim.recording.metadata.run_metadata`
    t_ns: IntArray  #: (n,) end of each window [ns]
    load: Array  #: (n, 3, 3) force on the structure: windows, phases, components [N]
    events: tuple[Event, ...] = ()
    ledger: dict[str, Array] = field(default_factory=dict)  #: (n,) by name; nan where a window has no such term
    texts: Mapping[str, str] = field(default_factory=dict)  #: attachments by name: scenario.toml, reference.toml
    budget: dict[str, Array] = field(default_factory=dict)  #: (n,) by term, see `coupling.budget` [N]; empty if unknown
    ended: str = "complete"  #: how the run ended, in words if it did not reach its duration or failed there
    cut: bool = False  #: the file ends before its end
    moment: Array | None = None  #: (n, 3, 3) about `moment_point`: windows, phases, components; None: unknown [N m]
    motion: dict[str, Array] = field(default_factory=dict)  #: (n,) by name of `MOTION`; empty where the structure rests
    weight: Array | None = None  #: (n, 4) of the point of attack, see `cosim.moments.Grip.weight`; None: unknown

    @property
    def remark(self) -> str:
        """What a reader must know of a run that is not whole; empty for one that is."""
        if self.ended == "complete" and not self.cut:
            return ""
        held = f"it holds {self.t_ns[-1] / NS:g} of {int(self.metadata['duration_ns']) / NS:g} s"
        if self.cut:
            return f"{self.name} is truncated (its run goes on, was killed, or the copy is not whole): {held}"
        how = "failed at its end" if self.t_ns[-1] >= int(self.metadata["duration_ns"]) else "did not reach its end"
        return f"{self.name} is of a run that {how}: {self.ended}; {held}"

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
        """(n,) one component, of `COMPONENTS` [N] or `MOMENTS` [N m], of all phases or of one.

        ValueError: a moment of a run without any.
        """
        known = self.moment if name in MOMENTS else self.load
        if known is None:
            raise ValueError(f"{self.name} holds no moments")
        values = known.sum(axis=1) if phase is None else known[:, PHASES.index(phase)]
        if name in ("f", "m"):
            return np.asarray(np.linalg.norm(values if name == "f" else values[:, :2], axis=1))
        out: Array = values[:, (MOMENT_AXES if name in MOMENTS else AXES).index(name)]
        return out

    @property
    def moment_point(self) -> list[float]:
        """Moments are about this point: x, y, z [m]."""
        point: list[float] = json.loads(self.metadata["moment_point_m"])
        return point

    @property
    def averaging(self) -> float:
        """Peaks of this run are those of the mean over this time [s]; see `cosim.analysis.sustained`."""
        return float(self.metadata["averaging_s"])

    def averaged(self, seconds: float) -> RunData:
        """The run with loads, budget and loads of events that are means over the last ``seconds``; 0: as they are."""
        if seconds <= 0.0 or not len(self.t_ns):
            return self
        load = running_mean(self.begin_ns, self.t_ns, self.load, seconds)
        total = load.sum(axis=1)

        def mean(values: Array | None) -> Array | None:
            return None if values is None else running_mean(self.begin_ns, self.t_ns, values, seconds)

        return replace(
            self,
            load=load,
            moment=mean(self.moment),
            weight=mean(self.weight),
            events=tuple(replace(e, force=tuple(at_event(self.t_ns, total, e.t_ns).tolist())) for e in self.events),
            budget={
                name: running_mean(self.begin_ns, self.t_ns, np.nan_to_num(term), seconds)
                for name, term in self.budget.items()
            },
        )

    @cached_property
    def lasting(self) -> RunData:
        """The run with the loads of which its peaks are the largest."""
        return self.averaged(self.averaging)

    @property
    def overrides(self) -> list[str]:
        """Settings of the user over the scenario, as ``a.b=v``."""
        values: list[str] = json.loads(self.metadata.get("overrides", "[]"))
        return values


def event_json(e: Event) -> dict[str, Any]:
    """An event as ``cosim run --json`` prints it; its load is the mean over the averaging time."""
    return {
        "time": e.t_ns / NS,
        "kind": e.kind,
        **dict(zip(AXES, e.force, strict=True)),
        "cells": e.cells,
        "position": list(e.position),
        "text": e.text,
        "length": e.length,
        "area": e.area,
        "cause": e.cause,
    }
