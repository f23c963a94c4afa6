"""Objects become plain data and objects again: what they share, how arrays lie in memory, and no code from data."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from enum import Enum
from functools import partial
from typing import NamedTuple

import numpy as np
import pymunk
import pytest

from cosim.checkpoint.file import CheckpointError, Kept, Packed, read, write
from cosim.checkpoint.graph import UnknownKindError, graph_of
from cosim.checkpoint.restore import Restore, StrangeError


class Pair(NamedTuple):
    a: object
    b: object


class Colour(Enum):
    RED = 1


@dataclass
class Thing:
    """Something with a method of another thing, and an array."""

    held: object = None
    call: object = None
    more: dict = field(default_factory=dict)

    def twice(self):
        return 2 * self.held


@dataclass(frozen=True, slots=True)
class Slim:
    value: object


def through(root, twin):
    packed = Packed.of(graph_of(root))
    return Restore(*packed.read()).root(twin)


def test_numbers_keep_their_bits_and_kinds():
    values = [0.1, -0.0, float("inf"), 5e-324, 3, True, None, "x", 2**80, np.float64(0.1), np.int64(3), np.bool_(False)]
    again = through(values, [])
    assert [type(v) for v in again] == [type(v) for v in values]
    assert repr(again) == repr(values)
    assert np.isnan(through([float("nan")], [])[0])


def test_what_is_shared_is_shared_again():
    inner = {"x": [1.0]}
    root = {"a": inner, "b": inner, "c": Pair(inner, (inner["x"],)), 3: b"\0\1", "e": Thing(Slim(inner), None, inner)}
    twin = {"c": Pair(None, None), "e": Thing(Slim(None))}
    again = through(root, twin)
    assert again is twin
    assert again["a"] is again["b"] is again["c"].a is again["e"].more is again["e"].held.value
    assert again["c"].b[0] is again["a"]["x"]
    assert again[3] == b"\0\1"
    assert list(again) == list(root)
    loop = [1]
    loop.append(loop)
    again = through(loop, [])
    assert again[1] is again


def test_arrays_lie_in_memory_as_they_did():
    base = np.arange(24.0).reshape(2, 3, 4)
    record = np.dtype([("a", "f8"), ("b", "i8")], align=True)
    rows = np.zeros(3, record)
    rows["a"] = 7.0
    still = np.arange(3)
    still.flags.writeable = False
    views = {
        "base": base,
        "part": base[:, 1:, ::2],
        "turned": base.T,
        "back": base[::-1],
        "wide": np.broadcast_to(np.array([True]), (5, 2)),
        "column": np.asfortranarray(base[0]),
        "rows": rows,
        "field": rows["a"],
        "empty": np.zeros((0, 3)),
        "still": still,
    }
    again = through(views, {})
    for name, array in views.items():
        new = again[name]
        assert (new.dtype, new.shape) == (array.dtype, array.shape), name
        assert new.strides == array.strides or not array.size, name
        assert new.flags.writeable == array.flags.writeable, name
        assert new.dtype.isalignedstruct == array.dtype.isalignedstruct
        assert (new == array).all()
        assert not np.shares_memory(new, array)
        assert new.size == 0 or (new.ctypes.data - array.ctypes.data) % 64 == 0, name
    again["base"][1, 2, 0] = -1.0
    assert again["part"][1, 1, 0] == again["turned"][0, 2, 1] == again["back"][0, 2, 0] == -1.0
    again["rows"]["a"][1] = 8.0
    assert again["field"].tolist() == [7.0, 8.0, 7.0]


def test_what_went_through_once_is_no_larger_the_second_time():
    root = [np.arange(10.0)[3:], np.zeros((3, 5)).T]
    once = Packed.of(graph_of(root))
    twice = Packed.of(graph_of(Restore(*once.read()).root([])))
    assert [len(content) for _, content in once.pieces] == [len(content) for _, content in twice.pieces]
    assert once == twice


def test_code_and_whoever_holds_it_are_those_of_the_twin():
    def tree():
        inner = Thing(3.0)
        return Thing(inner, inner.twice, {"f": partial(pow, 2.0)}), inner

    (root, inner), (twin, own) = tree(), tree()
    inner.held = 5.0
    again = through(root, twin)
    assert again is twin
    assert again.held is own
    assert again.call() == 10.0  # the twin's method, of the object that has taken on the state
    assert again.more["f"](3.0) == 8.0


def test_what_the_twin_shares_the_state_need_not_share():
    shared = [0.0]
    again = through([[1.0], [2.0]], [shared, shared])
    assert again == [[1.0], [2.0]]


def test_what_cannot_be_kept_is_named_with_its_place():
    for thing, kind in (
        (pymunk.Space(), "pymunk"),
        (np.array([object()]), "object"),
        (np.random.default_rng(1), "random"),
    ):
        with pytest.raises(UnknownKindError, match=rf"{kind}.* at a\[1\]"):
            graph_of(_at(thing))


def _at(thing):
    class Root:
        def __init__(self):
            self.a = [0, thing]

    return Root()


@pytest.mark.parametrize(
    "nodes",
    [
        [["object", "subprocess:Popen", {"args": "x"}]],
        [["object", "os:_wrap_close", {}]],
        [["object", "cosim.cli.__main__:main", {}]],
        [["object", "cosim.outputs:os.path", {}]],
        [["object", "cosim.errors:InputError", {}]],
        [["row", "collections:namedtuple", []]],
        [["list", [{}]]],
        [["root", []]],
        [["__init__", []]],
        [["list", [[7]]]],
        [["array", [0, 8, [4], [8], "<f8", True]]],
        [["array", [0, 0, [4], [8], "|O", True]]],
        [["array", [0, -8, [1], [8], "<f8", True]]],
        [["number", "|O", "00" * 8]],
        [["tuple", [[0]]]],
        [[]],
        [],
    ],
)
def test_strange_data_are_refused(nodes):
    with pytest.raises(StrangeError):
        Restore(nodes, [np.zeros(32, np.uint8)]).root([])


def test_a_file_is_read_as_it_was_written_and_damage_is_noticed(tmp_path):
    path = tmp_path / "x.checkpoint"
    root = {"a": np.arange(1000.0), "b": [1, "two"]}
    write(path, Kept({"who": "me"}, {"p": Packed.of(graph_of(root)), "q": Packed.of(graph_of([1]))}))
    kept = read(path)
    assert kept.header["who"] == "me"
    again = Restore(*kept.parts["p"].read()).root({})
    assert (again["a"] == root["a"]).all()
    assert Restore(*kept.parts["q"].read()).root([]) == [1]
    data = path.read_bytes()
    for k in range(0, len(data), max(1, len(data) // 200)):
        path.write_bytes(data[:k] + bytes([data[k] ^ 16]) + data[k + 1 :])
        with pytest.raises(CheckpointError, match=r"damaged|no checkpoint"):
            read(path)
        path.write_bytes(data[:k])
        with pytest.raises(CheckpointError, match=r"damaged|no checkpoint"):
            read(path)


def test_a_file_is_not_unpacked_beyond_what_it_says(tmp_path):
    path = tmp_path / "x.checkpoint"
    kept = Kept({}, {"p": Packed.of(graph_of([np.zeros(10**6)]))})
    write(path, kept)
    first, _, rest = path.read_bytes().partition(b"\n")
    _, _, rest = rest.partition(b"\n")
    told, _, body = rest.partition(b"\n")
    import hashlib

    for size in (1000, -1, 2**60):
        header = json.dumps({**json.loads(told), "size": size}).encode()
        digest = hashlib.sha256(header + body).hexdigest().encode()
        path.write_bytes(b"\n".join((first, digest, header, body)))
        with pytest.raises(CheckpointError, match="cannot be read"):
            read(path)
