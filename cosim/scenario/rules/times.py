"""Rules of times: windows are whole multiples of sub-steps, runs of windows."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from pydantic_core import PydanticCustomError

from cosim.scenario.section import fault

Faults = Iterator[PydanticCustomError]
MOST_WINDOWS = 10_000_000  #: of a run


def lockstep_marches(m: Any) -> Faults:
    """Steps of the implicit engine are as long as windows."""
    if m.coupling.scheme == "lockstep" and not m.fracture.marches:
        yield fault(
            "coupling.scheme",
            'lockstep needs fracture.cracks = "closing" or fracture.propagation = "dynamic"; remove the key, or name '
            "another scheme",
        )


def bounds_enclose_the_window(m: Any) -> Faults:
    """With steering."""
    c = m.coupling
    for key, value in (("shortest_window", c.shortest_window), ("longest_window", c.longest_window)):
        if value is not None and c.steering == "fixed":
            yield fault(
                f"coupling.{key}",
                'has no meaning for windows that are all alike: remove it or set steering = "power"',
            )
    if c.shortest_window is not None and c.shortest_window > c.window:
        yield fault("coupling.shortest_window", f"must be at most the first window of {c.window * 1e3:g} ms")
    if c.longest_window is not None and c.longest_window < c.window:
        yield fault("coupling.longest_window", f"must be at least the first window of {c.window * 1e3:g} ms")


def times_are_whole_multiples(m: Any) -> Faults:
    """In nanoseconds, in which time is counted."""
    substep = m.rubble.substep
    yield from _whole("coupling.window", m.coupling.window, "rubble sub-step", substep)
    for bound in ("shortest_window", "longest_window"):
        if (value := getattr(m.coupling, bound)) is not None:
            yield from _whole(f"coupling.{bound}", value, "rubble sub-step", substep)


def duration_is_whole(m: Any) -> Faults:
    """Windows of a run."""
    yield from _whole("scenario.duration", m.scenario.duration, "time window", m.coupling.window)
    if m.scenario.duration > MOST_WINDOWS * m.coupling.window:
        yield fault("scenario.duration", f"more than {MOST_WINDOWS:g} time windows of {m.coupling.window * 1e3:g} ms")


def frames_are_whole(m: Any) -> Faults:
    """Windows between recorded frames, and between checkpoints."""
    yield from _whole("recording.every", m.recording.every, "time window", m.coupling.window)
    if m.recording.checkpoint_every is not None:
        yield from _whole("recording.checkpoint_every", m.recording.checkpoint_every, "time window", m.coupling.window)


def _whole(key: str, value: float, name: str, step: float) -> Faults:
    nearest = nearest_multiples(value, step)
    if nearest:
        shown = " or ".join(f"{t * 1e3:g} ms" if t < 1 else f"{t:g} s" for t in nearest)
        yield fault(key, f"not a whole multiple of the {name} {step * 1e3:g} ms; nearest: {shown}")


def nearest_multiples(value: float, step: float) -> list[float]:
    """The whole multiples of ``step`` that enclose ``value``, without zero; empty if it is one already."""
    n_value, n_step = round(value * 1e9), round(step * 1e9)
    if n_step > 0 and n_value % n_step == 0 and n_value > 0:
        return []
    n_step = max(n_step, 1)
    below = n_value // n_step
    return [k * n_step / 1e9 for k in (below, below + 1) if k > 0]


RULES = (
    lockstep_marches,
    bounds_enclose_the_window,
    times_are_whole_multiples,
    duration_is_whole,
    frames_are_whole,
)
