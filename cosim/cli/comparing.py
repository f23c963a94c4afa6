"""What `cosim compare` says about one recording."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from cosim.analysis import compare as comparison
from cosim.analysis.lights import trust
from cosim.analysis.reference import Reference
from cosim.analysis.run_data import RunData
from cosim.baselines.beside import beside
from cosim.series import compare as series
from cosim.series.compare import Comparison


def compared(run: RunData, reference: Path | None, pair: Comparison | None, as_json: bool) -> dict[str, Any]:
    """Features, design formulas and a series beside a run: as an object, or on the terminal.

    A run that carries no reference has no features; that is an error only if there is no series either.
    """
    name, loaded = None, Reference("", ())
    if pair is None or reference is not None or "reference.toml" in run.texts:
        name, loaded = comparison.reference_of(run, reference)
    rows, design = comparison.compare(run, loaded), beside(run)
    if as_json:
        of_series = None if pair is None else series.to_json(pair)
        of_run = comparison.to_json(run, name, rows)
        return {**of_run, "series": of_series, "design": design, "trust": trust(run)}
    from cosim.show.baseline_tables import print_beside
    from cosim.show.series_tables import print_series
    from cosim.show.tables import print_compare

    print_compare(loaded.title or run.name, rows, trust(run))
    print_beside(design)
    if pair is not None:
        print_series(pair)
    return {}
