"""Design formulas for the load of ice on a sloping structure, to set beside a run."""
