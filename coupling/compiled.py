"""How the kernels of this package are compiled and kept on disk.

numba keeps a compiled kernel as long as the file that holds it is unchanged; an edit in a file whose kernels it *calls*
goes unseen, and the old machine code runs on. So the kernels of a package are kept in a folder of their own that is
named after a hash of all its sources: whatever is edited, or comes with a new version, everything is compiled anew.

The same file stands in every package that has kernels, because packages of solvers do not import each other; a test
keeps the copies equal. Kernels call kernels of their own package only.
"""

from __future__ import annotations

import hashlib
import os
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numba
from numba import cfunc, njit

config: Any = numba.config  #: made when numba is loaded, so that its names are not known before
_njit: Any = njit  #: its types do not know a signature or options that are passed on

PACKAGE = Path(__file__).parent
KEPT = 3  #: older folders that stay, for branches between which one goes to and fro


def sources_key(package: Path) -> str:
    """Hash of all sources of a package and of numba's version: what its compiled kernels depend on."""
    digest = hashlib.sha256(numba.__version__.encode())
    for file in sorted(package.rglob("*.py")):
        digest.update(file.relative_to(package).as_posix().encode() + b"\0" + file.read_bytes() + b"\0")
    return digest.hexdigest()[:16]


def cache_folder(package: Path) -> Path:
    """Where the kernels of a package in its present state are kept: beside it, or below NUMBA_CACHE_DIR if set."""
    home = package / "__pycache__"
    if config.CACHE_DIR:
        home = Path(config.CACHE_DIR) / package.name
    elif not os.access(package, os.W_OK):
        home = Path.home() / ".cache" / "brash" / package.name
    folder = home / f"kernels-{sources_key(package)}"
    if not folder.is_dir():
        others = sorted(home.glob("kernels-*"), key=lambda f: f.stat().st_mtime)
        for old in others[: max(0, len(others) - KEPT)]:
            shutil.rmtree(old, ignore_errors=True)
        folder.mkdir(parents=True, exist_ok=True)
    return folder


_FOLDER = cache_folder(PACKAGE)


def compiled(*signature: str, **options: Any) -> Callable[[Callable[..., Any]], Any]:
    """`numba.njit` with the machine code kept in `cache_folder`; signature and options as there."""
    return lambda kernel: _kept(_njit(*signature, cache=True, **options), kernel)


def callback(signature: str) -> Callable[[Callable[..., Any]], Any]:
    """`numba.cfunc`, for libraries that call back, kept likewise."""
    return lambda kernel: _kept(cfunc(signature, cache=True), kernel)


def _kept(compile_it: Callable[..., Any], kernel: Callable[..., Any]) -> Any:
    before = config.CACHE_DIR
    config.CACHE_DIR = str(_FOLDER)
    try:
        return compile_it(kernel)
    finally:
        config.CACHE_DIR = before
