"""What pictures of a run have around the ice: structure, sections, sizes. Read from the scenario that it carries."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass, replace

import numpy as np

from cosim.analysis.run_data import RunData
from cosim.build import build_structure
from cosim.build_rubble import sections_of
from cosim.errors import InputError
from cosim.scenario.model import ScenarioModel
from cosim.scenario.scenario import Scenario
from coupling.interface import FREEDOMS, Array, Structure

TOWER_RADIUS, TOWER_HEIGHT = 0.35, 1.2  #: of a tower that is drawn and not modelled, per radius at the top
DEEPEST = 12.0  #: thicknesses of the ice below the water to which a structure is drawn


@dataclass(frozen=True)
class Scene:
    """Around the ice of a run."""

    structure: Structure  #: what the ice meets
    origin: float  #: y of section 0 [m]
    pitch: float  #: width of a section [m]
    thickness: float  #: of the ice [m]
    width: float  #: of the floe [m]
    place: tuple[float, ...] = (0.0,) * 6  #: of the structure from where it was built: surge to yaw [m, rad]

    def at(self, run: RunData, t_ns: int) -> Scene:
        """The scene at a time: of a structure that moves, where it is then."""
        return replace(self, place=place_at(run, t_ns))

    @property
    def reach(self) -> float:
        """How far the structure reaches against the drift [m]; a slope that does not end: nothing."""
        half = self.structure.half_width
        return half if np.isfinite(half) else 0.0

    def section_at(self, y: float) -> int:
        """Number of the section that holds y."""
        return round((y - self.origin) / self.pitch)

    def centre(self, section: int) -> float:
        """Y of a section's middle [m]."""
        return self.origin + self.pitch * section

    def bottom(self) -> float:
        """Lowest point of the structure in pictures [m]."""
        return max(self.structure.bottom, -DEEPEST * self.thickness)

    def cut(self, y: float) -> Array:
        """Outline (n, 2) of the structure's cut by a section, in x and z; (0, 2) if it misses. Without roll and yaw."""
        s = self.structure
        front, rear = s.section(y - self.place[1], self.bottom(), s.top, 0.01 * self.thickness)
        if len(front) and not len(rear):  # a slope that does not end
            end = front[:, 0].max() + 10.0 * self.thickness
            rear = np.array([[end, front[0, 1]], [end, front[-1, 1]]])
        if not len(front):
            return np.empty((0, 2))
        c, d = np.cos(self.place[4]), np.sin(self.place[4])
        own: Array = np.concatenate((front, rear[::-1]))
        return np.asarray(own @ np.array([[c, -d], [d, c]]) + np.array([self.place[0], self.place[2]]))

    def waterline(self) -> Array:
        """Outline (n, 2) of the structure at the waterline, in x and y; a slope that does not end: its front (2, 2)."""
        s, shift = self.structure, np.array(self.place[:2])
        if not np.isfinite(s.half_width):
            y = np.array([-0.5, 0.5]) * self.width
            return np.asarray(np.column_stack((s.face_x(y, np.zeros(2)), y)) + shift)
        y = s.half_width * np.sin(np.linspace(-0.5, 0.5, 121) * np.pi)
        x = np.nan_to_num(s.face_x(y, np.zeros(len(y))))
        return np.asarray(np.concatenate((np.column_stack((x, y)), np.column_stack((-x, y))[::-1])) + shift)

    def tower(self) -> tuple[float, float, float] | None:
        """Radius, lower and upper end of the tower that stands on the structure [m]; None on a slope without an end."""
        s = self.structure
        if not np.isfinite(s.half_width):
            return None
        radius = TOWER_RADIUS * s.half_width
        if not s.faces_down:  # a cone that narrows upwards carries its tower on its upper end
            radius = float(-s.face_x(0.0, s.top))
        return radius, s.top, s.top + TOWER_HEIGHT * s.half_width


def place_at(run: RunData, t_ns: int) -> tuple[float, ...]:
    """Displacement of the structure in the window that holds a time, surge to yaw [m, rad]; zeros where it rests."""
    if not run.motion or not len(run.t_ns):
        return (0.0,) * 6
    k = min(int(np.searchsorted(run.t_ns, t_ns)), len(run.t_ns) - 1)
    return tuple(float(run.motion[name][k]) for name in FREEDOMS)


def scene_of(run: RunData) -> Scene:
    """Of a recorded run; InputError if its scenario cannot be read."""
    try:
        text = run.texts["scenario.toml"]
        raw = tomllib.loads(text)
        model = ScenarioModel.model_validate(raw)
    except (KeyError, ValueError) as error:
        raise InputError(f"{run.name}: its scenario cannot be read by this version; run it again") from error
    scenario = Scenario(run.name, text, raw, model)
    return Scene(build_structure(scenario), *sections_of(scenario), model.ice.thickness, model.sheet.width)
