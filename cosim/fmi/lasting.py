"""Instances that outlive an exception.

When a call from outside raises, the library around a script (pythonfmu 0.7, pythonfmu3 0.3) gives back its references
to the class, the instance and its log, answers `fatal` as it should, and goes on to use them: the next collection of
garbage takes them away from under it. The references are given to it anew before the exception leaves.
"""

from __future__ import annotations

import ctypes
import functools
from collections.abc import Callable
from typing import Any, TypeVar

T = TypeVar("T", bound=type)

#: what the library calls
ENTRIES = ("setup_experiment", "enter_initialization_mode", "exit_initialization_mode", "do_step", "terminate")
STATES = ("_get_fmu_state", "_set_fmu_state")
ACCESS = ("get_", "set_")  #: begin the names of the rest


def lasting(script: T) -> T:
    """A class of pythonfmu or pythonfmu3, with its entries guarded."""
    for name in dir(script):
        if name in ENTRIES + STATES or name.startswith(ACCESS):
            setattr(script, name, _guarded(getattr(script, name)))
    return script


def _guarded(entry: Callable[..., Any]) -> Callable[..., Any]:
    @functools.wraps(entry)
    def call(self: Any, *given: Any) -> Any:
        try:
            return entry(self, *given)
        except BaseException:
            for thing in (type(self), self, self._get_log_queue()):
                ctypes.pythonapi.Py_IncRef(ctypes.py_object(thing))
            raise

    return call
