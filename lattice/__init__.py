"""The ice sheet: a plate lattice on water that breaks cell by cell (breaking phase)."""
