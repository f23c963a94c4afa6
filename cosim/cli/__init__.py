"""The command line: ``cosim new | keys | check | run | sweep | replay | compare | report | ...``; `entry` has all."""

from cosim.cli.entry import main

__all__ = ["main"]
