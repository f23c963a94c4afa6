"""Which of the files that `cosim compare` gets is what: runs, a reference, a measured series."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from cosim.analysis.reference import load_reference
from cosim.scenario.files import read_toml
from cosim.series.told import SeriesError


@dataclass(frozen=True)
class Files:
    """What to compare with what."""

    runs: tuple[Path, ...]
    reference: Path | None
    series: Path | None


def sort_files(given: Sequence[Path]) -> Files:
    """Runs first; a TOML file with features or a folder is a reference, anything else a series.

    Of recordings alone, two or more, the last one is the series. A reference may name its series.
    """
    runs = [given[0], *(path for path in given[1:] if path.suffix.lower() == ".mcap")]
    rest = [path for path in given[1:] if path.suffix.lower() != ".mcap"]
    references = [path for path in rest if _is_reference(path)]
    series = [path for path in rest if path not in references]
    for found, what in ((references, "references"), (series, "series")):
        if len(found) > 1:
            raise SeriesError(f"two {what}, {found[0]} and {found[1]}: give one")
    if not rest and len(runs) > 1:
        series = [runs.pop()]
    reference = references[0] if references else None
    if reference is not None and not series:
        named = load_reference(reference).series
        series = [] if named is None else [named]
    return Files(tuple(runs), reference, series[0] if series else None)


def _is_reference(path: Path) -> bool:
    """Whether a path is a folder, a TOML file with features, or one that is not there."""
    if path.suffix != ".toml":
        return path.is_dir() or not (path.is_file() or path.suffix)
    return not path.is_file() or "file" not in read_toml(path, SeriesError)[1]
