"""What a recording holds: one line for each channel, with its topic, its schema and what it takes from a run.

Numbers and pictures are stored once, packed. Stock viewers open the recording without a converter: rerun draws the
point clouds and the log, Foxglove draws the scenes as well and plots `cosim.Load`. Every message
is in the frame ``world``; stamps are simulated time.

A channel from outside is one more line, before the run: ``CHANNELS["/mine"] = Channel(schema, When.WINDOW, take)``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from typing import Any

from foxglove_schemas_protobuf.FrameTransforms_pb2 import FrameTransforms
from foxglove_schemas_protobuf.Log_pb2 import Log
from foxglove_schemas_protobuf.PointCloud_pb2 import PointCloud
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate

from cosim.recording import messages, numbers, pictures, stresses, views


class When(Enum):
    """When a channel is asked for a message, and for what; channels that are due together write in their order."""

    WORLD = "once, first"  #: places that others name; ``take(info)``
    START = "once"  #: ``take(info)``
    WINDOW = "every window"  #: ``take(info, frame)``
    EVENT = "when it happens"  #: every event; ``take(info, event)``
    PICTURE = "every recorded frame"  #: ``take(info, frame)``
    VIEW = "for stock viewers, some 60 times in a run"  #: with a recorded frame; ``take(info, frame)``


@dataclass(frozen=True)
class Channel:
    """One topic of a recording."""

    schema: Any  #: class of its messages (protobuf)
    when: When
    take: Callable[..., bytes | None]  #: gives the serialised message; None: nothing to say
    about: str = "from outside"  #: one line for the table of channels


#: by topic; numbers of channels in the file follow this order and never depend on the run
CHANNELS: dict[str, Channel] = {
    "/structure/scene": Channel(SceneUpdate, When.START, views.structure_scene, "surface of the structure"),
    "/structure/points": Channel(PointCloud, When.START, views.structure_points, "points on its edges"),
    "/tf": Channel(FrameTransforms, When.WORLD, views.structure_place, "the frame `world`, and the structure in it"),
    "/load/structure": Channel(
        messages.Load,
        When.WINDOW,
        numbers.load,
        "forces and moments, totals, then by phase, for example `breaking_fx` [N], `sliding_my` [N m]; `attack_x` [m]",
    ),
    "/ledger": Channel(messages.Ledger, When.WINDOW, numbers.ledger, "balances by name [SI]"),
    "/events": Channel(messages.Event, When.EVENT, numbers.event, "kind, place, load, cells, cause"),
    "/log": Channel(Log, When.EVENT, numbers.event_line, "the same as a line"),
    pictures.SHEET: Channel(
        messages.Sheet,
        When.PICTURE,
        pictures.sheet,
        "places, damage and utilisation of the nodes, intact cells; packed",
    ),
    pictures.BLOCKS: Channel(messages.Blocks, When.PICTURE, pictures.blocks, "outlines, phases, sections; packed"),
    pictures.CONTACT: Channel(
        messages.Contact,
        When.PICTURE,
        pictures.contact,
        "forces [N] of nodes (`block` -1) and blocks, their places [m]",
    ),
    "/view/nodes": Channel(PointCloud, When.VIEW, views.ice_nodes, "nodes with damage and utilisation, as points"),
    "/view/sheet": Channel(SceneUpdate, When.VIEW, views.ice_sheet, "the sheet as a solid"),
    "/view/rubble": Channel(SceneUpdate, When.VIEW, views.rubble_scene, "blocks as prisms, coloured by phase"),
    "/view/outline": Channel(PointCloud, When.VIEW, views.rubble_outline, "points on the edges of the blocks"),
    "/load/budget": Channel(messages.Ledger, When.WINDOW, numbers.budget, "what carries the load [N]"),
    "/structure/motion": Channel(
        messages.Ledger,
        When.WINDOW,
        numbers.motion,
        "of a structure that moves: `surge` to `yaw` [m], [rad], and `surge_rate` to `yaw_rate`",
    ),
    stresses.BEGAN: Channel(
        messages.Stresses,
        When.WINDOW,
        stresses.began,
        "stresses at which cells began to crack or failed: mean and half the difference of the principal ones, "
        "limit [Pa]",
    ),
    stresses.WORST: Channel(
        messages.Stresses, When.PICTURE, stresses.worst, "the same of the 24 cells that are used most"
    ),
}


def table() -> str:
    """All channels as a table in Markdown."""
    head = "| topic | schema | holds | when |\n|---|---|---|---|\n"
    rows = (
        f"| `{topic}` | `{c.schema.DESCRIPTOR.full_name}` | {c.about} | {c.when.value} |\n"
        for topic, c in CHANNELS.items()
    )
    return head + "".join(rows)
