"""A recording as a series for ParaView: a .pvd file that lists what lies in the folder of its name beside it.

Per recorded frame: the sheet as hexahedra with damage and utilisation at their corners, the blocks as closed prisms
with number, section and phase, the forces as vectors at their places. The structure is there once.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np

from cosim.recording import shapes
from cosim.recording.pictures import BlockShapes, Picture
from coupling.attack import PointForces
from coupling.interface import NS, Array, IntArray, SheetView

STRUCTURE = "structure.vtp"


def sheet_grid(sheet: SheetView, thickness: float) -> Any:
    """`pyvista.UnstructuredGrid` of the intact cells, each a hexahedron of this thickness [m]."""
    import pyvista as pv

    quads = shapes.upward(shapes.cell_quads(sheet.intact, sheet.cell_shape), sheet.position)
    used, corner = np.unique(quads, return_inverse=True)
    corner, n, half = corner.reshape(-1, 4), len(used), np.array([0.0, 0.0, thickness / 2])
    places = np.concatenate((sheet.position[used] - half, sheet.position[used] + half))
    cells = np.column_stack((np.full(len(quads), 8), corner, corner + n)).ravel()
    grid = pv.UnstructuredGrid(cells, np.full(len(quads), pv.CellType.HEXAHEDRON), places)
    for name, values in (
        ("damage", sheet.damage),
        ("utilisation", sheet.utilisation),
        ("node", np.arange(len(sheet.damage))),
    ):
        grid.point_data[name] = np.tile(values[used], 2)
    return grid


def blocks_surface(blocks: BlockShapes) -> Any:
    """`pyvista.PolyData` of all blocks, closed; number, section and phase of its block on every triangle."""
    points, faces, owner = shapes.prisms(blocks)
    surface = triangle_surface(points, faces)
    for name in ("id", "section", "phase"):
        surface.cell_data[name] = getattr(blocks, name)[owner]
    return surface


def forces_cloud(forces: PointForces) -> Any:
    """`pyvista.PolyData` of the places of the forces [N], with phase and block (-1: sheet)."""
    import pyvista as pv

    cloud = pv.PolyData(forces.position) if len(forces.position) else pv.PolyData()
    for name, values in (("force", forces.force), ("phase", forces.phase), ("block", forces.block)):
        cloud.point_data[name] = values
    return cloud


def triangle_surface(points: Array, faces: IntArray) -> Any:
    """`pyvista.PolyData` of triangles."""
    import pyvista as pv

    return (
        pv.PolyData(points, np.column_stack((np.full(len(faces), 3), faces)).ravel()) if len(faces) else pv.PolyData()
    )


def write_series(
    pictures: Iterable[Picture], structure: tuple[Array, IntArray], thickness: float, out: Path, folder: Path
) -> None:
    """Writes the .pvd ``out``, and its files into a folder that is there and lies where it will lie."""
    triangle_surface(*structure).save(folder / STRUCTURE)
    entries: list[tuple[float, int, str]] = []
    for number, picture in enumerate(pictures):
        for part, (name, item) in enumerate(_parts(picture, thickness)):
            file = f"{name.replace('*', f'{number:05d}')}"
            item.save(folder / file)
            entries.append((picture.t_ns / NS, part, file))
        entries.append((picture.t_ns / NS, 3, STRUCTURE))
    lines = (
        f'    <DataSet timestep="{t!r}" part="{part}" file={quoteattr(f"{folder.name}/{file}")}/>\n'
        for t, part, file in entries
    )
    head = '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1">\n  <Collection>\n'
    out.write_text(head + "".join(lines) + "  </Collection>\n</VTKFile>\n", encoding="utf-8")


def folder_of(out: Path) -> Path:
    """Where the files of a series lie."""
    return out.with_name(f"{out.stem}_vtk")


def _parts(picture: Picture, thickness: float) -> Iterator[tuple[str, Any]]:
    yield "sheet_*.vtu", sheet_grid(picture.sheet, thickness)
    yield "rubble_*.vtp", blocks_surface(picture.blocks)
    yield "forces_*.vtp", forces_cloud(picture.forces)
