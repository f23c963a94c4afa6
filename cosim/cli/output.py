"""What a command hands out: a place that can be written, and JSON that every reader takes."""

from __future__ import annotations

import json
import math
import sys
from pathlib import Path
from typing import Any

from cosim.errors import InputError


def writable(path: Path) -> Path:
    """Refuse a place that cannot be written before hours are simulated."""
    if path.is_dir():
        raise InputError(f"{path}: is a folder; name a file in it")
    if not path.parent.is_dir():
        raise InputError(f"{path}: no such folder {path.parent}; create it or write elsewhere")
    return path


def print_json(content: dict[str, Any] | list[dict[str, Any]]) -> None:
    """One JSON object, or a list of them, on standard output; what is no number becomes null."""
    sys.stdout.write(json.dumps(_finite(content), indent=2, allow_nan=False) + "\n")


def _finite(value: Any) -> Any:
    """JSON has no nan: null instead. Numpy scalars become numbers."""
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(item) for item in value]
    if hasattr(value, "item"):
        value = value.item()
    return None if isinstance(value, float) and not math.isfinite(value) else value
