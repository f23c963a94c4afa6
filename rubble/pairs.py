"""Where bodies are put before pymunk finds their pairs: in the axes of the structure, which stands still in them."""

from __future__ import annotations

import numpy as np

from rubble.arbiters import COUNT
from rubble.compiled import compiled
from rubble.gather import Scene
from rubble.moving import move_structure, own_axes
from rubble.plates import times
from rubble.pointers import set_integer, set_real, step_space


@compiled(nogil=True, borrows=True)
def find_pairs(scene: Scene) -> None:
    """Put the bodies where plates and edges are, and let pymunk find contacts, section by section."""
    plates, slices, sections, edges = scene.plates, scene.slices, scene.sections, scene.edges
    layout, moving = sections.body, scene.moving
    move_structure(moving, scene.dt)
    for s in range(slices.body.shape[0]):
        k = slices.plate[s]
        r, b, p, body = plates.rotation[k], slices.anchor[s], plates.position[k], slices.body[s]
        x, _, z = times(r, b[0], b[1], b[2])
        x, z = own_axes(moving, sections.y[slices.section[s]], p[0] + x, p[2] + z)
        set_real(body + layout.x, x)
        set_real(body + layout.z, z)
        set_real(body + layout.angle, np.arctan2(r[2, 0], r[0, 0]) + moving.place[4])
    for e in range(edges.body.shape[0]):
        if edges.body[e] != 0:
            foremost = edges.nodes[edges.offset[e]]
            x, z = own_axes(moving, sections.y[e], foremost.x, foremost.z)
            set_real(edges.body[e] + layout.x, x)
            set_real(edges.body[e] + layout.z, z)
            set_real(edges.body[e] + layout.angle, moving.place[4])
    for i in range(sections.space.shape[0]):
        set_integer(sections.pairs[i] + COUNT, 0)
        step_space(sections.step, sections.space[i], scene.dt)
