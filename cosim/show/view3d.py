"""The ice in three dimensions as a picture, drawn off screen by pyvista: no viewer, no screen, no Vulkan.

The camera stands where the ice comes from and frames what happens at the structure by itself. Water is a sheet that
lets see through; the tower on the structure is drawn, not modelled.
"""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from cosim.export.vtk import blocks_surface, sheet_grid, triangle_surface
from cosim.recording.pictures import Picture
from cosim.show.ice.palette import BLOCK, CRACK, EDGE, FORCE, SHALLOW, STRUCTURE, colormap
from cosim.show.ice.plan import cracked_cells
from cosim.show.ice.scene import Scene
from coupling.interface import Array, IntArray, Phase
from coupling.structure.moved import turned

WATER_RGB, SKY, DEEP = "#5b93b5", "#f4f8fb", "#c9dbe6"
SIDE_VIEW = (-0.74, -0.78, 0.42)  #: from which the camera looks, of its distance
AIM = 0.25  #: behind the face, to which it looks, in half widths of what it frames; before a slope that does not end
FAR = 4.8  #: distance of the camera in half widths of what it frames
NEAR = 1.0  #: from the camera, nothing nearer is seen; all of the sheet in the picture is three times as far


class View:
    """Draws pictures of one run, one after the other."""

    def __init__(self, scene: Scene, structure: tuple[Array, IntArray], size: tuple[int, int] = (1200, 900)) -> None:
        import pyvista as pv

        if os.name == "posix" and not os.environ.get("DISPLAY"):
            os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")
        vtk: Any = pv  # its types are partial
        vtk.vtk_verbosity("off")  # what it says about screens that are not there
        self._pv, self._scene = vtk, scene
        self._plotter: Any = vtk.Plotter(off_screen=True, window_size=list(size), lighting="three lights")
        self._plotter.set_background(DEEP, top=SKY)
        self._moving: list[str] = []
        self._still(structure)
        self._camera()

    def _still(self, structure: tuple[Array, IntArray]) -> None:
        """Structure, tower and water."""
        pv, scene, p = self._pv, self._scene, self._plotter
        solid = triangle_surface(*structure)
        closed = solid.fill_holes(1e6) if np.isfinite(scene.structure.half_width) else solid
        p.add_mesh(closed, color=STRUCTURE, smooth_shading=False, specular=0.1, name="structure")
        if (tower := scene.tower()) is not None:
            radius, low, high = tower
            axis = pv.Cylinder(
                center=(0, 0, 0.5 * (low + high)), radius=radius, height=high - low, direction=(0, 0, 1), resolution=64
            )
            p.add_mesh(axis, color="#f2f2ee", smooth_shading=True, split_sharp_edges=True, name="tower")
        self.reach = max(0.75 * self._radius(structure[0]), 7.0 * scene.thickness)
        far = 40.0 * self.reach
        water = pv.Plane(center=(0, 0, 0), direction=(0, 0, 1), i_size=far, j_size=far)
        p.add_mesh(water, color=WATER_RGB, opacity=0.45, specular=0.4, name="water")

    def _radius(self, points: Array) -> float:
        """Of the structure where it is seen; of a slope without an end that of a cone of the usual size."""
        if not np.isfinite(self._scene.structure.half_width):
            return max(8.0 * self._scene.thickness, 0.7 * min(self._scene.width, 30.0 * self._scene.thickness))
        seen = points[points[:, 2] > -2.0 * self._scene.thickness]
        return float(np.hypot(seen[:, 0], seen[:, 1]).max())

    def _camera(self) -> None:
        front = float(np.nan_to_num(self._scene.structure.face_x(0.0, 0.0)))
        aim = AIM if np.isfinite(self._scene.structure.half_width) else -AIM
        target = np.array([front + aim * self.reach, 0.0, 0.0])
        self._target = target
        self._place((0.0,) * 6)
        self._plotter.camera.up = (0.0, 0.0, 1.0)
        self._plotter.camera.view_angle = 30.0

    def _place(self, place: tuple[float, ...]) -> None:
        """The structure where it is, surge to yaw, the camera and the water with it."""
        moved, along = np.eye(4), np.eye(4)
        moved[:3, :3], moved[:3, 3], along[:2, 3] = turned(np.array(place[3:])), place[:3], place[:2]
        for name, matrix in (("structure", moved), ("tower", moved), ("water", along)):
            if name in self._plotter.actors:
                self._plotter.actors[name].user_matrix = matrix
        target = self._target + along[:3, 3]
        self._plotter.camera.position = tuple(target + FAR * self.reach * np.array(SIDE_VIEW))
        self._plotter.camera.focal_point = tuple(target)
        self._plotter.camera.clipping_range = (NEAR * self.reach, 80.0 * self.reach)

    def draw(self, picture: Picture, place: tuple[float, ...] = (0.0,) * 6) -> Array:
        """(height, width, 3) as bytes: the ice of a picture, the load as an arrow at its point of attack.

        ``place``: surge to yaw of the structure [m, rad].
        """
        p = self._plotter
        self._place(place)
        for name in self._moving:
            p.remove_actor(name, render=False)
        self._moving = []
        self._sheet(picture)
        surface = blocks_surface(picture.blocks)
        for phase in (Phase.ROTATING, Phase.SLIDING):
            chosen = (
                surface.extract_cells(np.flatnonzero(surface.cell_data["phase"] == phase)) if surface.n_cells else None
            )
            if chosen is not None and chosen.n_cells:
                self._add(f"rubble {phase}", chosen, color=BLOCK[phase], show_edges=False, split_sharp_edges=True)
        self._load(picture)
        p.render()
        image: Array = np.asarray(p.screenshot(return_img=True))
        return image[:, :, :3]

    def close(self) -> None:
        """Let go of the window."""
        self._plotter.close()

    def _add(self, name: str, mesh: Any, **look: Any) -> Any:
        self._moving.append(name)
        return self._plotter.add_mesh(mesh, name=name, render=False, reset_camera=False, **look)

    def _sheet(self, picture: Picture) -> None:
        grid = sheet_grid(picture.sheet, self._scene.thickness)
        if not grid.n_cells:
            return
        look: dict[str, Any] = {
            "scalars": "utilisation",
            "cmap": colormap(),
            "clim": (0.0, 1.0),
            "show_scalar_bar": False,
            "ambient": 0.35,
            "diffuse": 0.75,
        }
        self._add("sheet", grid, **look)
        quads, depth = cracked_cells(picture)
        if len(quads):
            top = picture.sheet.position + np.array([0.0, 0.0, 0.51 * self._scene.thickness])
            faces = np.column_stack((np.full(len(quads), 4), quads)).ravel()
            cracks = self._pv.PolyData(top, faces)
            cracks.cell_data["depth"] = depth
            look = {"cmap": [SHALLOW, CRACK], "clim": (0.0, 1.0), "show_scalar_bar": False, "opacity": 0.9}
            _in_front(self._add("cracks", cracks, scalars="depth", lighting=False, **look), 20.0)
        self._add("edges", grid.extract_feature_edges(40.0), color=EDGE, line_width=1.2, opacity=0.6)

    def _load(self, picture: Picture) -> None:
        force = picture.forces.force
        total = force.sum(axis=0) if len(force) else np.zeros(3)
        size = float(np.linalg.norm(total))
        if size == 0.0:
            return
        weight = np.linalg.norm(force, axis=1)
        start = weight @ picture.forces.position / weight.sum()
        length = 1.1 * self.reach
        arrow = self._pv.Arrow(
            start=start,
            direction=total / size,
            scale=length,
            shaft_radius=0.02,
            tip_radius=0.055,
            tip_length=0.2,
        )
        _in_front(self._add("load", arrow, color=FORCE), 66000.0)


def _in_front(actor: Any, units: float) -> None:
    """Draws it before what lies up to so many units of depth in front of it."""
    actor.mapper.SetResolveCoincidentTopologyToPolygonOffset()
    actor.mapper.SetRelativeCoincidentTopologyPolygonOffsetParameters(0.0, -units)
