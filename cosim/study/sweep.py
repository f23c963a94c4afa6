"""Runs variants of a scenario side by side, here or on a cluster, and tells what came out.

A variant that fails does not stop the others: its row holds the error as one line.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Mapping, Sequence
from contextlib import closing
from functools import partial
from typing import Protocol

from cosim.study.pool import Task, Work
from cosim.study.task import COMPONENTS, Row, Study, run_variant
from cosim.study.variants import BASE, Variant


class Runner(Protocol):
    """Where tasks run."""

    def run(self, tasks: Sequence[Task], work: Work) -> Generator[tuple[int, Row], None, None]:
        """Number and row of each task as it ends, in any order."""


def sweep(
    study: Study,
    variants: Sequence[Variant],
    runner: Runner,
    done: Callable[[Row], None],
    known: Mapping[int, Row] | None = None,
    task: Callable[..., Row] = run_variant,
) -> list[Row]:
    """A row for each variant, in their order, whatever order they end in; ``done`` is called as each ends.

    Those in ``known`` (by number) do not run again.
    """
    rows = dict(known or {})
    tasks = [(k, variant) for k, variant in enumerate(variants) if k not in rows]
    if tasks:
        with closing(runner.run(tasks, partial(task, study))) as results:
            for k, found in results:
                rows[k] = row_of(k, variants[k], found)
                done(rows[k])
    return with_ratios([rows[k] for k in sorted(rows)])


def row_of(number: int, variant: Variant, found: Row) -> Row:
    """A row of the table: which variant, what it changes, what came out."""
    head = {"number": number, "variant": variant.name, "group": variant.group, "seed": variant.seed}
    return {**head, **dict(variant.changes), "error": None, **found}


def with_ratios(rows: list[Row]) -> list[Row]:
    """Adds ``fx_ratio``, ``fz_ratio``, ``f_ratio``: the peak over that of the base with the same seed."""
    base = {row["seed"]: row for row in rows if row["group"] == BASE}
    for row in rows:
        beside = base.get(row["seed"], base.get(None, {}))
        for c in COMPONENTS:
            least, peak = beside.get(f"{c}_peak"), row.get(f"{c}_peak")
            row[f"{c}_ratio"] = peak / least if least and peak is not None else None
    return rows
