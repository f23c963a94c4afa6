"""Messages that no well-known schema covers: loads and moments by phase, forces at their places, events, the ledger.

The pictures of sheet and blocks are among them; `cosim.recording.pictures` packs them.

Built without a protobuf compiler. Foxglove plots them by path, for example ``/load/structure.breaking_fx``.
"""

from __future__ import annotations

from typing import Any

from google.protobuf import descriptor_pb2, descriptor_pool, message_factory, timestamp_pb2

from cosim.analysis.run_data import AXES, MOMENT_AXES
from coupling.interface import NS, PHASES

LOAD_FIELDS = (*AXES, *(f"{phase}_{axis}" for phase in PHASES for axis in AXES))  #: [N]; totals, then by phase
MOMENT_FIELDS = (*MOMENT_AXES, *(f"{phase}_{axis}" for phase in PHASES for axis in MOMENT_AXES))  #: [N m]; likewise
#: sum of the magnitudes of the forces [N], and of each times its place [N m]; point of attack [m], nan without a load
GRIP_FIELDS = ("weight", "weight_x", "weight_y", "weight_z", "attack_x", "attack_y", "attack_z")
NAMES = ("Load", "Event", "Ledger", "Contact", "Sheet", "Blocks", "Stresses")
#: packed as `cosim.recording.planes` does it
SHEET_BYTES = ("dx", "dy", "z", "damage", "utilisation", "present", "intact", "elastic")
BLOCKS_BYTES = ("id", "section", "phase", "corners", "x", "y", "z", "width", "corner_x", "corner_z")

_Field = descriptor_pb2.FieldDescriptorProto


def _message(file: Any, name: str, fields: list[tuple[str, int]], repeated: tuple[str, ...] = ()) -> None:
    """Add a message whose first field is ``stamp``; ``fields`` are (name, protobuf type)."""
    message = file.message_type.add(name=name)
    message.field.add(
        name="stamp",
        number=1,
        type=_Field.TYPE_MESSAGE,
        label=_Field.LABEL_OPTIONAL,
        type_name=".google.protobuf.Timestamp",
    )
    for number, (field, kind) in enumerate(fields, start=2):
        label = _Field.LABEL_REPEATED if field in repeated else _Field.LABEL_OPTIONAL
        message.field.add(name=field, number=number, type=kind, label=label)


def _build() -> dict[str, Any]:
    number, text, whole = _Field.TYPE_DOUBLE, _Field.TYPE_STRING, _Field.TYPE_INT64
    file = descriptor_pb2.FileDescriptorProto(name="cosim.proto", package="cosim", syntax="proto3")
    file.dependency.append(timestamp_pb2.DESCRIPTOR.name)
    _message(file, "Load", [(name, number) for name in (*LOAD_FIELDS, *MOMENT_FIELDS, *GRIP_FIELDS)])
    _message(
        file,
        "Event",
        [
            ("kind", text),
            *((axis, number) for axis in AXES),
            ("cells", whole),
            ("x", number),
            ("y", number),
            ("z", number),
            ("text", text),
            ("length", number),
            ("area", number),
            ("cause", text),
        ],
    )
    _message(file, "Ledger", [("name", text), ("value", number)], repeated=("name", "value"))
    places, raw, count = ("x", "y", "z", *AXES), _Field.TYPE_BYTES, _Field.TYPE_UINT32
    contact = [*((name, _Field.TYPE_FLOAT) for name in places), ("phase", count), ("block", whole)]
    _message(file, "Contact", contact, repeated=(*places, "phase", "block"))
    grid = [
        ("rows", count),
        ("columns", count),
        *((name, number) for name in ("quantum", "x", "y", "step_x", "step_y")),
    ]
    _message(file, "Sheet", [*grid, *((name, raw) for name in SHEET_BYTES)])
    _stresses(file)
    _message(file, "Blocks", [("quantum", number), *((name, raw) for name in BLOCKS_BYTES)])
    pool = descriptor_pool.Default()
    pool.Add(file)
    return {name: message_factory.GetMessageClass(pool.FindMessageTypeByName(f"cosim.{name}")) for name in NAMES}


def _stresses(file: Any) -> None:
    """Lines of the criteria (`cosim.stresses.Line`), then cells."""
    single, count = _Field.TYPE_FLOAT, _Field.TYPE_UINT32
    fields = [("name", _Field.TYPE_STRING)]
    fields += [(name, _Field.TYPE_DOUBLE) for name in ("along_mean", "along_radius", "strength")]
    fields += [("cell", count), ("criterion", count), *((name, single) for name in ("mean", "radius", "limit"))]
    _message(file, "Stresses", fields, repeated=tuple(name for name, _ in fields))


_classes = _build()
Load, Event, Ledger, Contact, Sheet, Blocks, Stresses = (_classes[name] for name in NAMES)


def stamp(message: Any, t_ns: int) -> None:
    """Set a protobuf timestamp from integer nanoseconds; also at zero, so that it is never unset."""
    message.SetInParent()
    message.seconds, message.nanos = divmod(t_ns, NS)
