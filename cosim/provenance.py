"""What a result was made with: version and commit of the project, versions of the libraries that make numbers."""

from __future__ import annotations

import platform
import re
import subprocess
from functools import cache
from importlib import metadata
from pathlib import Path

PACKAGE = Path(__file__).parent
COMMIT = PACKAGE / "commit.txt"  #: written when a wheel or an archive of the sources is built
LIBRARIES = ("numpy", "scipy", "numba", "llvmlite", "pymunk", "gstools", "mcap", "protobuf", "pydantic", "pint")


def version() -> str:
    """Of the project."""
    return installed("brash-ice")


@cache
def commit() -> str:
    """Of the sources, with ``+`` if they were changed since; "unknown" for sources without a history."""
    if COMMIT.is_file():
        return COMMIT.read_text(encoding="utf-8").strip()
    return commit_of(PACKAGE.parent)


def commit_of(root: Path) -> str:
    """Of a checkout, see `commit`."""
    if not (root / ".git").exists():
        return "unknown"
    try:
        head = _git(root, "rev-parse", "HEAD")
        changed = _git(root, "status", "--porcelain", "--untracked-files=no", "--", "*.py")
    except (OSError, subprocess.SubprocessError):
        return "unknown"
    return head + "+" * bool(changed)


def _git(root: Path, *arguments: str) -> str:
    done = subprocess.run(
        ["git", "-C", str(root), *arguments], capture_output=True, text=True, check=True, timeout=20, encoding="utf-8"
    )
    return done.stdout.strip()


def installed(name: str) -> str:
    """Version of a package, from the head of its metadata: to parse all of them takes 50 ms. PackageNotFoundError."""
    found = re.search(r"^Version: *(\S+)", metadata.distribution(name).read_text("METADATA") or "", re.MULTILINE)
    return metadata.version(name) if found is None else found[1]


def libraries() -> dict[str, str]:
    """Versions by name, Python's first."""
    return {"python": platform.python_version(), **{name: installed(name) for name in LIBRARIES}}
