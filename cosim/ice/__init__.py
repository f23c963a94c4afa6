"""Ice that is not the same everywhere, and ice that is broken before a run begins."""
