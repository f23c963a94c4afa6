"""Save and continue: the whole rubble as bytes, and back.

Two layers loaded from the same bytes go on with the same bits, also in another process. A layer that goes on without
having been loaded may differ in the last bits, because pymunk's own order of bodies and contacts is rebuilt on loading.
So a run that must be repeatable from its checkpoints continues from the copy: ``layer, saved = checkpoint(layer)``.
The sub-step stays constant across a snapshot; pymunk checks that its version is the same.
"""

from __future__ import annotations

import io
import pickle
from typing import Any

from rubble.layer import RubbleLayer

_NO_COPY = "solids of the structure are given again when a snapshot is restored"


class _Pickler(pickle.Pickler):
    def __init__(self, file: io.BytesIO, layer: RubbleLayer) -> None:
        super().__init__(file, protocol=5)
        self.solids = layer.solids

    def persistent_id(self, obj: Any) -> str | None:
        """The function that gives the structure is not saved."""
        return _NO_COPY if obj is self.solids else None


class _Unpickler(pickle.Unpickler):
    def __init__(self, file: io.BytesIO, solids: Any) -> None:
        super().__init__(file)
        self.solids = solids

    def persistent_load(self, pid: Any) -> Any:
        return self.solids


def save(layer: RubbleLayer) -> bytes:
    """The layer as it is between two windows."""
    file = io.BytesIO()
    _Pickler(file, layer).dump(layer)
    return file.getvalue()


def restore(saved: bytes, like: RubbleLayer) -> RubbleLayer:
    """A layer from `save`; the structure is that of the layer ``like``."""
    layer = _Unpickler(io.BytesIO(saved), like.solids).load()
    if not isinstance(layer, RubbleLayer):
        raise ValueError("these bytes are no snapshot of a rubble layer; use what rubble.snapshot.save returned")
    return layer


def checkpoint(layer: RubbleLayer) -> tuple[RubbleLayer, bytes]:
    """Save, and the copy from which the run has to go on."""
    saved = save(layer)
    return restore(saved, layer), saved
