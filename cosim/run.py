"""Runs a scenario and keeps what a person asks for at the end: peaks by phase, events, balances."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from cosim.analysis.run_data import COMPONENTS
from cosim.analysis.sustained import SUSTAINED, running_mean
from cosim.build import build, run_info
from cosim.observer import Observer
from cosim.scenario.scenario import Scenario
from coupling.interface import NS, PHASES, Array, Event, Frame
from coupling.scheduler import Scheduler


class Peaks:
    """Largest mean load of a window, by component; f is the resultant."""

    def __init__(self) -> None:
        self.value, self.t_ns = np.zeros(4), np.zeros(4, np.int64)

    def see(self, t_ns: int, load: Array) -> None:
        """Takes in the load (3,) of a window."""
        now = np.array([*load, np.linalg.norm(load)])
        higher = np.abs(now) > np.abs(self.value)
        self.value[higher], self.t_ns[higher] = now[higher], t_ns

    def to_json(self) -> dict[str, dict[str, float]]:
        """``{component: {"value" [N], "time" [s]}}``."""
        return {
            name: {"value": float(v), "time": t / NS}
            for name, v, t in zip(COMPONENTS, self.value, self.t_ns.tolist(), strict=True)
        }


class PeaksByPhase:
    """Peaks of the whole load and of that of each phase."""

    def __init__(self) -> None:
        self.total, self.of = Peaks(), {p: Peaks() for p in PHASES}

    def see(self, t_ns: int, load: Array) -> None:
        """Takes in the load (3, 3) of a window, rows by phase."""
        self.total.see(t_ns, load.sum(axis=0))
        for phase, part in zip(self.of.values(), load, strict=True):
            phase.see(t_ns, part)

    def to_json(self) -> dict[str, Any]:
        """``peaks`` of the whole load and ``peaks_by_phase``."""
        return {"peaks": self.total.to_json(), "peaks_by_phase": {name: p.to_json() for name, p in self.of.items()}}


@dataclass
class RunResult:
    """What a run came to, in SI units."""

    scenario: Scenario
    wall_s: float = 0.0
    t_ns: int = 0
    windows: PeaksByPhase = field(default_factory=PeaksByPhase)  #: of single windows
    events: list[Event] = field(default_factory=list)
    fragments: int = 0
    blocks: int = 0
    ledger: dict[str, float] = field(default_factory=dict)
    loads: list[tuple[int, Array]] = field(default_factory=list)  #: end [ns] and load (3, 3) of every window

    def see(self, frame: Frame) -> None:
        """Takes in one window."""
        self.t_ns = frame.t_ns
        self.windows.see(frame.t_ns, frame.load)
        self.loads.append((frame.t_ns, frame.load))
        self.events.extend(frame.events)

    @property
    def peaks(self) -> Peaks:
        """Of the whole load."""
        return self.windows.total

    @property
    def by_phase(self) -> dict[str, Peaks]:
        """Of the load of each phase."""
        return self.windows.of

    def mean_load(self) -> Array:
        """Mean over the run (3,) [N]."""
        impulse, before = np.zeros(3), 0
        for t, load in self.loads:
            impulse, before = impulse + (t - before) * load.sum(axis=0), t
        return np.asarray(impulse / max(before, 1))

    def sustained(self) -> dict[str, Any]:
        """Peaks of the mean over `SUSTAINED`, of all phases and of each."""
        end = np.array([t for t, _ in self.loads], np.int64)
        mean = running_mean(np.concatenate(([0], end[:-1])), end, np.array([load for _, load in self.loads]))
        peaks = PeaksByPhase()
        for t, load in zip(end.tolist(), mean, strict=True):
            peaks.see(t, load)
        return {"seconds": SUSTAINED, **peaks.to_json()}

    def to_json(self) -> dict[str, Any]:
        """What ``cosim run --json`` prints, but for the name of the recording."""
        simulated = self.t_ns / NS
        return {
            "scenario": self.scenario.title,
            "simulated_s": simulated,
            "wall_s": self.wall_s,
            "real_time_factor": simulated / self.wall_s,
            **self.windows.to_json(),
            "sustained": self.sustained(),
            "events": [event_json(e) for e in self.events],
            "fragments": self.fragments,
            "blocks": self.blocks,
            "ledger": self.ledger,
        }


def event_json(e: Event) -> dict[str, Any]:
    """An event as ``cosim run --json`` prints it: time [s], load [N], place [m]."""
    return {
        "time": e.t_ns / NS,
        "kind": e.kind,
        "fx": e.force[0],
        "fy": e.force[1],
        "fz": e.force[2],
        "cells": e.cells,
        "position": list(e.position),
        "text": e.text,
        "length": e.length,
        "area": e.area,
        "cause": e.cause,
    }


def run_scenario(scenario: Scenario, observers: Sequence[Observer] = ()) -> RunResult:
    """Simulates a scenario to its end; observers see every window. They are closed by whoever made them."""
    began = time.perf_counter()
    result = RunResult(scenario)
    with threadpool_limits(1):  # linear algebra adds in the same order on every machine: same scenario, same bits
        scheduler = build(scenario)
        info = run_info(scenario)
        for observer in observers:
            observer.on_start(info)
        while scheduler.t_ns < scenario.duration_ns:
            frame = scheduler.macro_step()
            result.see(frame)
            for observer in observers:
                observer.on_frame(frame)
    _finish(result, scheduler)
    result.wall_s = time.perf_counter() - began
    return result


def _finish(result: RunResult, scheduler: Scheduler) -> None:
    ledger = scheduler.ledger
    result.fragments, result.blocks = scheduler.fragments, scheduler.rubble.blocks().count
    result.ledger = {
        "mass_error": ledger.mass_error,
        "momentum_error": ledger.momentum_error,
        "angular_momentum_error": ledger.angular_momentum_error,
        "energy_residual": ledger.energy.relative,
        "sheet_energy_residual": ledger.sheet_energy_residual,
        **ledger.energy.terms,
        **scheduler.rubble.momenta,
        "initial_mass": ledger.initial_mass,
        "handed_over_mass": ledger.handed_over_mass,
        "crushed_mass": scheduler.sheet.crushed + ledger.trimmed_mass,
        "cleared_mass": scheduler.rubble.cleared_mass,
        "interface_lost": scheduler.power.loss,
        "interface_exchanged": scheduler.power.exchanged,
        **{k: v for k, v in scheduler.notes.items() if k.endswith("_windows")},
    }
