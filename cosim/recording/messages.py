"""Messages that no well-known schema covers: loads by phase, events with their forces, the ledger.

Built without a protobuf compiler. Foxglove plots them by path, for example ``/load/structure.breaking_fx``.
"""

from __future__ import annotations

from typing import Any

from google.protobuf import descriptor_pb2, descriptor_pool, message_factory, timestamp_pb2

from cosim.analysis.run_data import AXES
from coupling.interface import NS, PHASES

LOAD_FIELDS = (*AXES, *(f"{phase}_{axis}" for phase in PHASES for axis in AXES))  #: [N]; totals, then by phase

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
    _message(file, "Load", [(name, number) for name in LOAD_FIELDS])
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
    pool = descriptor_pool.Default()
    pool.Add(file)
    return {
        name: message_factory.GetMessageClass(pool.FindMessageTypeByName(f"cosim.{name}"))
        for name in ("Load", "Event", "Ledger")
    }


_classes = _build()
Load, Event, Ledger = _classes["Load"], _classes["Event"], _classes["Ledger"]


def stamp(message: Any, t_ns: int) -> None:
    """Set a protobuf timestamp from integer nanoseconds; also at zero, so that it is never unset."""
    message.SetInParent()
    message.seconds, message.nanos = divmod(t_ns, NS)
