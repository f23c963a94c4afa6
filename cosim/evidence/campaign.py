"""Runs the campaign: all runs of all cases in one pool, each case with its own table that a later call goes on with.

It is `cosim sweep` for several scenarios: the same plans, tasks, rows, pools and tables. A table of another version or
scenario in the folder is refused, not mixed in.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import ExitStack, closing
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from cosim.analysis.reference import Feature, parse_reference
from cosim.errors import InputError
from cosim.evidence.cases import Case
from cosim.nearest import hint
from cosim.scenario.files import read_toml
from cosim.study.command import Plan, Where, is_random, plan
from cosim.study.design import Design
from cosim.study.parquet import ParquetTable, known_rows
from cosim.study.pool import Task
from cosim.study.sweep import Runner, row_of
from cosim.study.task import Row, Study, run_variant
from cosim.study.variants import Variant


@dataclass(frozen=True)
class Planned:
    """A case with what its runs need, checked."""

    case: Case
    plan: Plan

    @property
    def features(self) -> tuple[Feature, ...]:
        """Those that the table shows, in the order of the reference."""
        known = () if self.plan.reference is None else self.plan.reference.features
        return tuple(f for f in known if not self.case.features or f.name in self.case.features)

    def file(self, folder: Path) -> Path:
        """The table of its runs."""
        return folder / f"{self.case.name}.parquet"

    def known(self, folder: Path) -> dict[int, Row]:
        """Rows of earlier calls, by number."""
        return known_rows(self.file(folder), self.plan.variants, self.plan.about)

    def table(self, folder: Path) -> ParquetTable:
        """What its rows are written to."""
        names = [] if self.plan.reference is None else [f.name for f in self.plan.reference.features]
        return ParquetTable(self.file(folder), self.plan.variants, self.plan.keys, names, self.plan.about)


def planned(case: Case) -> Planned:
    """Everything of a case is read and checked before anything runs."""
    the = plan(case.scenario, (), case.overrides, Design(seeds=case.seeds), Where())
    if case.reference:
        file = the.study.written.file.parent / case.reference
        text = read_toml(file, InputError)[0]
        the = replace(the, study=replace(the.study, reference=text), reference=parse_reference(text, str(file)))
    names = [] if the.reference is None else [f.name for f in the.reference.features]
    for name in case.features:
        if name not in names:
            raise InputError(f"case {case.name}: features: its reference has no {name}; {hint(name, names)}")
    if case.seeds > 1 and not is_random(the.base):
        raise InputError(f"case {case.name}: seeds = {case.seeds}: nothing is random in {case.scenario}; use 1")
    return Planned(case, the)


def run_campaign(
    cases: Sequence[Planned],
    folder: Path,
    runner: Runner,
    done: Callable[[Planned, Row], None],
    task: Callable[[Study, int, Variant], Row] = run_variant,
) -> dict[str, list[Row]]:
    """Rows of each case by its name, in the order of its variants; ``done`` is called as each run ends.

    What the folder holds already does not run again, but what ended with an error does.
    """
    rows = {the.case.name: the.known(folder) for the in cases}
    tasks: list[Task] = []
    owners: list[tuple[int, int]] = []  #: place of the case, and number of the variant, for each task
    for place, the in enumerate(cases):
        for number, variant in enumerate(the.plan.variants):
            if number not in rows[the.case.name]:
                tasks.append((len(tasks), variant))
                owners.append((place, number))
    with ExitStack() as stack:
        tables = [stack.enter_context(the.table(folder)) for the in cases]
        for the, table in zip(cases, tables, strict=True):
            table.begin(rows[the.case.name])
        work = partial(_one, task, [the.plan.study for the in cases], owners)
        if tasks:
            with closing(runner.run(tasks, work)) as results:
                for k, found in results:
                    place, number = owners[k]
                    row = row_of(number, cases[place].plan.variants[number], found)
                    rows[cases[place].case.name][number] = row
                    tables[place].add(row)
                    done(cases[place], row)
    return {name: [own[k] for k in sorted(own)] for name, own in rows.items()}


def _one(
    task: Callable[[Study, int, Variant], Row],
    studies: Sequence[Study],
    owners: Sequence[tuple[int, int]],
    k: int,
    variant: Variant,
) -> Row:
    """The k-th task of the campaign: one run of one case."""
    place, number = owners[k]
    return task(studies[place], number, variant)
