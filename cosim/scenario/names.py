"""Names that a scenario chooses from: those of the tables of the packages, so that a new entry can be chosen at once.

A table is imported when a name is checked, because listing scenarios needs no solver.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

from pydantic_core import PydanticCustomError, core_schema

from cosim.nearest import hint

if TYPE_CHECKING:
    from cosim.structures import Kind


def schemes() -> Iterable[str]:
    """Coupling schemes."""
    from coupling.schemes import SCHEMES

    return SCHEMES


def contacts() -> Iterable[str]:
    """Models of the contact between sheet and structure."""
    from coupling.crushing import CONTACTS

    return CONTACTS


def stiffness_sets() -> Iterable[str]:
    """Sets of spring stiffnesses of the lattice."""
    from lattice.stiffness import STIFFNESS_SETS

    return STIFFNESS_SETS


def kinds_of_structure() -> Mapping[str, Kind]:
    """Kinds of structure, with the keys that each takes."""
    from cosim.structures import KINDS

    return KINDS


def criteria() -> Iterable[str]:
    """Failure criteria of the sheet."""
    from lattice.criteria.table import CRITERIA

    return CRITERIA


def strengths_of(names: Iterable[str]) -> dict[str, str]:
    """Fields of `lattice.ice.Ice` that criteria need, each with the first criterion that needs it."""
    from lattice.criteria.table import chosen

    return {field: criterion.name for criterion in reversed(chosen(names)) for field in criterion.needs}


@dataclass(frozen=True)
class OneOf:
    """Refuses a name that the table does not hold, with the one that is meant most likely."""

    table: Callable[[], Iterable[str]]

    def check(self, name: str) -> str:
        """The name, if the table holds it."""
        if name not in self.table():
            raise PydanticCustomError("name", "unknown name; {hint}", {"hint": hint(name, self.table())})
        return name

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> core_schema.CoreSchema:
        return core_schema.no_info_after_validator_function(self.check, handler(source))


Scheme = Annotated[str, OneOf(schemes)]
StiffnessSet = Annotated[str, OneOf(stiffness_sets)]
StructureKind = Annotated[str, OneOf(kinds_of_structure)]
CriterionName = Annotated[str, OneOf(criteria)]
ContactModel = Annotated[str, OneOf(contacts)]
