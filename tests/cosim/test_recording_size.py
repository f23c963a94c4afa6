"""What a recording takes: once for a run, and for every simulated second."""

import dataclasses

import numpy as np
import pytest
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate

from cosim.recording import shapes, views, writer
from cosim.recording.reader import messages
from cosim.recording.writer import Recorder, view_every_ns
from cosim.scenario.loading import load_scenario
from cosim.simulation import run_scenario

CASE = "basin_2010_floe_165m"
TENTHS = ("recording.every='0.1 s'",)
PER_SECOND, ONCE = 0.2e6, 0.2e6  #: bytes, of this case at 10 frames per second


class Sizes:
    """Sizes of files after each window; what is written of the last quarter of a second is not in the file yet."""

    def __init__(self, *paths):
        self.paths, self.t, self.sizes = paths, [], []

    def on_start(self, run_info):
        self.sizes.append([path.stat().st_size for path in self.paths])
        self.t.append(0.0)

    def on_frame(self, frame):
        self.sizes.append([path.stat().st_size for path in self.paths])
        self.t.append(frame.t_ns / 1e9)

    def on_close(self):
        pass


@pytest.mark.slow
def test_the_165_m_case_takes_less_than_a_fifth_of_a_megabyte_per_second(tmp_path, monkeypatch):
    """Grows by so much, and less once; with a picture for stock viewers in every frame it would take three times it."""
    plain, twin = tmp_path / "run.mcap", tmp_path / "twin.mcap"

    class Often(Recorder):
        def _with_view(self, frame):
            return True

    sizes = Sizes(plain, twin)
    with Recorder(plain) as recorder, Often(twin) as often:
        run_scenario(load_scenario(CASE, [*TENTHS, "scenario.duration='3.4 s'"]), [recorder, often, sizes])
    t, size = np.array(sizes.t), np.array(sizes.sizes, float)
    late = t >= 0.05  # behind the first frame; three pictures for stock viewers follow, in 3.35 s
    growth = (size[-1] - size[late][0]) / (t[-1] - t[late][0])
    tail = [path.stat().st_size for path in (plain, twin)] - size[-1]  # the summary: some of it for each window
    index = 130.0 * (len(t) - 1)
    once = size[late][0] + tail - index
    growth += index / t[-1]
    print(f"once {once[0]:.0f} bytes, then {growth[0]:.0f} per second; twin {growth[1]:.0f}")
    assert once[0] < ONCE
    assert growth[0] < PER_SECOND < growth[1] / 2.5


def test_pictures_for_stock_viewers_are_no_closer_than_ice_moves(synthetic):
    """1.1 s of ice of 3 m; in a long run sixty; a model and its prototype have the same number of them."""
    info = synthetic.run_info(load_scenario(CASE, ["scenario.duration='6 s'"]))
    assert view_every_ns(info) == pytest.approx(2.0 * (3.0 / 9.81) ** 0.5 * 1e9, rel=1e-6)
    assert view_every_ns(dataclasses.replace(info, duration_ns=300 * 10**9)) == 5 * 10**9


def test_they_stand_at_the_start_at_the_end_and_between(record, tmp_path, monkeypatch):
    path = record(tmp_path / "r.mcap", ("scenario.duration='5 s'", "sheet.nodes=[16,16]", *TENTHS))
    times = [t / 1e9 for _, t, _ in messages(path, ["/view/sheet"])]
    assert times == pytest.approx([0.05, 1.2, 2.4, 3.6, 4.8, 5.0])
    monkeypatch.setattr(writer, "VIEW_TIMES", 0.0)
    often = record(tmp_path / "often.mcap", ("scenario.duration='5 s'", "sheet.nodes=[16,16]", *TENTHS))
    assert len(list(messages(often, ["/view/sheet"]))) == 50  # a sixtieth of the run is 83 ms
    assert list(messages(path, ["/ice/sheet"])) == list(messages(often, ["/ice/sheet"]))


@pytest.mark.parametrize("t", [0.0, 8.0])
def test_a_sheet_in_bands_is_the_same_solid(synthetic, t):
    """Every triangle once, with its corners and colours, as in one list."""
    scenario = load_scenario(CASE, ["sheet.nodes=[16,16]"])
    sheet, h = synthetic.sheet(scenario, t), 3.0
    lists = SceneUpdate.FromString(views.sheet_solid(0, sheet, h)).entities[0].triangles
    assert len(lists) == 4
    found = []
    for part in lists:
        rows = np.array([(p.x, p.y, p.z, c.r, c.g, c.b) for p, c in zip(part.points, part.colors, strict=True)])
        found += [
            tuple(np.round(rows[list(part.indices[k : k + 3])].ravel(), 9)) for k in range(0, len(part.indices), 3)
        ]
    quads = shapes.upward(shapes.cell_quads(sheet.intact, sheet.cell_shape), sheet.position)
    points, faces, node = shapes.solid_sheet(sheet.position, quads, h)
    rgb = views.shaded(shapes.ice_colour(sheet.damage, sheet.utilisation)[node]) / 255
    rows = np.hstack([views.coarse(points, h), rgb])
    assert sorted(found) == sorted(tuple(np.round(row.ravel(), 9)) for row in rows[faces])
