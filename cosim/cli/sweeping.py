"""The command that simulates many variants: sweep."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from cosim.cli.grouping import grouped
from cosim.cli.options import JsonOption, ScenarioArgument, SetOption, talking
from cosim.cli.output import print_json
from cosim.errors import FailedError, InputError
from cosim.outputs import whole, writable
from cosim.show.talk import Talk

if TYPE_CHECKING:
    from cosim.study.command import Where
    from cosim.study.design import Design

Designs = Literal["one-at-a-time", "grid", "random", "sobol"]


@dataclass(frozen=True)
class SweepDesign:
    """What varies."""

    vary: Annotated[
        list[str] | None,
        typer.Option(
            "--vary", metavar="A.B=V,V", help="a key and its values, or for random and sobol V..V; repeatable"
        ),
    ] = None
    grid: Annotated[bool, typer.Option("--grid", help="as --design grid")] = False
    design: Annotated[
        Designs,
        typer.Option(help="each value alone, all combinations, points drawn from ranges, Saltelli's points"),
    ] = "one-at-a-time"
    samples: Annotated[int, typer.Option(min=1, help="points of random; sobol makes (keys + 2) times as many")] = 64
    draw: Annotated[int, typer.Option(min=0, help="seed of the drawing of points")] = 0
    seeds: Annotated[int | None, typer.Option(min=1, help="runs of each variant, with seeds from its own on")] = None

    def made(self) -> Design:
        """As the study takes it."""
        from cosim.study.design import Design

        if self.grid and self.design != "one-at-a-time":
            raise InputError(f"--grid and --design {self.design} exclude each other; give one of them")
        return Design("grid" if self.grid else self.design, self.samples, self.draw, self.seeds)


@dataclass(frozen=True)
class SweepPlace:
    """Where it runs, and what it writes."""

    jobs: Annotated[int, typer.Option("-j", "--jobs", min=1, help="variants that run at the same time here")] = 1
    scheduler: Annotated[
        str, typer.Option(help="a dask scheduler in place of processes here: tcp://host:8786, or its file")
    ] = "local"
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="write the table (.csv, or .parquet for many), SI units")
    ] = None
    resume: Annotated[bool, typer.Option("--resume", help="go on with a .parquet of this sweep")] = False
    plot: Annotated[
        Path | None, typer.Option(help="draw the peaks: against the base, or their distribution (.png)")
    ] = None
    recordings: Annotated[Path | None, typer.Option(help="folder for recordings of variants")] = None
    keep: Annotated[str, typer.Option(metavar="0,3,7-9", help="numbers of the variants that are recorded; or all")] = (
        "all"
    )

    def made(self) -> Where:
        """As the study takes it, checked before anything is simulated."""
        from cosim.study.command import Where

        if self.output is not None:
            kind = ".parquet" if self.output.suffix == ".parquet" else ".csv"
            if self.resume and kind != ".parquet":
                raise InputError(f"{self.output}: --resume goes on with a .parquet; name one")
            writable(self.output, kind, force=self.resume)
        elif self.resume:
            raise InputError("--resume needs the table to go on with; give -o NAME.parquet")
        if self.plot is not None:
            writable(self.plot, ".png")
        if self.recordings is not None and self.recordings.exists() and not self.recordings.is_dir():
            raise InputError(f"{self.recordings}: is no folder; name one for the recordings")
        if self.keep != "all" and self.recordings is None:
            raise InputError("--keep needs a folder for the recordings; give --recordings FOLDER")
        return Where(self.jobs, self.scheduler, self.output, self.resume, self.recordings, numbers(self.keep))


def numbers(text: str) -> frozenset[int] | None:
    """``0,3,7-9`` as numbers; None for ``all``."""
    if text == "all":
        return None
    found: set[int] = set()
    for part in text.split(","):
        first, dash, last = part.strip().partition("-")
        ends = (first, last) if dash else (first, first)
        if not all(end.isascii() and end.isdigit() for end in ends) or int(ends[0]) > int(ends[1]):
            raise InputError(
                f"--keep {text}: {part.strip() or 'an empty part'} is no number of a variant; write 0,3,7-9"
            )
        found.update(range(int(ends[0]), int(ends[1]) + 1))
    return frozenset(found)


@talking
@grouped
def sweep(
    scenario: ScenarioArgument,
    what: SweepDesign,
    place: SweepPlace,
    overrides: SetOption = None,
    as_json: JsonOption = False,
    *,
    talk: Talk,
) -> None:
    """Run variants of a scenario, or an ensemble, and put their loads side by side."""
    from cosim.show.sweep_tables import show
    from cosim.study.command import plan, run_sweep, table_of

    where = place.made()
    the = plan(scenario, what.vary or (), overrides or (), what.made(), where)
    with table_of(the, where) as table:
        content = run_sweep(the, where, table, talk)
        print_json(content) if as_json else show(content)
    if place.plot is not None:
        from cosim.show.ensemble_figure import ensemble
        from cosim.show.tornado import tornado

        with whole(place.plot, ".png") as part:
            (ensemble if content["ensembles"] else tornado)(content, part)
    if content["failed"]:
        raise FailedError(f"{content['failed']} of {len(content['variants'])} variants failed; their lines say why")
