"""Commands for those who couple the ice to other simulations: fmu."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from cosim.cli.options import ForceOption, ScenarioArgument, SetOption
from cosim.outputs import whole, writable


def fmu(
    scenario: ScenarioArgument,
    output: Annotated[Path, typer.Option("-o", "--output", help="FMU to write (.fmu)")],
    version: Annotated[int, typer.Option("--fmi", help="version of FMI: 2 or 3")] = 2,
    overrides: SetOption = None,
    force: ForceOption = False,
) -> None:
    """Write a case as an FMU: in goes the motion of the structure, out come the loads (FMI 2.0 or 3.0, extra fmi)."""
    from cosim.fmi.write import write_fmu
    from cosim.scenario.loading import load_scenario
    from cosim.show.console import print_line

    case = load_scenario(scenario, overrides or ())
    writable(output, ".fmu", case.inputs, force)
    with whole(output, ".fmu") as part:
        write_fmu(case, part, version)
    step = case.window_ns / 1e9
    print_line(f"{output}: written; steps are whole multiples of {step:g} s")
