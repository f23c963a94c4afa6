"""The command that runs the campaign of all cases: evidence."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cosim.cli.grouping import grouped
from cosim.cli.options import JsonOption, talking
from cosim.cli.output import print_json
from cosim.errors import FailedError, InputError
from cosim.show.talk import Talk

if TYPE_CHECKING:
    from cosim.evidence.campaign import Planned
    from cosim.evidence.cases import Case
    from cosim.study.sweep import Runner
    from cosim.study.task import Row


@dataclass(frozen=True)
class EvidencePlace:
    """Where it runs, and what it writes."""

    output: Annotated[
        Path, typer.Option("-o", "--output", metavar="DIR", help="folder of the tables; what it holds is gone on with")
    ] = Path("evidence")
    jobs: Annotated[int, typer.Option("-j", "--jobs", min=1, help="runs at the same time here")] = 1
    scheduler: Annotated[
        str, typer.Option(help="a dask scheduler in place of processes here: tcp://host:8786, or its file")
    ] = "local"

    @property
    def runner(self) -> Runner:
        """Processes, or a cluster."""
        from cosim.study.command import Where

        return Where(self.jobs, self.scheduler).runner

    def folder(self) -> Path:
        """Made, if it is not there."""
        try:
            self.output.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise InputError(f"{self.output}: {error.strerror}; name a folder that can be written") from None
        return self.output


@talking
@grouped
def evidence(
    place: EvidencePlace,
    only: Annotated[
        list[str] | None, typer.Option("--only", metavar="CASE", help="this case; repeatable; default: all")
    ] = None,
    list_them: Annotated[bool, typer.Option("--list", help="show the cases and what they cost, run nothing")] = False,
    cases: Annotated[Path | None, typer.Option("--cases", help="another list of cases (.toml)")] = None,
    as_json: JsonOption = False,
    *,
    talk: Talk,
) -> None:
    """Run the campaign of all cases and put it beside what was measured: hours, but it goes on where it was."""
    from cosim.evidence.campaign import planned
    from cosim.evidence.cases import read_cases
    from cosim.show.evidence_tables import list_of, show, show_list

    known = read_cases(cases)
    chosen = known.chosen(only or ())
    if list_them:
        rows = list_of([planned(case) for case in chosen])
        print_json({"cases": rows}) if as_json else show_list(rows)
        return
    content = _run([planned(case) for case in known.all], chosen, place, talk)
    print_json(content) if as_json else show(content)
    if failed := sum(len(case["errors"]) for case in content["cases"]):
        raise FailedError(f"{failed} runs failed; their lines say why")


def _run(cases: list[Planned], chosen: tuple[Case, ...], place: EvidencePlace, talk: Talk) -> dict[str, Any]:
    """Runs the chosen cases; the tables hold what the folder has of all of them, also when it is stopped."""
    from cosim.evidence.campaign import run_campaign
    from cosim.evidence.table import content_of, write

    folder = place.folder()
    rows = {the.case.name: the.known(folder) for the in cases}
    talk.note(f"{sum(map(len, rows.values()))} runs are known from {folder}")

    def done(the: Planned, row: Row) -> None:
        rows[the.case.name][row["number"]] = row
        talk.note(f"{the.case.name}, {row['variant']}: {row['error'] or 'done'}")

    try:
        run_campaign([the for the in cases if the.case in chosen], folder, place.runner, done)
    finally:
        content = content_of(cases, {name: [own[k] for k in sorted(own)] for name, own in rows.items()}, folder)
        for file in write(content, folder):
            talk.detail(f"written: {file}")
    return content
