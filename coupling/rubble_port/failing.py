"""Errors of the rubble as those of a simulation."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from coupling.interface import SimulationError


@contextmanager
def failing() -> Iterator[None]:
    """What the rubble cannot go on with ends the run, with its line."""
    try:
        yield
    except RuntimeError as error:
        raise SimulationError(str(error)) from error
