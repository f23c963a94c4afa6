"""Pieces of broken ice between two runs: written at the end of one, read where another begins.

A floe that follows meets the structure with the rubble of the one before, locked or loose as it is. The file is JSON in
SI units, with every number to its last digit; pieces may be taken out by hand. What is left of the sheet is among them,
a rigid plate for each part that hangs together: halves and pieces between the next floe and the structure.
"""

from __future__ import annotations

from itertools import pairwise
from math import ceil
from pathlib import Path
from typing import Annotated, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, ValidationError

from cosim.errors import InputError
from cosim.scenario.scenario import Scenario
from coupling.interface import NS, Array
from coupling.rubble_port import RubblePort
from coupling.scheduler import Scheduler
from coupling.sheet_port import SheetPort
from lattice.fragments import front_x
from rubble.geometry import clip
from rubble.roster import Entry, PlateState, PrismState, enter, entries, roster

SAME = 1e-6  #: relative difference of thickness and density to which ice is the same
FLAT = 0.1  #: share of the thickness at top and bottom of the floe beside which ice may lie: it lies under or on it

Three = tuple[FiniteFloat, FiniteFloat, FiniteFloat]
Positive = Annotated[FiniteFloat, Field(gt=0.0)]


class _Part(BaseModel):
    model_config = ConfigDict(extra="forbid")


class _Prism(_Part):
    outline: Annotated[list[tuple[FiniteFloat, FiniteFloat]], Field(min_length=3)]
    y: FiniteFloat
    cuts: Annotated[list[FiniteFloat], Field(min_length=2)]
    widths: Annotated[list[Positive], Field(min_length=1)]


class _Plate(_Part):
    position: Three
    quaternion: tuple[FiniteFloat, FiniteFloat, FiniteFloat, FiniteFloat]
    velocity: Three
    omega: Three
    flooded: Annotated[FiniteFloat, Field(ge=0.0, le=1.0)]
    aligned: bool
    sliding: bool
    prisms: Annotated[list[_Prism], Field(min_length=1)]


class Pieces(_Part):
    """What the file holds."""

    format: Literal["brash pieces 1"] = "brash pieces 1"
    scenario: str  #: title of the run that wrote it
    time: FiniteFloat  #: at its end [s]
    thickness: Positive  #: of the ice [m]
    density: Positive  #: [kg/m^3]
    plates: list[_Plate]


def read(path: Path) -> Pieces:
    """InputError with one line if it is no such file."""
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        raise InputError(f"{path}: no such file; give a path from the folder of the scenario (rubble.pieces)") from None
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: cannot be read ({error}); give a file by `cosim run --pieces`") from None
    try:
        return Pieces.model_validate_json(text)
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"]) or "its text"
        raise InputError(f"{path}: {where}: {first['msg']}; give a file by `cosim run --pieces`") from None


def checked(path: Path, scenario: Scenario) -> list[Entry]:
    """What enters the rubble from a file, which is of the ice of this scenario."""
    found, ice = read(path), scenario.ice
    for what, theirs, ours, unit in (
        ("thickness", found.thickness, ice.thickness, "m"),
        ("density", found.density, ice.density, "kg/m3"),
    ):
        if abs(theirs - ours) > SAME * ours:
            raise InputError(
                f"{path}: its pieces have a {what} of {theirs:g} {unit}, ice.{what} is {ours:g} {unit}; pieces and "
                "sheet are of the same ice"
            )
    for number, plate in enumerate(found.plates):
        if abs(float(np.linalg.norm(plate.quaternion)) - 1.0) > SAME:
            raise InputError(f"{path}: plates.{number}.quaternion has not the length 1; it is the turn of the plate")
    try:
        return entries([_state(p) for p in found.plates], ice.density)
    except ValueError as error:
        raise InputError(f"{path}: {error}") from error


def put(path: Path, scenario: Scenario, sheet: SheetPort, rubble: RubblePort) -> None:
    """The rubble has the pieces of a file; InputError where the floe would lie on them."""
    enter(rubble.layer, checked(path, scenario))
    missing = lies_in_floe(sheet, rubble)
    if missing > 0.0:
        gap = scenario.sheet.gap
        least = ceil(100.0 * (gap + missing)) / 100.0
        raise InputError(
            f"{path}: a piece reaches {missing:.3g} m into the floe as it begins; give sheet.gap of {least:.2f} m or "
            f"more (it is {gap:g} m)"
        )


def lies_in_floe(sheet: SheetPort, rubble: RubblePort) -> float:
    """How far pieces beside the floe, neither under nor on it, reach behind its front [m]; 0 if none does."""
    grid, ice, layer = sheet.sheet.grid, sheet.sheet.ice, rubble.layer
    front = front_x(grid, sheet.sheet.present)
    top, bottom = ice.freeboard - FLAT * ice.h, ice.freeboard - (1.0 - FLAT) * ice.h
    sides, worst = layer.corners.reshape(2, -1, 3), 0.0
    for first, end in pairwise(layer.store.tables.pieces.offset):
        y = (sides[:, first:end, 1] - grid.y0) / grid.d  # columns are half a cell wide to either side
        columns = slice(max(int(np.ceil(y.min() - 0.5)), 0), max(int(np.floor(y.max() + 0.5)) + 1, 0))
        for side in sides[:, first:end, ::2]:
            inside = clip(clip(np.ascontiguousarray(side), 0.0, 1.0, top), 0.0, -1.0, -bottom)
            if len(inside):
                worst = max(worst, float((front[columns] - inside[:, 0].min()).max(initial=0.0)))
    return worst


def write(scheduler: Scheduler, scenario: Scenario, path: Path) -> None:
    """All pieces at the end of a run, and what is left of its sheet; the run is over then."""
    sheet, rubble = scheduler.sheet, scheduler.rubble
    assert isinstance(rubble, RubblePort)
    assert isinstance(sheet, SheetPort)
    for part in sheet.remains():
        rubble.add(part)
    found = Pieces(
        scenario=scenario.title,
        time=scheduler.t_ns / NS,
        thickness=scenario.ice.thickness,
        density=scenario.ice.density,
        plates=[_plate(state) for state in roster(rubble.layer)],
    )
    path.write_text(found.model_dump_json(indent=1) + "\n", encoding="utf-8")


def _plate(s: PlateState) -> _Plate:
    prisms = [
        _Prism.model_validate(
            {"outline": p.outline.tolist(), "y": p.y, "cuts": p.cuts.tolist(), "widths": p.widths.tolist()}
        )
        for p in s.prisms
    ]
    arrays = {name: getattr(s, name).tolist() for name in ("position", "quaternion", "velocity", "omega")}
    return _Plate(**arrays, flooded=s.flooded, aligned=s.aligned, sliding=s.sliding, prisms=prisms)


def _state(p: _Plate) -> PlateState:
    prisms = tuple(PrismState(_array(q.outline), q.y, _array(q.cuts), _array(q.widths)) for q in p.prisms)
    arrays = {name: _array(getattr(p, name)) for name in ("position", "quaternion", "velocity", "omega")}
    return PlateState(**arrays, flooded=p.flooded, aligned=p.aligned, sliding=p.sliding, prisms=prisms)


def _array(values: object) -> Array:
    return np.array(values, np.float64)
