"""A run of the command line: watched by observers, ended in order whatever happens."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from cosim.errors import explain
from cosim.observer import Observer
from cosim.plain import one_line
from cosim.recording.writer import Recorder
from cosim.scenario.scenario import Scenario
from cosim.signals import StopAfterWindow, StoppedError


def simulate(scenario: Scenario, observers: Sequence[Observer]) -> dict[str, Any]:
    """Run and close the observers whatever happens; recordings tell how it ended. What ``cosim run --json`` prints."""
    from cosim.simulation import run_scenario

    watching = [*observers, StopAfterWindow()]
    try:
        result: dict[str, Any] = run_scenario(scenario, watching).to_json()
        for recorder in (o for o in observers if isinstance(o, Recorder)):
            recorder.lights = result["trust"]
        return result
    except (Exception, StoppedError) as error:
        ending = one_line(explain(error)[0] if isinstance(error, Exception) else str(error))
        for recorder in (o for o in observers if isinstance(o, Recorder)):
            recorder.ending = ending
            if isinstance(error, StoppedError) and recorder.recorded_ns > 0:
                error.kept = str(recorder.path)
        raise
    finally:
        for observer in reversed(watching):
            observer.on_close()
