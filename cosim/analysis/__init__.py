"""Numbers of a recorded run: features, cycles, what carries the load, and the references beside them. Knows no file."""
