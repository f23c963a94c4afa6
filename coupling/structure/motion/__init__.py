"""How structures move: models behind `coupling.interface.Motion`. A structure that rests has none."""

from coupling.structure.motion.linear import LinearMotion, modal, spring
from coupling.structure.motion.prescribed import Prescribed

__all__ = ["LinearMotion", "Prescribed", "modal", "spring"]
