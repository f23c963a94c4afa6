"""What is read off the motion on the card between two marches: as `lattice.explicit.readings`."""

from __future__ import annotations

from numba import cuda

from lattice.cuda.kernels import kernel
from lattice.cuda.law import moved, point
from lattice.explicit.layout import Motion, W
from lattice.grid import Array, IntArray


@kernel
def points(row: IntArray, column: IntArray, height: Array, lead: Array, motion: Motion, ago: float, out: Array) -> None:
    """Displacements of the points of action (m, 3) [m]."""
    k = cuda.grid(1)
    if k < out.shape[0]:
        out[k, 0], out[k, 1], out[k, 2] = point(row[k], column[k], height[k], lead[k], motion, ago)


@kernel
def deflections(motion: Motion, ago: float, before: Array) -> None:
    """Deflection and rotations now into (3, n_x, ny)."""
    j, i = cuda.grid(2)
    if i < before.shape[1] and j < before.shape[2]:
        for c in range(3):
            before[c, i, j] = moved(W + c, i, j, motion, ago)


@kernel
def add_path(motion: Motion, ago: float, half: float, before: Array, total: Array) -> None:
    """Adds ``half`` a time [s] of the deflections ``before`` and now to their integral, (3, n_x, ny) both."""
    j, i = cuda.grid(2)
    if i < total.shape[1] and j < total.shape[2]:
        for c in range(3):
            total[c, i, j] += half * (before[c, i, j] + moved(W + c, i, j, motion, ago))
