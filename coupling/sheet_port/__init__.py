"""The sheet as a participant: joins the lattice to structure and rubble. The only room of coupling that knows `lattice`."""

from coupling.sheet_port.port import SheetPort

__all__ = ["SheetPort"]
