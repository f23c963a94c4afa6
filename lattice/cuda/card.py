"""The arrays of a sheet on the card, and who has the last word on them: the card or the host."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import cuda
from numpy.typing import NDArray

from lattice.cuda.kernels import Lattice, fold
from lattice.explicit.layout import Intact, Mesh, Motion, PerNode
from lattice.explicit.screen import Screen
from lattice.grid import Array

ROW, LIST = 64, 128  #: threads of a block along a row of nodes, and along a list

Grid = tuple[tuple[int, int], tuple[int, int]]


def over_nodes(nx: int, ny: int) -> Grid:
    """Blocks and threads for arrays of (nx, ny)."""
    threads = min(ROW, ny)
    return (-(-ny // threads), nx), (threads, 1)


def over(n: int) -> tuple[int, int]:
    """Blocks and threads for a list of n."""
    threads = min(LIST, max(1, n))
    return max(1, -(-n // threads)), threads


def copied(array: NDArray[Any]) -> Any:
    """A copy on the card."""
    return cuda.to_device(np.ascontiguousarray(array))


def back(array: Any) -> Array:
    """A copy on the host of one on the card."""
    on_host: Array = array.copy_to_host()
    return on_host


class Card:
    """Copies on the card. A checkpoint has none of them: they are made anew from what the host has."""

    def __init__(self) -> None:
        self.drop()

    def __getstate__(self) -> dict[str, Any]:
        return {}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.drop()

    def drop(self) -> None:
        """Nothing is on the card."""
        self.lattice: Lattice | None = None
        self.ahead = False  #: the motion on the card is newer than that of the host
        self.behind = True  #: that of the host may be newer
        self._y: tuple[Any, Any] | None = None

    def take(self, mesh: Mesh, screen: Screen, host: Motion) -> Lattice:
        """Brings to the card what it lacks."""
        if self.lattice is None:
            self.lattice = _lattice(mesh, screen)
            nx, ny = mesh.mass.shape
            self.loss, self.columns = copied(np.zeros((nx, ny))), cuda.device_array(ny)
            self.grid = over_nodes(nx, ny)
        if self._y is None:
            self._y = copied(host.y), copied(host.y)
            self.v, self.before = copied(host.v), copied(host.v)
        elif self.behind:
            self._y[0].copy_to_device(host.y)
            self.v.copy_to_device(host.v)
        self.behind = False
        return self.lattice

    def motions(self) -> tuple[Motion, Motion]:
        """Now, and with room for the next sub-step; they take turns."""
        assert self._y is not None
        return Motion(self._y[0], self.v), Motion(self._y[1], self.v)

    def marched(self, steps: int) -> None:
        """So many sub-steps were made."""
        if self._y is not None and steps % 2:
            self._y = self._y[::-1]
        self.ahead = True

    def give(self, host: Motion) -> None:
        """Brings the motion to the host, where it may be changed."""
        if self.ahead and self._y is not None:
            self._y[0].copy_to_host(host.y)
            self.v.copy_to_host(host.v)
        self.ahead, self.behind = False, True

    def taken(self) -> float:
        """What damping has taken since it was last asked [J]."""
        fold[over(self.columns.size)](self.loss, self.columns)
        return float(back(self.columns).sum())


def _lattice(mesh: Mesh, screen: Screen) -> Lattice:
    return Lattice(
        Intact(*map(copied, mesh.intact)),
        PerNode(*map(copied, mesh.kick)),
        copied(mesh.mass),
        copied(mesh.threshold),
        Screen(screen.F_1, copied(screen.fibre)),
        mesh.springs,
        mesh.pace,
    )
