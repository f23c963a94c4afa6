"""``python -m cosim.cli``: the command line where its script is not installed."""

from cosim.cli import main

main()
