"""A run of the command line: watched by observers, ended in order whatever happens."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from cosim.errors import InputError, explain
from cosim.observer import Observer
from cosim.plain import one_line
from cosim.recording.writer import Recorder
from cosim.scenario.cost import cost_of, too_large
from cosim.scenario.scenario import Scenario
from cosim.signals import StopAfterWindow, StoppedError

if TYPE_CHECKING:
    from cosim.checkpoint.file import Kept
    from coupling.scheduler import Scheduler


def simulate(
    scenario: Scenario,
    observers: Sequence[Observer],
    at_end: Callable[[Scheduler], None] | None = None,
    kept: Kept | None = None,
) -> dict[str, Any]:
    """Run and close the observers whatever happens; recordings tell how it ended. What ``cosim run --json`` prints.

    ``at_end`` as in `cosim.simulation.run_scenario`; ``kept`` is the checkpoint from which the run goes on. New ones
    are kept beside the first recording. InputError where the sheet does not fit this machine.
    """
    from cosim.checkpoint.keeping import Checkpoints
    from cosim.simulation import run_scenario

    if refused := too_large(cost_of(scenario.model)):
        raise InputError(refused)
    watching = [*observers, StopAfterWindow()]
    recorders = [o for o in observers if isinstance(o, Recorder)]
    checkpoints = Checkpoints(scenario, next(iter(recorders), None), kept)
    try:
        result: dict[str, Any] = run_scenario(scenario, watching, at_end, checkpoints).to_json()
        for recorder in recorders:
            recorder.lights = result["trust"]
        return result
    except (Exception, StoppedError) as error:
        ending = one_line(explain(error)[0] if isinstance(error, Exception) else str(error))
        for recorder in recorders:
            recorder.ending, recorder.failed = ending, isinstance(error, Exception)
            if isinstance(error, StoppedError) and recorder.recorded_ns > 0:
                error.kept = str(recorder.path)
        raise
    finally:
        for observer in reversed(watching):
            observer.on_close()
