"""Stresses of cells in a recording: those at which cells began to crack, and those of the cells that are used most."""

from __future__ import annotations

import numpy as np

from cosim.observer import RunInfo
from cosim.recording import messages, scenes
from cosim.recording.planes import rounded
from cosim.stresses import Line, Stresses
from coupling.interface import Array, Frame

BEGAN, WORST = "/ice/began", "/ice/strained"
TOPICS = (BEGAN, WORST)
NUMBERS = ("mean", "radius", "limit")


def began(info: RunInfo, frame: Frame) -> bytes | None:
    """`cosim.Stresses` of the cells that began to crack, or failed, in the window; None if there are none."""
    return None if info.strained is None else packed(frame.t_ns, info.strained.began())


def worst(info: RunInfo, frame: Frame) -> bytes | None:
    """`cosim.Stresses` of the cells that are used most."""
    return None if info.strained is None else packed(frame.t_ns, info.strained.worst())


def packed(t_ns: int, stresses: Stresses) -> bytes | None:
    """As a message, to 12 binary digits; None of no cell."""
    if not len(stresses.cell):
        return None
    lines = stresses.lines.values()
    message = messages.Stresses(
        name=list(stresses.lines),
        along_mean=[line.along_mean for line in lines],
        along_radius=[line.along_radius for line in lines],
        strength=[line.strength for line in lines],
        cell=stresses.cell.tolist(),
        criterion=stresses.criterion.tolist(),
        **{name: rounded(getattr(stresses, name)).tolist() for name in NUMBERS},
    )
    messages.stamp(message.stamp, t_ns)
    return scenes.as_bytes(message)


def unpacked(data: bytes) -> Stresses:
    """Of a message; ValueError if its parts do not fit together."""
    m = messages.Stresses.FromString(data)
    values = zip(m.name, m.along_mean, m.along_radius, m.strength, strict=True)
    lines = {name: Line(*numbers) for name, *numbers in values}
    cell, criterion = np.array(m.cell, np.int64), np.array(m.criterion, np.int64)
    columns: list[Array] = [np.array(getattr(m, name), float) for name in NUMBERS]
    if any(len(column) != len(cell) for column in (criterion, *columns)) or (criterion >= len(lines)).any():
        raise ValueError(f"stresses of {len(cell)} cells that do not fit together")
    if not (np.isfinite(columns).all() and (columns[2] > 0.0).all()):
        raise ValueError("stresses that are not finite")
    return Stresses(lines, cell, criterion, *columns)


def gathered(parts: list[Stresses]) -> Stresses | None:
    """All together; None without any. ValueError: they are not of one run."""
    if not parts:
        return None
    if any(part.lines != parts[0].lines for part in parts):
        raise ValueError("stresses against different criteria")
    names = ("cell", "criterion", *NUMBERS)
    return Stresses(parts[0].lines, *(np.concatenate([getattr(part, name) for part in parts]) for name in names))
