"""Runs a scenario and keeps what a person asks for at the end: peaks by phase, events, balances."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from cosim.analysis.lights import trust
from cosim.analysis.moments import moments
from cosim.analysis.motion import motion
from cosim.analysis.run_data import COMPONENTS, MOTION, RunData, event_json
from cosim.analysis.volumes import volumes
from cosim.build import build, run_info
from cosim.checkpoint.keeping import Checkpoints
from cosim.moments import Grip, grip_of
from cosim.observer import Observer
from cosim.scenario.lengths import told_lengths
from cosim.scenario.scenario import Scenario
from coupling.interface import NS, PHASES, Array, Event, Frame, IntArray, SimulationError
from coupling.scheduler import Scheduler


class Peaks:
    """Largest load, by component; f is the resultant."""

    def __init__(self, t_ns: IntArray, load: Array) -> None:
        """Of loads (n, 3) at the ends of windows (n,)."""
        self.value, self.t_ns = np.zeros(4), np.zeros(4, np.int64)
        if len(load):
            components = np.column_stack((load, np.linalg.norm(load, axis=1)))
            k = np.abs(components).argmax(axis=0)
            self.value, self.t_ns = components[k, range(4)], t_ns[k]

    def to_json(self) -> dict[str, dict[str, float]]:
        """``{component: {"value" [N], "time" [s]}}``."""
        return {
            name: {"value": float(v), "time": t / NS}
            for name, v, t in zip(COMPONENTS, self.value, self.t_ns.tolist(), strict=True)
        }


@dataclass
class RunResult:
    """What a run came to, in SI units."""

    scenario: Scenario
    wall_s: float = 0.0
    t_ns: int = 0
    events: list[Event] = field(default_factory=list)
    fragments: int = 0
    blocks: int = 0
    ledger: dict[str, float] = field(default_factory=dict)
    loads: list[tuple[int, Array]] = field(default_factory=list)  #: end [ns] and load (3, 3) of every window
    staggering: list[tuple[float, float]] = field(default_factory=list)  #: Fx and Fz of every window [N]
    rubble: list[tuple[float, float]] = field(default_factory=list)  #: stored and cleared after every window [kg]
    grips: list[Grip] = field(default_factory=list)  #: moments and point of attack of every window
    motion: list[Array] = field(default_factory=list)  #: (2, 6) of the structure after every window, if it moves

    def kept(self) -> dict[str, Any]:
        """What a checkpoint keeps of it; see `go_on`."""
        return {
            "wall_s": self.wall_s,
            "t_ns": np.array([t for t, _ in self.loads], np.int64),
            "load": np.array([load for _, load in self.loads]),
            "moment": np.array([g.moment for g in self.grips]),
            "weight": np.array([g.weight for g in self.grips]),
            "staggering": np.array(self.staggering),
            "rubble": np.array(self.rubble),
            "motion": np.array(self.motion).reshape(-1, 2, 6),
            "events": self.events,
        }

    def go_on(self, kept: Mapping[str, Any]) -> None:
        """Has seen all windows until a checkpoint."""
        self.wall_s, self.events = kept["wall_s"], list(kept["events"])
        self.loads = list(zip(kept["t_ns"].tolist(), kept["load"], strict=True))
        self.grips = [Grip(m, w) for m, w in zip(kept["moment"], kept["weight"], strict=True)]
        self.staggering = [(x, z) for x, z in kept["staggering"].tolist()]
        self.rubble = [(stored, cleared) for stored, cleared in kept["rubble"].tolist()]
        self.motion = list(kept["motion"])
        self.t_ns = self.loads[-1][0]

    def see(self, frame: Frame, grip: Grip) -> None:
        """Takes in one window."""
        self.t_ns = frame.t_ns
        self.grips.append(grip)
        self.loads.append((frame.t_ns, frame.load))
        self.staggering.append((frame.budget.get("fx_staggering", 0.0), frame.budget.get("fz_staggering", 0.0)))
        self.rubble.append((frame.ledger.get("rubble_mass", 0.0), frame.ledger.get("cleared_mass", 0.0)))
        self.events.extend(frame.events)
        if frame.motion is not None:
            self.motion.append(frame.motion)

    @cached_property
    def data(self) -> RunData:
        """The run as arrays, as a recording gives them: whatever is told of it is told by the same functions."""
        metadata = {
            "averaging_s": repr(float(self.scenario.averaging)),
            "window_ns": str(self.scenario.window_ns),
            "spacing_m": repr(float(self.scenario.sheet.spacing)),
            "moment_point_m": json.dumps(self.scenario.moment_point),
            **told_lengths(self.scenario.model),
        }
        staggering = np.array(self.staggering).reshape(-1, 2)
        return RunData(
            self.scenario.name,
            metadata,
            np.array([t for t, _ in self.loads], np.int64),
            np.array([load for _, load in self.loads]).reshape(-1, 3, 3),
            tuple(self.events),
            ledger={name: np.array([value]) for name, value in self.ledger.items()},
            budget={"fx_staggering": staggering[:, 0], "fz_staggering": staggering[:, 1]},
            moment=np.array([g.moment for g in self.grips]).reshape(-1, 3, 3),
            weight=np.array([g.weight for g in self.grips]).reshape(-1, 4),
            motion=dict(zip(MOTION, np.array(self.motion).reshape(-1, 12).T, strict=True)) if self.motion else {},
        )

    @property
    def peaks(self) -> Peaks:
        """Of the whole load."""
        return Peaks(self.data.t_ns, self.data.lasting.load.sum(axis=1))

    @property
    def by_phase(self) -> dict[str, Peaks]:
        """Of the load of each phase."""
        return {phase: Peaks(self.data.t_ns, self.data.lasting.load[:, k]) for k, phase in enumerate(PHASES)}

    def mean_load(self) -> Array:
        """Mean over the run (3,) [N]."""
        impulse, before = np.zeros(3), 0
        for t, load in self.loads:
            impulse, before = impulse + (t - before) * load.sum(axis=0), t
        return np.asarray(impulse / max(before, 1))

    @property
    def volumes(self) -> dict[str, object]:
        """Rubble over time."""
        stored, cleared = np.array(self.rubble).reshape(-1, 2).T
        return volumes([t for t, _ in self.loads], stored.tolist(), cleared.tolist(), self.scenario.ice.density)

    def to_json(self) -> dict[str, Any]:
        """What ``cosim run --json`` prints, but for the name of the recording."""
        simulated = self.t_ns / NS
        return {
            "scenario": self.scenario.title,
            "simulated_s": simulated,
            "wall_s": self.wall_s,
            "real_time_factor": simulated / self.wall_s,
            "averaging_s": self.scenario.averaging,
            "window_s": self.scenario.coupling.window,
            "substep_s": self.scenario.rubble.substep,
            "peaks": self.peaks.to_json(),
            "peaks_by_phase": {phase: peaks.to_json() for phase, peaks in self.by_phase.items()},
            "moments": moments(self.data),
            "motion": motion(self.data),
            "trust": trust(self.data),
            "events": [event_json(e) for e in self.data.lasting.events],
            "fragments": self.fragments,
            "blocks": self.blocks,
            "rubble": self.volumes,
            "ledger": self.ledger,
        }


def run_scenario(
    scenario: Scenario,
    observers: Sequence[Observer] = (),
    at_end: Callable[[Scheduler], None] | None = None,
    checkpoints: Checkpoints | None = None,
) -> RunResult:
    """Simulates a scenario to its end; observers see every window. They are closed by whoever made them.

    ``at_end`` is called with all participants when the last window is done; ``checkpoints`` say where they are written
    and from which of them the run goes on.
    """
    result, checkpoints = RunResult(scenario), checkpoints or Checkpoints(scenario)
    with threadpool_limits(1):  # linear algebra adds in the same order on every machine: same scenario, same bits
        began = time.perf_counter()
        scheduler = build(scenario, begins=checkpoints.kept is None)
        info = run_info(scenario, scheduler)
        if seen := checkpoints.begin(info, scheduler):
            result.go_on(seen)
        began -= result.wall_s
        for observer in observers:
            observer.on_start(info)
        checkpoints.started()
        while scheduler.t_ns < scenario.duration_ns:
            frame = scheduler.macro_step()
            _is_finite(frame)
            result.see(frame, grip_of(frame, scenario.moment_point))
            for observer in observers:
                observer.on_frame(frame)
            result.wall_s = time.perf_counter() - began
            checkpoints.after_window(scheduler, result.kept)
    _finish(result, scheduler)
    _was_touched(result)
    checkpoints.clear()
    if at_end is not None:
        at_end(scheduler)
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
        **{k: v for k, v in scheduler.notes.items() if k.endswith("_windows") or k.startswith("structure_")},
    }


def _is_finite(frame: Frame) -> None:
    """Ends a run whose numbers are none."""
    for what, values in (("load", frame.load), ("place of the sheet", frame.sheet.position)):
        if not np.isfinite(values).all():
            raise SimulationError(
                f"t = {frame.t_ns / NS:.3f} s: the {what} is not finite; halve coupling.window and rubble.substep, "
                "and see what `cosim check` says of the scenario"
            )


def _was_touched(result: RunResult) -> None:
    """Ends a run that has met nothing: its zeros are no result."""
    if result.loads and not any(load.any() for _, load in result.loads):
        raise SimulationError(
            f"the structure was never touched in {result.t_ns / NS:g} s; the ice passes it: see structure.top, "
            "structure.toe_depth and sheet.axis_from_side, or has not come yet (sheet.gap): lengthen scenario.duration"
        )
