"""Channels of numbers and text: loads, balances, events. Each gives the serialised message of one window or event."""

from __future__ import annotations

import numpy as np
from foxglove_schemas_protobuf.Log_pb2 import Log

from cosim.analysis.run_data import MOTION
from cosim.moments import grip_of
from cosim.observer import RunInfo
from cosim.recording import messages, scenes
from coupling.interface import Event, Frame


def load(info: RunInfo, frame: Frame) -> bytes:
    """`cosim.Load`: totals and the three phases of force [N] and moment [N m], and where the load attacks [m]."""
    grip = grip_of(frame, info.scenario.moment_point)
    values = {
        messages.LOAD_FIELDS: (frame.load.sum(axis=0), frame.load.ravel()),
        messages.MOMENT_FIELDS: (grip.moment.sum(axis=0), grip.moment.ravel()),
        messages.GRIP_FIELDS: (grip.weight, grip.attack),
    }
    fields: dict[str, float] = {}
    for names, parts in values.items():
        fields |= zip(names, np.concatenate(parts).tolist(), strict=True)
    message = messages.Load(**fields)
    messages.stamp(message.stamp, frame.t_ns)
    return scenes.as_bytes(message)


def ledger(_info: RunInfo, frame: Frame) -> bytes | None:
    """`cosim.Ledger`: named balances [SI]."""
    return named(frame.t_ns, frame.ledger)


def budget(_info: RunInfo, frame: Frame) -> bytes | None:
    """`cosim.Ledger`: what carries the load, by name [N]."""
    return named(frame.t_ns, frame.budget)


def motion(_info: RunInfo, frame: Frame) -> bytes | None:
    """`cosim.Ledger`: displacement and velocity of the structure at the end of the window; None where it rests."""
    return None if frame.motion is None else named(frame.t_ns, dict(zip(MOTION, frame.motion.ravel(), strict=True)))


def named(t_ns: int, terms: dict[str, float]) -> bytes | None:
    """Numbers by name as a `cosim.Ledger`; None if there are none."""
    if not terms:
        return None
    message = messages.Ledger(name=list(terms), value=[float(v) for v in terms.values()])
    messages.stamp(message.stamp, t_ns)
    return scenes.as_bytes(message)


def event(_info: RunInfo, item: Event) -> bytes:
    """`cosim.Event`: an event as data."""
    values = dict(zip(("fx", "fy", "fz", "x", "y", "z"), (*item.force, *item.position), strict=True))
    values |= {"length": item.length, "area": item.area}
    message = messages.Event(
        kind=item.kind,
        cells=int(item.cells),
        text=item.text,
        cause=item.cause,
        **{name: float(value) for name, value in values.items()},
    )
    messages.stamp(message.stamp, item.t_ns)
    return scenes.as_bytes(message)


def event_line(_info: RunInfo, item: Event) -> bytes:
    """An event as a line of the log, for people."""
    message = Log(level=Log.INFO, message=f"{item.kind}: {item.text}", name=item.kind)
    messages.stamp(message.timestamp, item.t_ns)
    return scenes.as_bytes(message)
