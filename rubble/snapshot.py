"""Save and continue: the whole rubble as bytes, and back.

Two layers loaded from the same bytes go on with the same bits, also in another process. A layer that goes on without
having been loaded may differ in the last bits, because pymunk's own order of bodies and contacts is rebuilt on loading.
So a run that must be repeatable from its checkpoints continues from the copy: ``layer, saved = checkpoint(layer)``.
The sub-step stays constant across a snapshot.
"""

from __future__ import annotations

import pickle

from rubble.layer import RubbleLayer


def save(layer: RubbleLayer) -> bytes:
    """The layer as it is between two windows, without the function that gives the structure."""
    return pickle.dumps(layer, protocol=5)


def restore(saved: bytes, like: RubbleLayer) -> RubbleLayer:
    """A layer from `save`; its structure is that of the layer ``like``."""
    layer = pickle.loads(saved)
    if not isinstance(layer, RubbleLayer):
        raise ValueError("these bytes are no snapshot of a rubble layer; use what rubble.snapshot.save returned")
    layer.connect_like(like)
    return layer


def checkpoint(layer: RubbleLayer) -> tuple[RubbleLayer, bytes]:
    """Save, and the copy from which the run has to go on."""
    saved = save(layer)
    return restore(saved, layer), saved
