"""Pictures of a recording: sheet, blocks and forces of a recorded frame, packed and unpacked.

Every picture stands for itself. Places are kept to `quantum_of` the ice, 1/1024 of its thickness; damage and
utilisation to 1/128; forces to 12 binary digits.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from cosim.observer import RunInfo
from cosim.recording import messages, scenes
from cosim.recording.planes import (
    pack,
    pack_bits,
    pack_numbers,
    rounded,
    unpack,
    unpack_bits,
    unpack_numbers,
)
from coupling.attack import PointForces, point_forces
from coupling.interface import Array, BoolArray, Frame, IntArray, SheetView

SHEET, BLOCKS, CONTACT = "/ice/sheet", "/rubble/blocks", "/load/contact"
TOPICS = (SHEET, BLOCKS, CONTACT)
SHARE = 1.0 / 128.0  #: to which damage and utilisation are kept
MOST = 4.0  #: utilisation beyond this one is kept as this one


@dataclass(frozen=True, slots=True)
class BlockShapes:
    """All blocks of the rubble as bodies, n of them."""

    id: IntArray  #: (n,) number of the block, never reused
    section: IntArray  #: (n,) section it moves in
    phase: IntArray  #: (n,) `Phase`
    width: Array  #: (n,) mean extent along y [m]
    position: Array  #: (n, 3) centre of mass [m]
    outline: Array  #: (v, 2) corners of all blocks in the x-z plane, counter-clockwise [m]
    offset: IntArray  #: (n + 1,) block i owns outline[offset[i]:offset[i + 1]]

    @property
    def count(self) -> int:
        """Number of blocks."""
        return len(self.id)


@dataclass(frozen=True, slots=True)
class Picture:
    """What a recorded frame shows."""

    t_ns: int
    sheet: SheetView
    blocks: BlockShapes
    forces: PointForces
    elastic: BoolArray | None = None  #: (c,) cells that have not begun to crack; None: unknown

    @property
    def begun(self) -> BoolArray:
        """(c,) cells that have begun to crack and still hold their nodes together; none where that is unknown."""
        intact = self.sheet.intact
        return np.zeros(len(intact), bool) if self.elastic is None else intact & ~self.elastic


def quantum_of(thickness: float) -> float:
    """To which places are kept, of ice of this thickness [m]."""
    return thickness / 1024.0


def sheet(info: RunInfo, frame: Frame) -> bytes:
    """`cosim.Sheet`: nodes as steps away from a grid, whose first node and distances stand in the message."""
    view, quantum = frame.sheet, quantum_of(info.thickness)
    here = view.present
    first, step = _grid(view)
    away = np.where(here[:, None], view.position - _places(view.shape, first, step), 0.0)
    strain = np.where(here, np.clip(np.nan_to_num(view.utilisation, posinf=MOST), 0.0, MOST), 0.0)
    message = messages.Sheet(
        rows=view.shape[0],
        columns=view.shape[1],
        quantum=quantum,
        damage=pack_numbers(np.where(here, view.damage, 0.0), SHARE),
        utilisation=pack_numbers(strain, SHARE),
        present=pack_bits(here),
        intact=pack_bits(view.intact),
        elastic=b"" if info.strained is None else pack_bits(info.strained.elastic),
        **dict(zip(("x", "y", "step_x", "step_y"), (*first, *step), strict=True)),
        **{name: pack_numbers(away[:, k], quantum) for k, name in enumerate(("dx", "dy", "z"))},
    )
    messages.stamp(message.stamp, frame.t_ns)
    return scenes.as_bytes(message)


def blocks(info: RunInfo, frame: Frame) -> bytes:
    """`cosim.Blocks`: corners as steps away from their block's centre."""
    table, quantum = frame.blocks, quantum_of(info.thickness)
    corners = np.diff(table.offset)
    away = table.outline - np.repeat(table.position[:, [0, 2]], corners, axis=0)
    message = messages.Blocks(
        quantum=quantum,
        id=pack(table.id),
        section=pack(table.section),
        phase=pack(table.phase),
        corners=pack(corners),
        width=pack_numbers(table.width, quantum),
        corner_x=pack_numbers(away[:, 0], quantum),
        corner_z=pack_numbers(away[:, 1], quantum),
        **{name: pack_numbers(table.position[:, k], quantum) for k, name in enumerate("xyz")},
    )
    messages.stamp(message.stamp, frame.t_ns)
    return scenes.as_bytes(message)


def contact(info: RunInfo, frame: Frame) -> bytes:
    """`cosim.Contact`: forces of the ice on the structure [N] at their places [m], of nodes (block -1) and blocks."""
    forces, quantum = point_forces(frame.contact, frame.blocks), quantum_of(info.thickness)
    message = messages.Contact(
        phase=forces.phase.tolist(),
        block=forces.block.tolist(),
        **{name: (np.rint(forces.position[:, k] / quantum) * quantum).tolist() for k, name in enumerate("xyz")},
        **{f"f{name}": rounded(forces.force[:, k]).tolist() for k, name in enumerate("xyz")},
    )
    messages.stamp(message.stamp, frame.t_ns)
    return scenes.as_bytes(message)


def pictures(stored: Iterable[tuple[str, int, bytes]]) -> Iterator[Picture]:
    """The pictures of a recording, of its messages of `TOPICS`, in order. ValueError: they do not fit together."""
    parts: dict[str, Any] = {}
    elastic: BoolArray | None = None
    for topic, t_ns, data in stored:
        parts[topic] = READ[topic](data)
        if topic == SHEET:
            elastic = _elastic(data, len(parts[SHEET].intact))
        if topic == TOPICS[-1]:  # written last
            if set(parts) != set(TOPICS):
                raise ValueError(f"the picture at {t_ns / 1e9:g} s is not whole")
            yield Picture(t_ns, parts[SHEET], parts[BLOCKS], parts[CONTACT], elastic)
            parts = {}


def _read_sheet(data: bytes) -> SheetView:
    m = messages.Sheet.FromString(data)
    if not (m.rows and m.columns and m.quantum > 0.0):
        raise ValueError(f"a sheet of {m.rows} x {m.columns} nodes")
    shape = (m.rows, m.columns)
    cells = (max(m.rows - 1, 0), max(m.columns - 1, 0))
    away = np.stack([unpack_numbers(part, m.quantum) for part in (m.dx, m.dy, m.z)], axis=1)
    place = _places(shape, (m.x, m.y), (m.step_x, m.step_y))
    damage, utilisation = (unpack_numbers(part, SHARE) for part in (m.damage, m.utilisation))
    if not len(place) == len(away) == len(damage) == len(utilisation):
        raise ValueError(f"a sheet of {len(place)} nodes with places of {len(away)}")
    present, intact = unpack_bits(m.present, len(place)), unpack_bits(m.intact, cells[0] * cells[1])
    return SheetView(place + away, damage, utilisation, present, intact, shape, cells)


def _elastic(data: bytes, cells: int) -> BoolArray | None:
    packed = messages.Sheet.FromString(data).elastic
    return unpack_bits(packed, cells) if packed else None


def _read_blocks(data: bytes) -> BlockShapes:
    m = messages.Blocks.FromString(data)
    if not m.quantum > 0.0:
        raise ValueError("blocks without a quantum")
    position = np.stack([unpack_numbers(part, m.quantum) for part in (m.x, m.y, m.z)], axis=1)
    away = np.stack([unpack_numbers(part, m.quantum) for part in (m.corner_x, m.corner_z)], axis=1)
    corners = unpack(m.corners)
    outline = np.repeat(position[:, [0, 2]], corners, axis=0) + away
    offset = np.concatenate(([0], np.cumsum(corners))).astype(np.int64)
    whole = (unpack(m.id), unpack(m.section), unpack(m.phase))
    return BlockShapes(*whole, unpack_numbers(m.width, m.quantum), position, outline, offset)


def _read_contact(data: bytes) -> PointForces:
    m = messages.Contact.FromString(data)
    return PointForces(
        np.array([m.x, m.y, m.z], float).T.reshape(-1, 3),
        np.array([m.fx, m.fy, m.fz], float).T.reshape(-1, 3),
        np.array(m.phase, np.int64),
        np.array(m.block, np.int64),
    )


READ: dict[str, Any] = {SHEET: _read_sheet, BLOCKS: _read_blocks, CONTACT: _read_contact}


def _grid(view: SheetView) -> tuple[tuple[float, float], tuple[float, float]]:
    """First node and distances of the even grid that the nodes stand nearest to; zeros for a sheet without any."""
    here = np.flatnonzero(view.present)
    if not len(here):
        return (0.0, 0.0), (0.0, 0.0)
    line = np.divmod(here, view.shape[1])
    fits = [_line(line[k].astype(float), view.position[here, k]) for k in (0, 1)]
    return (fits[0][0], fits[1][0]), (fits[0][1], fits[1][1])


def _line(number: Array, place: Array) -> tuple[float, float]:
    """Place of number 0 and distance from one to the next, by the median of the steps that the nodes make."""
    low, high = number.min(), number.max()
    if low == high:
        return float(np.median(place)), 0.0
    step = float(np.median(place[number == high]) - np.median(place[number == low])) / (high - low)
    return float(np.median(place - step * number)), step


def _places(shape: tuple[int, int], first: tuple[float, float], step: tuple[float, float]) -> Array:
    """The grid, (rows x columns, 3) [m]; at z = 0."""
    row, column = np.divmod(np.arange(shape[0] * shape[1]), max(shape[1], 1))
    return np.stack((first[0] + step[0] * row, first[1] + step[1] * column, np.zeros(len(row))), axis=1)
