"""The sheet as the rubble of one section meets it: its edge and its underside, as a body that moves without turning.

A kinematic sheet would jam plates against the structure with unlimited force: it answers to them, in one of two ways.

In lockstep its nodes are bodies of the contact solver, with the mass that they have in the lattice. Before every
sub-step they are put where the lattice has them (`MEETS`), and their velocity grows by what the lattice alone would
do; the impulses that stop them act on the lattice in the same time.

Window by window the nodes move as the lattice says, and the edge of each section yields to what the rubble does beyond
the forces that the lattice knows already (``carried``): all edges together are one body with a matrix W in place of an
inverse mass (`yields`), which moves beside the nodes with w,

    w' = w + W (sum J - F_carried dt)   per sub-step, w = 0 at the start of the window.

W = G / T^2 follows from the compliance G of the lattice over a window T (`coupling.sheet_port.yielding`). An edge that
is stopped at the start of a window takes the impulse J = W^-1 v: the mean force J / T = G^-1 v T is that under which
the lattice stays where it is stopped.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import pymunk

from rubble.arrays import Array, IntArray, record, rows
from rubble.compiled import compiled
from rubble.pointers import address

#: a node of the sheet: place x, z [m]; the same where the outline of the sheet has it, relative to the foremost node of
#: its section [m]; velocity [m/s]; what the lattice adds to it in a sub-step [m/s]; inverse mass, 0 where it moves as
#: the lattice says [1/kg]; the impulse on it over a window [N s]
NODE = record(
    *("x", "z", "outline_x", "outline_z", "v_x", "v_y", "v_z", "gain_x", "gain_y", "gain_z"),
    *("light_x", "light_y", "light_z", "impulse_x", "impulse_y", "impulse_z"),
)
#: what a sub-step is told of a node in lockstep, in this order
MEETS = ("x", "z", "v_x", "v_y", "v_z", "gain_x", "gain_y", "gain_z", "light_x", "light_y", "light_z")
#: their places among the numbers of a node, and those of its impulse
MET, IMPULSE = [(NODE.names or ()).index(name) for name in MEETS], slice((NODE.names or ()).index("impulse_x"), None)
ICE, SHEET_CATEGORY, STRUCTURE_CATEGORY = 1, 0b10, 0b100  #: collision type and categories, see `section`

SAME = 1e-9 / 3.0  #: places that are nearer to each other are one, in thicknesses


@dataclass(frozen=True)
class SheetMotion:
    """The sheet in one section in a window: its nodes, front first, and how they move."""

    x: Array  #: (m,) of the nodes at the start, decreasing [m]
    z: Array  #: (m,) middle of the thickness [m]
    front: float  #: x of the sheet's foremost point [m]
    velocity: Array  #: (m, 2) of the nodes in x and z, mean over the window [m/s]; without meaning in lockstep
    thickness: float  #: [m]
    applied: tuple[float, float] = (0.0, 0.0)  #: F_carried above, x and z [N]

    def __post_init__(self) -> None:
        for name in ("x", "z"):
            object.__setattr__(self, name, np.array(getattr(self, name), dtype=np.float64).reshape(-1))
        x, m = self.x, len(self.x)
        if m == 0 or m != len(self.z) or (np.diff(x) >= 0).any() or self.front < x[0]:
            raise ValueError(f"sheet: node x must decrease, front {self.front:g} lie ahead; got {x}")
        object.__setattr__(self, "velocity", np.array(self.velocity, dtype=np.float64).reshape(m, 2))


class Sheets(NamedTuple):
    """The sheet in k sections in a window, one after the other."""

    x: Array  #: (n,) of the nodes at the start [m]
    z: Array  #: (n,) middle of the thickness [m]
    velocity: Array  #: (n, 2) as in `SheetMotion`
    offset: IntArray  #: (k + 1,) section i has the nodes offset[i] to offset[i + 1]
    front: Array  #: (k,) x of the foremost points [m]
    applied: Array  #: (k, 2) F_carried above [N]
    thickness: float  #: [m]

    @classmethod
    def of(cls, motion: SheetMotion) -> Sheets:
        """In one section."""
        ends, front, applied = np.array([0, len(motion.x)]), np.array([motion.front]), np.array([motion.applied])
        return cls(motion.x, motion.z, motion.velocity, ends, front, applied, motion.thickness)


class SheetBody:
    """Sheet edge of one section: its body, its shapes, and the nodes to which forces return."""

    def __init__(self, space: pymunk.Space) -> None:
        self.nodes = np.zeros(0, NODE)
        self.place, self.applied = np.zeros(2), np.zeros(2)
        self.corners = np.zeros((0, 4, 2))  #: of its shapes
        self.enter(space)

    def enter(self, space: pymunk.Space) -> None:
        """Stand in a space, with the shapes that it has."""
        self.space, self.body = space, pymunk.Body(1.0, float("inf"))
        self.body.position = float(self.place[0]), float(self.place[1])
        self.shapes: list[pymunk.Poly] = []
        space.add(self.body)
        self.replace_shapes(self.corners)

    def __getstate__(self) -> dict[str, object]:
        return {k: v for k, v in self.__dict__.items() if k not in ("space", "body", "shapes", "addresses")}

    @property
    def address(self) -> int:
        """Where pymunk keeps the body."""
        return address(self.body._body)

    @property
    def impulse(self) -> Array:
        """(m, 3) on the nodes over the window; a view [N s]."""
        return rows(self.nodes)[:, IMPULSE]

    def replace_shapes(self, local: Array) -> None:
        """Other shapes, with corners (polygons, 4, 2): their contacts begin anew."""
        self.space.remove(*self.shapes)
        self.shapes = [pymunk.Poly(self.body, corners) for corners in local.tolist()]
        free = pymunk.ShapeFilter.ALL_MASKS() ^ STRUCTURE_CATEGORY
        for shape in self.shapes:
            shape.collision_type = ICE
            shape.filter = pymunk.ShapeFilter(categories=SHEET_CATEGORY, mask=free)
        self.space.add(*self.shapes)
        self.addresses = np.array([address(shape._shape) for shape in self.shapes], np.int64)
        self.corners = local

    def remove(self) -> None:
        """Take the sheet out of the section."""
        self.space.remove(*self.shapes, self.body)


@compiled(nogil=True)
def sheet_polygons(x: Array, z: Array, front: float, thickness: float, tolerance: float) -> Array:
    """Corners (p, 4, 2) of the sheet: its nodes joined by straight pieces, as long as they stay within ``tolerance``.

    Few long pieces, because a block that slides along the underside catches on the joints. Ahead of the first node
    the sheet goes on straight to ``front``.
    """
    line = np.empty((max(x.shape[0], 2), 2))
    line[: x.shape[0], 0], line[: x.shape[0], 1] = x, z
    if x.shape[0] == 1:  # half a cell on both sides
        line[1, 0], line[1, 1] = x[0] - max(front - x[0], thickness / 3000.0), z[0]
    if front - x[0] > SAME * thickness:
        slope = (line[0, 1] - line[1, 1]) / (line[0, 0] - line[1, 0])
        line[0, 0], line[0, 1] = front, line[0, 1] + slope * (front - x[0])
    pieces: Array = _pieces(line, thickness / 2, tolerance)
    return pieces


@compiled("float64[:, :, ::1](float64[:, ::1], float64, float64)", nogil=True)
def _pieces(line: Array, half: float, tolerance: float) -> Array:
    """The straight pieces of a line (n, 2) with x decreasing, as counter-clockwise quadrangles of thickness 2 half.

    Sections of the plate stay plane and turn with it: a corner at the height ``above`` the line stands at
    ``x - above slope``, with the mean slope where two pieces meet.
    """
    joints = np.zeros(line.shape[0], np.int64)
    count = 0
    while joints[count] < line.shape[0] - 1:
        start = joints[count]
        end, fits = start + 1, True
        while fits and end + 1 < line.shape[0]:
            slope = (line[end + 1, 1] - line[start, 1]) / (line[end + 1, 0] - line[start, 0])
            for k in range(start + 1, end + 1):
                off = line[k, 1] - line[start, 1] - slope * (line[k, 0] - line[start, 0])
                fits = fits and abs(off) <= tolerance
            if fits:
                end += 1
        count += 1
        joints[count] = end
    lean, out = np.zeros(count + 1), np.empty((count, 4, 2))
    for p in range(count):
        a, b = joints[p], joints[p + 1]
        slope = (line[b, 1] - line[a, 1]) / (line[b, 0] - line[a, 0])
        lean[p] += slope if p == 0 else 0.5 * slope
        lean[p + 1] += slope if p == count - 1 else 0.5 * slope
    for p in range(count):
        for c in range(4):
            j, above = (p + 1 if c in (0, 3) else p), (-half if c < 2 else half)
            out[p, c, 0], out[p, c, 1] = line[joints[j], 0] - above * lean[j], line[joints[j], 1] + above
    return out
