"""The state of a run as a file, from which the run goes on with the same bits."""
