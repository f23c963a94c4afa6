"""Figures of the ice for pages: plan and section at an instant, the load along the waterline over time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from cosim.recording.pictures import Picture
from cosim.show.ice.history import Look
from cosim.show.ice.plan import draw_plan
from cosim.show.ice.scene import Scene
from cosim.show.ice.section import draw_section
from cosim.show.scale import scale_of
from coupling.interface import NS, Array

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def draw_look(figure: Figure, scene: Scene, look: Look) -> None:
    """Plan, its section dashed, and that section."""
    plan, section = figure.subplots(1, 2, width_ratios=(1.25, 1.0))
    draw_plan(plan, scene, look)
    draw_section(section, scene, look.picture, look.section)


def along_waterline(scene: Scene, pictures: Sequence[Picture]) -> tuple[Array, Array, Array]:
    """Edges of slices across the drift (k + 1,) [m], times (n,) [s], force per width of a slice (n, k) [N/m].

    Slices are as wide as the sections of the blocks; the force is the magnitude of the sum of all forces in a slice.
    """
    places = [p.forces.position[:, 1] for p in pictures if len(p.forces.force)]
    if not places:
        return np.empty(0), np.empty(0), np.empty((0, 0))
    low, high = (scene.section_at(float(end)) for end in (np.concatenate(places).min(), np.concatenate(places).max()))
    pitch, count = scene.pitch, high - low + 1
    edges = scene.centre(low) + pitch * (np.arange(count + 1) - 0.5)
    load = np.zeros((len(pictures), count, 3))
    for row, picture in zip(load, pictures, strict=True):
        slices = np.rint((picture.forces.position[:, 1] - scene.origin) / pitch).astype(int) - low
        np.add.at(row, np.clip(slices, 0, count - 1), picture.forces.force)
    size: Array = np.sqrt((load**2).sum(axis=2)) / pitch
    return np.asarray(edges, np.float64), np.array([p.t_ns / NS for p in pictures]), size


def draw_waterline(figure: Figure, scene: Scene, pictures: Sequence[Picture]) -> None:
    """Load per width over time and place across the drift; right, its mean and its largest value."""
    edges, t, load = along_waterline(scene, pictures)
    if not len(t):
        return
    over_time, profile = figure.subplots(1, 2, sharey=True, width_ratios=(3.0, 1.0))
    scale = scale_of((float(load.max()),), "N")
    ends = np.append(t, t[-1] + (t[-1] - t[-2] if len(t) > 1 else 1.0))
    shown = np.ma.masked_equal(load.T, 0.0) / scale.size  # white: nothing
    mesh = over_time.pcolormesh(ends, edges, shown, cmap="magma_r", vmin=0.0, rasterized=True)
    figure.colorbar(mesh, ax=over_time, label=f"load per width [{scale.unit}/m]", location="top", shrink=0.6)
    over_time.set(xlabel="time [s], recorded frames; white: no load", ylabel="y [m]")
    middle = 0.5 * (edges[1:] + edges[:-1])
    profile.step(load.mean(axis=0) / scale.size, middle, where="mid", color="#0072b2", label="mean")
    profile.step(load.max(axis=0) / scale.size, middle, where="mid", color="#c0185a", ls="--", label="largest")
    profile.set(xlabel=f"[{scale.unit}/m]", xlim=(0.0, None))
    profile.legend(fontsize=8)
    profile.grid(alpha=0.3)
