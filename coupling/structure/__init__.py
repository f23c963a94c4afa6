"""Structures: what `coupling.interface.Structure` asks for, one file for each kind of surface."""

from coupling.structure.build import DEEP, cone, multi_sided_cone, plane_slope
from coupling.structure.multi_sided import MultiSidedCone
from coupling.structure.plane import PlaneSlope
from coupling.structure.profile import Profile
from coupling.structure.revolved import Revolved

__all__ = ["DEEP", "MultiSidedCone", "PlaneSlope", "Profile", "Revolved", "cone", "multi_sided_cone", "plane_slope"]
