"""What the scripts inside FMUs share, whatever their version: values by name, and steps that pass no exception on."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from cosim.analysis.run_data import MOTION
from cosim.fmi.ice import Ice, Refused
from cosim.fmi.names import BY_PHASE, LOAD, TIME
from cosim.scenario.loading import load_scenario


class Driven:
    """A case in the folder of an FMU's resources, with the values of its variables."""

    def __init__(self, resources: str) -> None:
        """InputError or ScenarioError if the scenario there cannot be read."""
        self.scenario = load_scenario(str(Path(resources) / "scenario.toml"))
        self.window, self.end = self.scenario.window_ns / 1e9, self.scenario.duration_ns / 1e9  #: [s]
        self.values = dict.fromkeys((TIME, *MOTION, *LOAD, *BY_PHASE), 0.0)
        self._ice: Ice | None = None
        self._stopped = ""  #: why the run cannot go on

    def start(self) -> None:
        """The case is built; errors as those of `Ice`."""
        self._ice, self._stopped = Ice(self.scenario), ""

    def close(self) -> None:
        """Nothing comes after it but a new start."""
        self._stopped = "a step after the end"

    def step(self, t: float, length: float) -> tuple[bool, str]:
        """One step. Whether the run can go on from here, and what is wrong: nothing if the step was done."""
        if self._ice is None:
            return True, "a step before the initialization has ended"
        if self._stopped:
            return False, self._stopped
        moved = np.array([self.values[name] for name in MOTION])
        try:
            self._ice.step(t, length, moved[:6], moved[6:])
        except Refused as error:
            return True, str(error)
        except Exception as error:  # nothing may pass the border of the library
            self._stopped = f"{type(error).__name__}: {error}"
            return False, self._stopped
        self.values |= {TIME: self._ice.t, **self._ice.loads}
        return True, ""

    def state(self) -> dict[str, Any]:
        """What a master keeps to come back to."""
        return {"of": self, "back": self.save()}

    def go_back(self, state: dict[str, Any]) -> None:
        """To a state of this instance; ValueError for one of another instance."""
        if state["of"] is not self:
            raise ValueError("a state of another instance of the ice")
        state["back"]()

    def save(self) -> Callable[[], None]:
        """The case and its values between two steps; calling it sets them back."""
        back, values, stopped = None if self._ice is None else self._ice.save(), dict(self.values), self._stopped

        def restore() -> None:
            if back is not None:
                back()
            self.values.update(values)
            self._stopped = stopped

        return restore
