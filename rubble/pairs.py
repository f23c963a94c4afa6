"""Where bodies are put before pymunk finds their pairs: in the axes of the structure, which stands still in them."""

from __future__ import annotations

import numpy as np

from rubble.arbiters import COUNT
from rubble.compiled import compiled
from rubble.gather import Scene
from rubble.moving import own_axes
from rubble.plates import times
from rubble.pointers import set_integer, set_real, step_space
from rubble.team import Team, together


@compiled(nogil=True, borrows=True)
def find_pairs(team: Team, scene: Scene) -> None:
    """Puts the bodies where plates and edges are, and lets pymunk find contacts: each of a team in its own sections."""
    sections = scene.sections
    for s in range(scene.slices.body.shape[0]):
        if scene.slices.section[s] % team.size == team.member:
            _place_slice(scene, s)
    for i in range(team.member, sections.space.shape[0], team.size):
        if i < scene.edges.body.shape[0] and scene.edges.body[i] != 0:
            _place_edge(scene, i)
        set_integer(sections.pairs[i] + COUNT, 0)
        step_space(sections.step, sections.space[i], scene.dt)
    together(team)


@compiled(nogil=True, borrows=True, forceinline=True)
def _place_slice(scene: Scene, s: int) -> None:
    """The body of a slice."""
    plates, slices, sections, moving = scene.plates, scene.slices, scene.sections, scene.moving
    k, body, layout = slices.plate[s], slices.body[s], sections.body
    r, b, p = plates.rotation[k], slices.anchor[s], plates.position[k]
    x, _, z = times(r, b[0], b[1], b[2])
    x, z = own_axes(moving, sections.y[slices.section[s]], p[0] + x, p[2] + z)
    set_real(body + layout.x, x)
    set_real(body + layout.z, z)
    set_real(body + layout.angle, np.arctan2(r[2, 0], r[0, 0]) + moving.place[4])


@compiled(nogil=True, borrows=True, forceinline=True)
def _place_edge(scene: Scene, e: int) -> None:
    """The body of the sheet's edge in a section."""
    edges, sections, moving = scene.edges, scene.sections, scene.moving
    foremost, body, layout = edges.nodes[edges.offset[e]], edges.body[e], sections.body
    x, z = own_axes(moving, sections.y[e], foremost.x, foremost.z)
    set_real(body + layout.x, x)
    set_real(body + layout.z, z)
    set_real(body + layout.angle, moving.place[4])
