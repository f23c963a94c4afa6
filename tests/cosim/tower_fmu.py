"""Script of an FMU for tests: one degree of freedom on a spring, solved by the same exact step as ours."""

import numpy as np
from pythonfmu import Fmi2Causality, Fmi2Slave, Real

from coupling.structure.motion import spring


class Tower(Fmi2Slave):
    """1000 t on 4 MN/m in surge, damped."""

    def __init__(self, **given):
        super().__init__(**given)
        self.fx = self.surge = self.surge_rate = 0.0
        self.register_variable(Real("fx", causality=Fmi2Causality.input))
        for name in ("surge", "surge_rate"):
            self.register_variable(Real(name, causality=Fmi2Causality.output))
        self.tower = spring([0], np.diag([1e6]), np.diag([4e4]), np.diag([4e6]))

    def do_step(self, current_time, step_size):
        self.tower.advance(current_time, step_size, np.array([self.fx, 0, 0, 0, 0, 0]))
        self.surge, self.surge_rate = float(self.tower.displacement[0]), float(self.tower.velocity[0])
        return self.surge < 10.0

    def _get_fmu_state(self):
        return {"back": self.tower.save(), "values": (self.surge, self.surge_rate)}

    def _set_fmu_state(self, state):
        state["back"]()
        self.surge, self.surge_rate = state["values"]
