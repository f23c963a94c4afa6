"""``python -m cosim``: the command line where its script is not installed."""

from cosim.cli import main

if __name__ == "__main__":  # processes of a sweep import this file again
    main()
