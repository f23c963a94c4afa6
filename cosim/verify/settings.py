"""Parameters of a case: defaults that a user may replace with ``--set name=value``."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping
from typing import Any

from cosim.nearest import hint


def parse(settings: Mapping[str, Any] | Iterable[str] | None) -> dict[str, Any]:
    """``["nodes=[25,41]", "nu=0.25"]`` or a mapping -> ``{"nodes": [25, 41], "nu": 0.25}``; text stays text."""
    if settings is None:
        return {}
    if isinstance(settings, Mapping):
        return {key: _number(text) if isinstance(text, str) else text for key, text in settings.items()}
    out = {}
    for item in settings:
        key, sign, text = item.partition("=")
        if not sign:
            raise ValueError(f"--set {item}: write name=value")
        out[key.strip()] = _number(text.strip())
    return out


def _number(text: str) -> Any:
    try:
        return json.loads(text)
    except json.JSONDecodeError:
        return text


def merged(case: str, defaults: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """Defaults with the user's changes; a key that the case does not know or a value of another kind is refused."""
    for key, new in changes.items():
        if key not in defaults:
            raise ValueError(f"{case} has no parameter {key}: {hint(key, defaults)}")
        if not _fits(new, defaults[key]):
            raise ValueError(
                f"{case}: {key} = {json.dumps(new)} must be a {_kind(defaults[key])}, "
                f"for example {json.dumps(defaults[key])}"
            )
    return {**defaults, **changes}


def _fits(new: Any, default: Any) -> bool:
    """Same kind as the default; counts stay whole numbers above zero, numbers finite, lists full of numbers."""
    if isinstance(new, list) and isinstance(default, list):
        return bool(new) and all(_fits(x, x if isinstance(x, list) else 0.0) for x in new)
    if _kind(default) == "whole number above 0":
        return _kind(new) == _kind(default) and new > 0
    if _kind(default) == "number":
        return _kind(new) in ("number", "whole number above 0") and math.isfinite(new)
    return _kind(new) == _kind(default)


def _kind(value: Any) -> str:
    if isinstance(value, bool):
        return "switch, true or false"
    if isinstance(value, int):
        return "whole number above 0"
    if isinstance(value, float):
        return "number"
    return "list of numbers" if isinstance(value, list) else "text"


def meshes(nodes: list[Any]) -> list[tuple[int, int]]:
    """``[25, 41]`` or ``[[19, 31], [31, 51]]`` -> list of (nx, ny)."""
    pairs = nodes if isinstance(nodes[0], list) else [nodes]
    for pair in pairs:
        if not isinstance(pair, list) or len(pair) != 2 or not all(isinstance(n, int) for n in pair):
            raise ValueError(f"nodes = {json.dumps(nodes)}: write [nx,ny] or [[nx,ny],...] with whole numbers")
    return [(pair[0], pair[1]) for pair in pairs]
