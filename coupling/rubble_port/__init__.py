"""The rubble as a participant: joins blocks to sheet and structure. Only this room of coupling knows `rubble`."""

from coupling.rubble_port.no_rubble import NoRubble
from coupling.rubble_port.port import OUTLINE_TOLERANCE, RubblePort

__all__ = ["OUTLINE_TOLERANCE", "NoRubble", "RubblePort"]
