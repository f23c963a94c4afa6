"""What pictures of a run have in common: when each cell failed, where most happens, at which times to look."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np

from cosim.analysis.run_data import RunData
from cosim.recording.pictures import Picture
from coupling.interface import NS, PHASES, Array, Phase


@dataclass
class Failures:
    """Takes in pictures in order; of every cell the time at which it was first seen without its springs [s]."""

    time: Array = field(default_factory=lambda: np.empty(0))  #: (cells,); nan: it holds

    def see(self, picture: Picture) -> None:
        """Another picture, later than those before."""
        intact = picture.sheet.intact
        if len(self.time) != len(intact):
            self.time = np.full(len(intact), np.nan)
        new = ~intact & np.isnan(self.time)
        self.time[new] = picture.t_ns / NS


@dataclass(frozen=True)
class Look:
    """A picture worth seeing."""

    title: str
    picture: Picture
    failures: Array  #: (cells,) as of `Failures.time` at the picture
    section: float  #: y of the place where most happens [m]


def looks(run: RunData, pictures: Iterable[Picture]) -> list[Look]:
    """The peak of the load, and of each phase: the recorded frame before it, with the section that bears most.

    Empty phases have none. At most four, in the order of time.
    """
    wanted = _times(run)
    found: dict[str, Look] = {}
    failures, last = Failures(), dict.fromkeys(wanted, -1)
    for picture in pictures:
        failures.see(picture)
        for title, (t_ns, phase) in wanted.items():
            if last[title] < picture.t_ns <= t_ns or title not in found:
                last[title] = picture.t_ns
                found[title] = Look(title, picture, failures.time.copy(), busiest(picture, phase))
    return sorted(found.values(), key=lambda look: look.picture.t_ns)


def _times(run: RunData) -> dict[str, tuple[int, Phase | None]]:
    lasting = run.lasting
    out: dict[str, tuple[int, Phase | None]] = {}
    total = lasting.component("f")
    if total.any():
        out["peak of the load"] = (int(run.t_ns[int(total.argmax())]), None)
    for phase in Phase:
        name = PHASES[phase]
        values = lasting.component("f", name)
        if values.any():
            out[f"most load by {name}"] = (int(run.t_ns[int(values.argmax())]), phase)
    if total.any():  # one picture of an instant is enough
        at, _ = out["peak of the load"]
        same = next((title for title, (t_ns, _) in out.items() if t_ns == at and title != "peak of the load"), None)
        if same is not None:
            out[f"peak of the load, and {same}"] = out.pop(same)
            del out["peak of the load"]
    return out


def busiest(picture: Picture, phase: Phase | None = None) -> float:
    """The y at which most force acts, of all phases or of one; 0 without any [m]."""
    forces = picture.forces
    of = np.ones(len(forces.phase), bool) if phase is None else forces.phase == phase
    if not of.any():
        return 0.0
    size = np.linalg.norm(forces.force[of], axis=1)
    return float(forces.position[of][int(size.argmax()), 1])
