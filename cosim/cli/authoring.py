"""Commands for those who write a scenario: new, keys, check."""

from __future__ import annotations

import json
import os
import sys
from contextlib import ExitStack
from pathlib import Path
from typing import Annotated, Any

import typer

from cosim.cli.options import JsonOption, ScenarioArgument, SetOption
from cosim.cli.output import print_json
from cosim.errors import InputError
from cosim.outputs import whole


def new(
    folder: Annotated[Path, typer.Argument(help="folder to make; it gets a scenario.toml")],
    cone: Annotated[bool, typer.Option("--cone", help="an upward-breaking cone (default)")] = False,
    slope: Annotated[bool, typer.Option("--slope", help="a plane downward-breaking slope")] = False,
    source: Annotated[str | None, typer.Option("--from", metavar="NAME", help="a copy of this scenario")] = None,
) -> None:
    """Write a commented scenario that runs."""
    from cosim.scenario.template import CONE, SCHEMA, SLOPE, copied_texts, scenario_text
    from cosim.show.console import print_line

    if cone + slope + (source is not None) > 1:
        raise InputError("--cone, --slope and --from exclude each other; give one of them")
    texts = copied_texts(source) if source is not None else {"scenario.toml": scenario_text(SLOPE if slope else CONE)}
    _write(folder, {**texts, SCHEMA: json.dumps(_schema(), indent=1) + "\n"})
    print_line(f"{folder / 'scenario.toml'}: written; edit it, then `cosim check {folder}`")


def _write(folder: Path, texts: dict[str, str]) -> None:
    """Files of a new case: all of them or none; what is there already is kept."""
    if folder.exists() and not folder.is_dir():
        raise InputError(f"{folder}: is a file; name a new folder")
    made = not folder.exists()
    folder.mkdir(exist_ok=True)
    try:
        with ExitStack() as stack:
            for name, text in texts.items():
                file = folder / name
                if os.path.lexists(file):
                    raise InputError(f"{file}: is there already and is kept; name another folder")
                stack.enter_context(whole(file, file.suffix)).write_text(text, encoding="utf-8")
    except BaseException:
        if made:
            folder.rmdir()
        raise


def scale(
    case: ScenarioArgument,
    factor: Annotated[str, typer.Argument(help="lengths of the copy over those of the case, for example 36 or 1/36")],
    output: Annotated[Path | None, typer.Option("-o", "--output", help="scenario file to write (.toml)")] = None,
    as_json: JsonOption = False,
) -> None:
    """A Froude copy of a scenario: every quantity at another scale; without -o the text on standard output."""
    from cosim.scenario.froude import factor_of, froude_copy
    from cosim.scenario.loading import load_scenario
    from cosim.show.console import print_line, warn

    if output is not None and os.path.lexists(output):
        raise InputError(f"{output}: is there already and is kept; name another file")
    by = factor_of(factor)
    made = froude_copy(load_scenario(case), by)
    for line in made.told:
        warn(line)
    if output is not None:
        with whole(output, ".toml") as part:
            part.write_text(made.text, encoding="utf-8")
    if as_json:
        rows = [{"key": q.key, "from": q.before, "to": q.after, "power": str(q.power)} for q in made.quantities]
        print_json({"factor": str(by), "quantities": rows, "told": list(made.told), "scenario": made.text})
    elif output is None:
        sys.stdout.write(made.text)
    else:
        print_line(f"{output}: {len(made.quantities)} quantities scaled; `cosim check {output}`")


def keys(
    prefix: Annotated[str, typer.Argument(help="only keys that begin with this, for example ice or ice.th")] = "",
    schema: Annotated[bool, typer.Option("--schema", help="a JSON schema of scenario files, for editors")] = False,
    as_json: JsonOption = False,
) -> None:
    """Every key of a scenario with meaning, unit, range and default."""
    from cosim.scenario.keys import keys_of
    from cosim.scenario.model import ScenarioModel
    from cosim.show.key_list import key_json, print_keys

    if schema:
        print_json(_schema())
        return
    known = keys_of(ScenarioModel)
    found = [key for key in known if key.name.startswith(prefix)]
    if not found:
        from cosim.nearest import hint

        sections = dict.fromkeys(key.name.split(".")[0] for key in known)
        raise InputError(f"no key begins with {prefix!r}; {hint(prefix, [*(key.name for key in known), *sections])}")
    print_json([key_json(key) for key in found]) if as_json else print_keys(found)


def check(scenario: ScenarioArgument, overrides: SetOption = None, as_json: JsonOption = False) -> None:
    """Tell all that is wrong with a scenario, then how plausible it is and what it costs. Simulates nothing."""
    from cosim.attempts import faults_of
    from cosim.scenario.errors import ScenarioError
    from cosim.scenario.loading import load_scenario
    from cosim.show.check import judged, print_check
    from cosim.show.console import print_progress

    faults: tuple[str, ...] = ()
    content: dict[str, Any] = {"scenario": scenario, "faults": [], "doubts": [], "facts": {}, "cost": {}}
    try:
        loaded = load_scenario(scenario, overrides or ())
        content |= judged(loaded)
        content["faults"] += faults_of(loaded)
    except ScenarioError as error:
        faults = error.faults
        content["faults"] = list(faults)
    if as_json:
        print_json(content)
    elif not faults:
        print_check(content)
    if content["faults"]:
        for line in content["faults"]:
            print_progress(f"cosim: {line}")
        count = len(content["faults"])
        raise InputError(f"{scenario}: {count} fault{'s' * (count > 1)}; correct {'them' if count > 1 else 'it'}")


def _schema() -> dict[str, Any]:
    from cosim.scenario.model import ScenarioModel
    from cosim.scenario.schema import schema_of

    return schema_of(ScenarioModel)
