"""The script of `tower_fmu.py` for FMI 3.0: the same spring, the same exact step."""

import numpy as np
from pythonfmu3 import Float64, Fmi3Causality, Fmi3Slave
from pythonfmu3.enums import Fmi3Status
from pythonfmu3.fmi3slave import Fmi3StepResult

from coupling.structure.motion import spring


class Tower(Fmi3Slave):
    """1000 t on 4 MN/m in surge, damped."""

    def __init__(self, **given):
        super().__init__(**given)
        self.time = self.fx = self.surge = self.surge_rate = 0.0
        self.register_variable(Float64("time", causality=Fmi3Causality.independent))
        self.register_variable(Float64("fx", causality=Fmi3Causality.input))
        for name in ("surge", "surge_rate"):
            self.register_variable(Float64(name, causality=Fmi3Causality.output))
        self.tower = spring([0], np.diag([1e6]), np.diag([4e4]), np.diag([4e6]))

    def do_step(self, current_time, step_size):
        if self.fx > LIMIT:
            return Fmi3StepResult(status=Fmi3Status.error)
        self.tower.advance(current_time, step_size, np.array([self.fx, 0, 0, 0, 0, 0]))
        self.time = current_time + step_size
        self.surge, self.surge_rate = float(self.tower.displacement[0]), float(self.tower.velocity[0])
        return Fmi3StepResult(terminateSimulation=self.time > END)

    def _get_fmu_state(self):
        return {"back": self.tower.save(), "values": (self.time, self.surge, self.surge_rate)}

    def _set_fmu_state(self, state):
        state["back"]()
        self.time, self.surge, self.surge_rate = state["values"]


LIMIT, END = 1e12, 1e9  #: load [N] that it does not bear, and time [s] at which it wants to end
