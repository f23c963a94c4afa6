"""The sheet as a participant: joins the lattice to structure and rubble. Only this room of coupling knows `lattice`."""

from coupling.sheet_port.port import SheetPort

__all__ = ["SheetPort"]
