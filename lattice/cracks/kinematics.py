"""Strain of a layered cell from the displacements of its nodes, in the axes of its crack.

Nodes lie in rows of ``my`` places; node 0 (-, -) of a cell is at b, 1 (+, -) at b + my, 2 (-, +) at b + 1 and
3 (+, +) at b + my + 1. A displacement y is (5, nodes): u_x, u_y, w, phi_x, phi_y.
"""

from __future__ import annotations

from typing import NamedTuple

from lattice.compiled import compiled
from lattice.explicit.layout import PHI_X, PHI_Y, U_X, U_Y, W
from lattice.grid import Array

Edges = tuple[float, float, float, float]  #: a value of each edge spring 0-1, 2-3, 0-2, 1-3


class Strain(NamedTuple):
    """Mean membrane strain and curvature of a cell; shear in engineering measure."""

    n: float  #: across the crack (or along x) [-]
    t: float  #: along the crack (or along y) [-]
    g: float  #: shear [-]
    kn: float  #: [1/m]
    kt: float  #: [1/m]
    kg: float  #: [1/m]


class Pose(NamedTuple):
    """Where the nodes of a cell are, as its law asks, or how fast they go."""

    strain: Strain  #: in the axes of the sheet
    long: Edges  #: elongations of the edge springs [m]


class Hourglass(NamedTuple):
    """The modes of a cell's nodes without mean strain, over 2 d, of u_x, u_y [-] and phi_x, phi_y [1/m]."""

    x: float
    y: float
    tx: float
    ty: float


@compiled(inline="always")
def gradients(b: int, my: int, q: float, y: Array) -> tuple[float, float, float]:
    """d/dx, d/dy and the hourglass mode of one component y (nodes,); ``q`` is 1 / 2 d."""
    A, B, C, D = y[b], y[b + my], y[b + 1], y[b + my + 1]
    return (B - A + D - C) * q, (C - A + D - B) * q, (A - B - C + D) * q


@compiled(inline="always")
def strain_of(b: int, my: int, q: float, y: Array) -> tuple[Strain, Hourglass]:
    """In the axes of the sheet."""
    xx, xy, hx = gradients(b, my, q, y[U_X])
    yx, yy, hy = gradients(b, my, q, y[U_Y])
    px, py, tx = gradients(b, my, q, y[PHI_X])
    rx, ry, ty = gradients(b, my, q, y[PHI_Y])
    return Strain(xx, yy, xy + yx, px, ry, py + rx), Hourglass(hx, hy, tx, ty)


@compiled(inline="always")
def leaned(e: Strain, b: int, lean: Array) -> Strain:
    """With the membrane strain ``lean`` (3, nodes) that the cell at b has from its slope."""
    return Strain(e.n + lean[0, b], e.t + lean[1, b], e.g + lean[2, b], e.kn, e.kt, e.kg)


@compiled(inline="always")
def turned(e: Strain, c: float, s: float) -> Strain:
    """The strain in axes turned by the angle of cosine c and sine s."""
    cc, ss, cs = c * c, s * s, c * s
    return Strain(
        cc * e.n + ss * e.t + cs * e.g,
        ss * e.n + cc * e.t - cs * e.g,
        2.0 * cs * (e.t - e.n) + (cc - ss) * e.g,
        cc * e.kn + ss * e.kt + cs * e.kg,
        ss * e.kn + cc * e.kt - cs * e.kg,
        2.0 * cs * (e.kt - e.kn) + (cc - ss) * e.kg,
    )


@compiled(inline="always")
def turned_back(Nn: float, Nt: float, Ng: float, c: float, s: float) -> tuple[float, float, float]:
    """Stress resultants in the axes of the sheet."""
    cc, ss, cs = c * c, s * s, c * s
    return cc * Nn + ss * Nt - 2.0 * cs * Ng, ss * Nn + cc * Nt + 2.0 * cs * Ng, cs * (Nn - Nt) + (cc - ss) * Ng


@compiled(inline="always")
def elongations(b: int, my: int, half: float, y: Array) -> Edges:
    """Of the edge springs 0-1, 2-3, 0-2, 1-3 [m]; ``half`` is d / 2."""
    w, px, py = y[W], y[PHI_X], y[PHI_Y]
    w0, w1, w2, w3 = w[b], w[b + my], w[b + 1], w[b + my + 1]
    return (
        w1 - w0 + half * (px[b] + px[b + my]),
        w3 - w2 + half * (px[b + 1] + px[b + my + 1]),
        w2 - w0 + half * (py[b] + py[b + 1]),
        w3 - w1 + half * (py[b + my] + py[b + my + 1]),
    )


@compiled(inline="always")
def pose_of(b: int, my: int, d: float, y: Array) -> Pose:
    """Of the cell at b, of size d [m], at the displacements y (5, nodes)."""
    strain, _ = strain_of(b, my, 0.5 / d, y)
    return Pose(strain, elongations(b, my, 0.5 * d, y))


@compiled(inline="always")
def plus(a: Pose, t: float, b: Pose) -> Pose:
    """A + t b."""
    (n, t_, g, kn, kt, kg), (i, j, k, m) = a.strain, a.long
    e, long = b.strain, b.long
    strain = Strain(n + t * e.n, t_ + t * e.t, g + t * e.g, kn + t * e.kn, kt + t * e.kt, kg + t * e.kg)
    return Pose(strain, (i + t * long[0], j + t * long[1], k + t * long[2], m + t * long[3]))
