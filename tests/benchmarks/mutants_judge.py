"""Runs the tests of one file for `mutants.py`; exit code of pytest, which stops at the first failure.

    python tests/benchmarks/mutants_judge.py FILE PLAIN TESTS...

The kernels of a package are kept by a hash of its sources, so a mutant would compile all of them. A file that holds
none cannot change them: it gets those of the unchanged sources, kept in $MUTANTS_KERNELS since the first call.
"""

import importlib
import os
import shutil
import sys
from pathlib import Path

import pytest


def main(file: str, plain: str, *tests: str) -> int:
    """See above; ``plain`` is 1 where kernels run as plain Python."""
    if plain == "1":
        os.environ["NUMBA_DISABLE_JIT"] = "1"
    kept, package = Path(os.environ["MUTANTS_KERNELS"]), file.split("/")[0]
    has_kernels = any(f"@{word}(" in Path(file).read_text() for word in ("compiled", "callback"))
    first = not (kept / "done" / file).exists()
    if not first and not has_kernels and package != "cosim":
        folder = importlib.import_module(f"{package}.compiled").cache_folder(Path(package).resolve())
        shutil.copytree(kept / package, folder, dirs_exist_ok=True)
    code = int(pytest.main(["-q", "-x", "-p", "no:cacheprovider", *tests]))
    if first:
        for name in ("lattice", "rubble", "coupling"):
            folder = importlib.import_module(f"{name}.compiled").cache_folder(Path(name).resolve())
            shutil.copytree(folder, kept / name, dirs_exist_ok=True)
        (kept / "done" / file).mkdir(parents=True, exist_ok=True)
    return code


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
