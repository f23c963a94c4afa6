"""What may meet between two sections in a window: slices with slices, and slices with the sides of the sheet."""

from __future__ import annotations

import numpy as np

from rubble.arrays import filled_room
from rubble.banks import Banks, bank_room, find_banks
from rubble.gather import Scene
from rubble.sides import Sides, find_sides, side_room


class Neighbours:
    """Finds the pairs; remembers how many there were, for the room of the next window."""

    def __init__(self, thickness: float) -> None:
        self._thickness = thickness
        self._most_sides, self._most_banks = 256, 64

    def find(self, scene: Scene) -> tuple[Sides, Banks]:
        """Pairs of slices that may meet between two sections, and slices that may meet a side of the sheet."""
        section, pieces = scene.slices.section, scene.pieces
        order = np.argsort(section, kind="stable")
        first = np.searchsorted(section[order], np.arange(len(scene.sections.y) + 1))
        sides = filled_room(side_room, self._most_sides, lambda into: find_sides(scene, pieces, first, order, into))
        banks = filled_room(bank_room, self._most_banks, lambda into: find_banks(scene, pieces, self._thickness, into))
        self._most_sides = max(self._most_sides, len(sides.area))
        self._most_banks = max(self._most_banks, len(banks.area))
        return sides, banks


def no_neighbours() -> tuple[Sides, Banks]:
    """None."""
    return side_room(0), bank_room(0)
