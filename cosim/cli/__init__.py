"""The command line: ``cosim run | sweep | replay | compare | report | baseline | verify | info | recover | list``."""

from cosim.cli.entry import main

__all__ = ["main"]
