"""The command `cosim sweep`: what runs, where, and what came out as one object."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from cosim.analysis.reference import Reference, parse_reference
from cosim.errors import InputError
from cosim.scenario.files import read_toml
from cosim.scenario.loading import checked, read_scenario
from cosim.scenario.scenario import Scenario
from cosim.scenario.variation import FIELDS
from cosim.show.check import fact_lines, judged
from cosim.show.console import as_line, stderr
from cosim.show.scale import scale_of
from cosim.show.sweep_tables import show
from cosim.show.talk import QUIET, Talk
from cosim.signals import StoppedError
from cosim.study.cluster import Cluster, program
from cosim.study.design import SAMPLED, Design
from cosim.study.parquet import ParquetTable, known_rows
from cosim.study.pool import Processes
from cosim.study.sensitivity import indices
from cosim.study.statistics import ensembles
from cosim.study.sweep import Runner, sweep, with_ratios
from cosim.study.table import CsvTable, NoTable, Table
from cosim.study.task import Row, Study
from cosim.study.variants import SEED, Axis, Range, Variant, parse_axis


@dataclass(frozen=True)
class Where:
    """Where variants run, and what of them stays."""

    jobs: int = 1  #: processes of this machine
    scheduler: str = "local"  #: or a dask scheduler, see `Cluster`
    output: Path | None = None  #: .csv or .parquet
    resume: bool = False  #: go on with a .parquet that is there
    recordings: Path | None = None  #: folder
    keep: frozenset[int] | None = None  #: numbers of variants that are recorded; None: all

    @property
    def runner(self) -> Runner:
        """Processes, or a cluster."""
        return Processes(self.jobs) if self.scheduler == "local" else Cluster(self.scheduler)


@dataclass(frozen=True)
class Plan:
    """What a sweep will do: the base, its variants, and what it is told of them."""

    base: Scenario
    study: Study
    design: Design
    axes: tuple[Axis | Range, ...]
    variants: tuple[Variant, ...]
    reference: Reference | None

    @property
    def keys(self) -> list[str]:
        """What varies."""
        return [*(axis.key for axis in self.axes), *([SEED] if self.design.seeds else [])]

    @property
    def about(self) -> dict[str, Any]:
        """Of which a table is: rows of another base or program are not mixed in."""
        text = "\n".join((self.base.resolved_toml(), self.study.reference or ""))
        return {
            "scenario": self.base.title,
            "base": hashlib.sha256(text.encode()).hexdigest()[:16],
            "program": program(),
            "design": self.design.name,
        }


def plan(scenario: str, vary: Sequence[str], overrides: Sequence[str], design: Design, where: Where) -> Plan:
    """Everything is read and checked once, before anything runs."""
    axes = tuple(parse_axis(text) for text in vary)
    design.check(axes)
    written = read_scenario(scenario)
    base = checked(written, overrides)
    file = written.file.parent / "reference.toml"
    text = read_toml(file, InputError)[0] if file.is_file() else None
    reference = None if text is None else parse_reference(text, str(file))
    variants = tuple(design.variants(axes, base.seed))
    if where.keep and max(where.keep) >= len(variants):
        raise InputError(f"--keep {max(where.keep)}: there are {len(variants)} variants, numbered from 0")
    folder = None if where.recordings is None else where.recordings.resolve()  # workers may stand elsewhere
    study = Study(replace(written, file=written.file.resolve()), tuple(overrides), text, folder, where.keep)
    if not where.resume:
        _keep_recordings(study, len(variants))
    return Plan(base, study, design, axes, variants, reference)


def _keep_recordings(study: Study, count: int) -> None:
    """Refuse a folder that holds recordings of another sweep where this one would write its own."""
    for path in filter(None, map(study.recording, range(count))):
        if os.path.lexists(path):
            raise InputError(f"{path}: exists and is kept; name another folder for the recordings, or remove it")


def is_random(scenario: Scenario) -> bool:
    """Whether something in a scenario is drawn by its seed."""
    rubble, fields = scenario.rubble, (getattr(scenario.ice, name) for name in FIELDS)
    return (rubble.enabled and rubble.initial_volume > 0.0) or any(bool(f and f.variation) for f in fields)


def run_sweep(the: Plan, where: Where, table: Table, talk: Talk) -> dict[str, Any]:
    """All variants with a progress bar, written as they end; the content of ``--json``.

    If it is stopped, what has ended until then is shown.
    """
    for text in the.base.warnings:
        talk.warn(text)
    if the.design.seeds and not is_random(the.base):
        talk.warn(
            "a seed changes nothing here: give rubble.initial_volume, or ice that varies (ice.strength_field.variation)"
        )
    for line in fact_lines(judged(the.base)["facts"]):
        talk.detail(line)
    known: dict[int, Row] = {}
    if where.resume and where.output is not None:
        known = known_rows(where.output, the.variants, the.about)
        talk.note(f"{len(known)} of {len(the.variants)} variants are known from {where.output}")
    if where.recordings is not None:
        where.recordings.mkdir(parents=True, exist_ok=True)
    ended = dict(known)
    try:
        with _progress(talk) as progress:
            bar = progress.add_task(as_line(the.base.title)[:30], total=len(the.variants), completed=len(known))
            table.begin(known)

            def done(row: Row) -> None:
                ended[row["number"]] = row
                table.add(row)
                progress.advance(bar)
                talk.note(f"{row['variant']}: {row['error'] or _in_a_line(row)}")

            rows = sweep(the.study, the.variants, where.runner, done, known)
    except StoppedError:
        if ended:
            show(_content(the, with_ratios([ended[k] for k in sorted(ended)])))
        raise
    return _content(the, rows)


def _content(the: Plan, rows: list[Row]) -> dict[str, Any]:
    """What ``--json`` prints."""
    sampled = the.design.name in SAMPLED
    ranges = [axis for axis in the.axes if isinstance(axis, Range)]
    return {
        "scenario": the.base.title,
        "overrides": list(the.study.overrides),
        "keys": the.keys,
        "design": the.design.name,
        "failed": sum(row["error"] is not None for row in rows),
        "variants": rows,
        "ensembles": ensembles(rows, the.reference) if the.design.seeds or sampled else [],
        "indices": indices(the.design, ranges, the.variants, rows) if sampled else [],
    }


def table_of(the: Plan, where: Where) -> Table:
    """What the rows are written to."""
    if where.output is None:
        return NoTable()
    if where.output.suffix != ".parquet":
        return CsvTable(where.output, the.keys)
    features = () if the.reference is None else the.reference.features
    return ParquetTable(where.output, the.variants, the.keys, [f.name for f in features], the.about)


def _progress(talk: Talk) -> Progress:
    columns = (
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("variants, remaining"),
        TimeRemainingColumn(),
    )
    return Progress(*columns, console=stderr, transient=True, disable=talk.level == QUIET)


def _in_a_line(row: Row) -> str:
    scale = scale_of((row["fx_peak"], row["fz_peak"]), "N")
    return f"Fx {scale.labelled(row['fx_peak'])}, Fz {scale.labelled(row['fz_peak'])}"
