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
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numba
from numba import cfunc, njit
from numba.core.types import unliteral

config: Any = numba.config  #: made when numba is loaded, so that its names are not known before
_plain: Any = unliteral  #: the type of the number 0 is that of a number
_njit: Any = njit  #: its types do not know a signature or options that are passed on

PACKAGE = Path(__file__).parent
NO_WRAPPERS = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}  #: of a kernel that kernels call
KEPT = 3  #: older folders that stay, for branches between which one goes to and fro


def sources_key(package: Path) -> str:
    """Hash of all sources of a package and of numba's version: what its compiled kernels depend on."""
    digest = hashlib.sha256(numba.__version__.encode())
    for file in sorted(package.rglob("*.py")):
        digest.update(file.relative_to(package).as_posix().encode() + b"\0" + file.read_bytes() + b"\0")
    return digest.hexdigest()[:16]


def cache_folder(package: Path) -> Path | None:
    """Where the kernels of a package in its present state are kept; None if no place can be written.

    Below NUMBA_CACHE_DIR if that is set; else beside the package, or, where it is read-only, in the user's cache.
    """
    if config.CACHE_DIR:
        homes = [Path(config.CACHE_DIR) / package.name]
    else:
        user = Path(os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache"))
        homes = [package / "__pycache__", user / "brash" / package.name]
    key = f"kernels-{sources_key(package)}"
    return next((home / key for home in homes if _prepared(home, key)), None)


def _prepared(home: Path, key: str) -> bool:
    """Whether kernels can be kept in the folder ``key`` of ``home``; makes it, and removes the oldest of the others."""
    folder = home / key
    try:
        if not folder.is_dir():
            others = sorted(home.glob("kernels-*"), key=lambda f: f.stat().st_mtime)
            for old in others[: max(0, len(others) - KEPT)]:
                shutil.rmtree(old, ignore_errors=True)
            folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        return False
    return os.access(folder, os.W_OK)


def _say_that_nothing_is_kept() -> None:
    """One note for all packages: that it was given is booked where numba is."""
    if vars(numba).setdefault("_brash_has_said", False):
        return
    vars(numba)["_brash_has_said"] = True
    text = "compiled kernels are not kept, every run compiles anew: set NUMBA_CACHE_DIR to a folder that can be written"
    warnings.warn_explicit(text, RuntimeWarning, "brash", 0)


FOLDER = cache_folder(PACKAGE)  #: of this run
if FOLDER is None:
    _say_that_nothing_is_kept()


def compiled(*signature: str, borrows: bool = False, **options: Any) -> Callable[[Callable[..., Any]], Any]:
    """`numba.njit` with the machine code kept in `cache_folder`; signature and options as there.

    A kernel that ``borrows`` makes no array: references to those that it is given are not counted. Where it is called
    for each of many rows with tables of a hundred arrays, counting takes longer than the rest. So does handing the
    tables over, array by array: what a loop calls for each row is made part of it with ``forceinline``.
    """
    options |= {"_nrt": not borrows}
    if signature:
        return lambda kernel: _kept(_njit(*signature, cache=FOLDER is not None, **options), kernel)
    return lambda kernel: _linked(kernel, options)


def _linked(kernel: Callable[..., Any], options: dict[str, Any]) -> Any:
    """A kernel that is compiled apart for Python and for kernels that call it: half of the time goes into less.

    For kernels nothing is made that takes arguments from Python. And a number that stands in a call is a number like
    any other: numba would compile the kernel once more for each.
    """
    outer = _kept(_njit(cache=FOLDER is not None, **options), kernel)
    inner = _kept(_njit(cache=FOLDER is not None, **NO_WRAPPERS, **options), kernel, "inner")

    def call(args: Any, kws: Any) -> Any:
        plain = {name: _plain(kind) for name, kind in kws.items()}
        return inner.get_call_template([_plain(kind) for kind in args], plain)

    outer.get_call_template, outer.get_overload, outer.inner = call, inner.get_overload, inner
    return outer


def callback(signature: str) -> Callable[[Callable[..., Any]], Any]:
    """`numba.cfunc`, for libraries that call back, kept likewise."""
    return lambda kernel: _kept(cfunc(signature, cache=FOLDER is not None), kernel)


def _kept(compile_it: Callable[..., Any], kernel: Callable[..., Any], part: str = "") -> Any:
    before = config.CACHE_DIR
    config.CACHE_DIR = before if FOLDER is None else str(FOLDER / part)
    try:
        return compile_it(kernel)
    finally:
        config.CACHE_DIR = before
