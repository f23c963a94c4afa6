"""Forces on a sheet that tests push it with."""

import numpy as np


class Push:
    """Constant forces (m, 3) on nodes at a height."""

    def __init__(self, nodes, force, height, lead=0.0):
        self.nodes, self.force = nodes, force
        self.height, self.lead = np.full(len(nodes), height), np.full(len(nodes), lead)

    def evaluate(self, t, y):
        return self.force, np.zeros((len(y), 3, 3))


def no_force(grid):
    return np.zeros((grid.nodes, 2)), np.zeros((grid.nodes, 3))
