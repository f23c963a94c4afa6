"""Bytes packed from arrays are what the official protobuf classes read."""

import math

import numpy as np
import pytest
from foxglove_schemas_protobuf.PointCloud_pb2 import PointCloud
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate

from cosim.recording import messages, numbers, pictures, scenes, shapes, views
from cosim.recording.channels import CHANNELS, Channel, When
from cosim.recording.reader import messages as stored
from cosim.recording.reader import read_run
from cosim.scenario.loading import load_scenario
from coupling.interface import BlockTable, ContactForces, Event, Frame, SheetView


@pytest.fixture(scope="module")
def scenario():
    return load_scenario("van_vliet_2018_floe_165m", ["sheet.nodes=[40,40]"])


def test_triangles_are_read_back_bit_by_bit():
    rng = np.random.default_rng(3)
    xyz, faces, rgb = rng.normal(size=(5, 3)), np.array([[0, 1, 2], [2, 3, 4]]), rng.integers(0, 255, (5, 3)) * 1.0
    data = scenes.scene(1_500_000_000, "thing", [scenes.triangle_list(xyz, faces, rgb)])
    (entity,) = SceneUpdate.FromString(data).entities
    (triangles,) = entity.triangles
    assert (entity.id, entity.frame_id) == ("thing", "world")
    assert (entity.timestamp.seconds, entity.timestamp.nanos) == (1, 5 * 10**8)
    assert np.array_equal([(p.x, p.y, p.z) for p in triangles.points], xyz)
    assert np.array_equal([(c.r, c.g, c.b, c.a) for c in triangles.colors], np.column_stack([rgb / 255, np.ones(5)]))
    assert list(triangles.indices) == faces.ravel().tolist()


def test_nested_messages_are_set_also_at_zero(scenario, synthetic):
    """rerun turns an unset nested message into a null."""
    (entity,) = SceneUpdate.FromString(views.prisms(0, BlockTable.empty(), 3.0)).entities
    assert entity.HasField("timestamp")
    assert entity.HasField("lifetime")
    assert all(item.HasField("pose") and item.HasField("color") for item in entity.triangles)
    cloud = PointCloud.FromString(views.nodes(0, synthetic.sheet(scenario, 0.0), 3.0))
    assert cloud.HasField("timestamp")
    assert cloud.HasField("pose")
    assert cloud.pose.HasField("position")


def window(t_ns, **content):
    """A frame without ice."""
    none = SheetView(np.empty((0, 3)), np.empty(0), np.empty(0), np.empty(0, bool), np.empty(0, bool), (0, 0), (0, 0))
    return Frame(t_ns, none, BlockTable.empty(), **{"load": np.zeros((3, 3)), **content})


def test_load_holds_totals_and_phases(scenario, synthetic):
    info = synthetic.run_info(scenario)
    data = numbers.load(info, window(2_000_000_001, load=np.arange(9.0).reshape(3, 3) + 1))
    message = messages.Load.FromString(data)
    assert (message.stamp.seconds, message.stamp.nanos) == (2, 1)
    assert (message.fx, message.fy, message.fz) == (12.0, 15.0, 18.0)
    assert (message.breaking_fx, message.rotating_fy, message.sliding_fz) == (1.0, 5.0, 9.0)
    assert math.isnan(message.attack_x)  # no force has a place


def test_forces_at_their_places_and_their_moments(scenario, synthetic):
    """Two forces of the sheet, one of them of a hinged piece: their places, their moments, the centre of both."""
    info = synthetic.run_info(
        load_scenario("van_vliet_2018_floe_165m", ['recording.moment_point=["0 m","0 m","-2 m"]'])
    )
    places, forces = np.array([[-15.0, 1.0, 0.5], [-14.0, -3.0, -0.5]]), np.array([[2.0, 0.0, 1.0], [6.0, 0.5, 0.0]])
    touching = ContactForces(np.array([4, 7]), places, -forces, np.array([False, True]))
    frame = window(10**9, contact=touching)
    message = messages.Contact.FromString(pictures.contact(info, frame))
    assert np.allclose(np.array([message.x, message.y, message.z]).T, places, atol=2e-3)
    assert np.allclose(np.array([message.fx, message.fy, message.fz]).T, forces, rtol=3e-4)
    assert (list(message.phase), list(message.block)) == ([0, 1], [-1, -1])
    load = messages.Load.FromString(numbers.load(info, frame))
    arms = np.cross(places - info.scenario.moment_point, forces)
    assert (load.breaking_my, load.rotating_mz) == pytest.approx((arms[0, 1], arms[1, 2]), rel=1e-12)
    assert (load.mx, load.my, load.mz) == pytest.approx(tuple(arms.sum(axis=0)), rel=1e-12)
    size = np.linalg.norm(forces, axis=1)
    assert (load.attack_x, load.attack_y) == pytest.approx(tuple((size @ places)[:2] / size.sum()), rel=1e-12)


def test_an_event_is_data_and_a_line():
    item = Event(10**9, "split", (1.0, 2.0, 3.0), 7, (4.0, 5.0, 6.0), "two parts")
    message = messages.Event.FromString(numbers.event(None, item))
    assert (message.kind, message.fz, message.cells, message.y) == ("split", 3.0, 7, 5.0)
    assert CHANNELS["/log"].schema.FromString(CHANNELS["/log"].take(None, item)).message == "split: two parts"


def test_a_window_without_balances_says_nothing_of_them():
    assert numbers.ledger(None, window(10**9)) is None
    message = messages.Ledger.FromString(numbers.budget(None, window(10**9, budget={"fz_drag": 2.0})))
    assert (list(message.name), list(message.value)) == (["fz_drag"], [2.0])


def test_a_channel_from_outside_is_one_line(monkeypatch, record, tmp_path):
    """It stands in the file beside the others, with its schema, and theirs stay as they are."""

    def overturning(info, frame):
        return numbers.named(frame.t_ns, {"my": 5.0 * frame.load[:, 0].sum()})

    plain = record(tmp_path / "plain.mcap")
    monkeypatch.setitem(CHANNELS, "/load/overturning", Channel(messages.Ledger, When.WINDOW, overturning))
    path = record(tmp_path / "more.mcap")
    found = [(t, *messages.Ledger.FromString(d).value) for _, t, d in stored(path, ["/load/overturning"])]
    run = read_run(path)
    assert found == list(zip(run.t_ns.tolist(), (5.0 * run.component("fx")).tolist(), strict=True))
    assert len(found) == 240
    assert list(stored(path, ["/load/structure", "/ice/sheet"])) == list(
        stored(plain, ["/load/structure", "/ice/sheet"])
    )


@pytest.mark.parametrize(
    ("when", "item"), [(When.START, None), (When.EVENT, Event), (When.PICTURE, Frame), (When.VIEW, Frame)]
)
def test_a_channel_is_asked_when_it_is_due(record, tmp_path, when, item):
    seen = []
    own = {**CHANNELS, "/mine": Channel(messages.Ledger, when, lambda info, *what: seen.append(what))}
    path = record(tmp_path / "run.mcap", channels=own)
    like = {When.START: "/tf", When.EVENT: "/events", When.PICTURE: "/ice/sheet", When.VIEW: "/view/sheet"}[when]
    assert len(seen) == len(list(stored(path, [like])))
    assert all(isinstance(what, item) for (what,) in seen) if item else seen == [()]
    assert not list(stored(path, ["/mine"]))  # it had nothing to say


def test_nodes_that_left_the_lattice_are_not_drawn(scenario, synthetic):
    sheet = synthetic.sheet(scenario, 8.0)
    cloud = PointCloud.FromString(views.nodes(0, sheet, 3.0))
    records = np.frombuffer(cloud.data, scenes.NODE)
    assert len(records) == sheet.present.sum() < len(sheet.present)
    assert np.allclose(records["x"], sheet.position[records["node"], 0], atol=0.5 * 3.0 / views.FINE)
    assert np.allclose(records["damage"], sheet.damage[sheet.present], atol=0.5 / views.FINE)


def closed_volume(points, faces):
    """Volume by the divergence theorem: right only if the surface is closed and its normals point out."""
    a, b, c = (points[faces[:, k]] for k in range(3))
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)


@pytest.mark.parametrize("t", [0.0, 8.0])
def test_the_solid_sheet_is_closed(scenario, synthetic, t):
    sheet, d, h = synthetic.sheet(scenario, t), scenario.sheet.spacing, 3.0
    quads = shapes.upward(shapes.cell_quads(sheet.intact, sheet.cell_shape), sheet.position)
    vertices, faces, node = shapes.solid_sheet(sheet.position, quads, h)
    assert closed_volume(vertices, faces) == pytest.approx(sheet.intact.sum() * d * d * h, rel=1e-9)
    assert len(node) == len(vertices)


def test_prisms_are_closed_and_hold_the_blocks(scenario, synthetic):
    blocks = synthetic.blocks(scenario, 8.0)
    points, faces, owner = shapes.prisms(blocks)
    assert closed_volume(points, faces) == pytest.approx(blocks.count * 7 * 3 * 5.2, rel=1e-9)
    assert np.array_equal(np.bincount(owner), np.full(blocks.count, 12))


def test_outline_points_lie_on_the_blocks_and_are_dense(scenario, synthetic):
    blocks = synthetic.blocks(scenario, 8.0)
    edges, block = shapes.prism_edges(blocks)
    points, edge = shapes.along_edges(shapes.prisms(blocks)[0], edges, 0.6)
    assert np.bincount(block[edge]).min() > 60
    first = points[block[edge] == 0]
    assert np.linalg.norm(first - blocks.position[0], axis=1).max() <= np.hypot(np.hypot(3.5, 1.5), 2.6) * (1 + 1e-9)


def test_no_blocks_and_no_cells_are_pictures_too(scenario, synthetic):
    empty = BlockTable.empty()
    assert len(shapes.prisms(empty)[0]) == 0
    assert views.outline(0, empty, 3.0)
    vertices, faces, _ = shapes.solid_sheet(np.zeros((9, 3)), np.empty((0, 4), np.int64), 3.0)
    assert (len(vertices), len(faces)) == (18, 0)


def test_colours_are_those_of_the_report():
    """From ice over orange to dark red; cracked ice is near to black; phases, structure: the same numbers."""
    from PIL import ImageColor

    from cosim.show.ice import palette

    use = np.linspace(0.0, 1.0, 17)
    assert shapes.ice_colour(0.0 * use, use) == pytest.approx(255.0 * palette.colormap()(use)[:, :3], abs=1.5)
    for phase, colour in palette.BLOCK.items():
        assert ImageColor.getrgb(colour) == shapes.PHASE_RGB[phase]
    assert list(palette.PHASE_COLOURS) == ["breaking", "rotating", "sliding"]
    assert ImageColor.getrgb(palette.STRUCTURE) == shapes.STRUCTURE_RGB
    low, cracked = shapes.ice_colour(np.array([0.0, 1.0]), np.array([0.0, 0.0]))
    assert cracked.sum() < low.sum() / 3
