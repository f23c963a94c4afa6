"""Plan and section: ice, water, structure, blocks and cracks are where they are, by colour and place."""

import dataclasses
import io

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image, ImageColor

from cosim.recording.reader import read_run, recorded_pictures, recorded_structure
from cosim.recording.writer import Recorder
from cosim.scenario.loading import load_scenario
from cosim.show.ice import plan, section
from cosim.show.ice.figures import along_waterline, draw_waterline
from cosim.show.ice.history import Failures, busiest, looks
from cosim.show.ice.palette import BLOCK, STRUCTURE, WATER
from cosim.show.ice.scene import scene_of
from cosim.show.view3d import View
from cosim.simulation import run_scenario
from coupling.interface import Phase


@pytest.fixture(scope="module")
def run(run_file):
    return read_run(run_file)


@pytest.fixture(scope="module")
def pictures(run_file):
    return list(recorded_pictures(run_file))


@pytest.fixture(scope="module")
def seen(run, pictures):
    return {title: look for look in looks(run, pictures) for title in look.title.split(", and ")}


def drawn(draw):
    """Pixels of what ``draw(ax)`` draws, and from places to pixels."""
    figure = Figure(figsize=(8, 6), dpi=80)
    ax = figure.add_axes((0, 0, 1, 1))
    draw(ax)
    ax.set_aspect("auto")
    ax.set_position((0, 0, 1, 1))
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png")
    image = np.asarray(Image.open(buffer).convert("RGB"), int)
    return image, ax


def share(image, ax, colour, x, y, reach=12):
    """Share of a patch around a place that has a colour."""
    column, row = ax.transData.transform((x, y))
    row = image.shape[0] - row
    patch = image[int(row) - 4 : int(row) + 5, int(column) - 4 : int(column) + 5]
    return (np.abs(patch - np.array(ImageColor.getrgb(colour))).max(axis=2) < reach).mean()


def below_the_structure(image, ax, look):
    """Pixels inside of the structure that have the colour of a sliding block's outline."""
    row, column = np.nonzero(np.abs(image - np.array(ImageColor.getrgb(BLOCK[Phase.SLIDING]))).max(axis=2) < 30)
    place = ax.transData.inverted().transform(np.column_stack((column, image.shape[0] - row)))
    return int((np.hypot(*place.T) < 14.0).sum())


def test_the_looks_are_the_peaks_of_the_phases(run, seen):
    assert {"most load by breaking", "most load by rotating", "most load by sliding", "peak of the load"} <= set(seen)
    for title, look in seen.items():
        if title.startswith("most"):
            peak = run.t_ns[np.abs(run.lasting.component("f", title.split()[-1])).argmax()]
            assert 0 <= peak - look.picture.t_ns <= 5 * 10**8, title


def test_the_plan_has_ice_water_structure_and_blocks_in_their_places(run, seen):
    scene, look = scene_of(run), seen["most load by sliding"]
    image, ax = drawn(lambda ax: plan.draw_plan(ax, scene, look))
    assert share(image, ax, STRUCTURE, 0.0, 10.0) > 0.9
    assert below_the_structure(image, ax, look) > 50  # outlines of blocks that it hides
    assert share(image, ax, WATER, 10.0, 25.0) > 0.9
    sheet, frame = look.picture.sheet, plan.extent(scene, look.picture, False)
    x, y = sheet.position[:, 0], sheet.position[:, 1]
    inside = np.flatnonzero(sheet.present & (x < frame[0] + 8) & (x > frame[0] + 2) & (np.abs(y - 20) < 5))
    assert share(image, ax, WATER, x[inside[0]], y[inside[0]]) < 0.1
    blocks = look.picture.blocks
    for phase in (Phase.ROTATING, Phase.SLIDING):
        assert (np.abs(image - np.array(ImageColor.getrgb(BLOCK[phase]))).max(axis=2) < 60).sum() > 200, phase
    assert blocks.count == 18


def test_the_section_has_sheet_blocks_structure_and_water(run, seen):
    scene, look = scene_of(run), seen["most load by sliding"]
    key = int(look.picture.blocks.section[8])
    y = scene.centre(key)
    image, ax = drawn(lambda ax: section.draw_section(ax, scene, look.picture, y))
    cut = scene.cut(y)
    assert share(image, ax, STRUCTURE, float(cut[:, 0].mean()), 1.0) > 0.9
    frame = section.extent(scene, y)
    assert share(image, ax, WATER, frame[0] + 2.0, frame[2] + 1.0) > 0.9
    for k in np.flatnonzero(look.picture.blocks.section == key):
        x, _, z = look.picture.blocks.position[k]
        if frame[0] < x < frame[1] and frame[2] < z < frame[3]:
            assert share(image, ax, BLOCK[Phase(look.picture.blocks.phase[k])], x, z, 30) > 0.3
    parts = section.sheet_parts(look.picture.sheet, y, 3.0)
    for corners in parts:
        assert corners[3, 1] - corners[0, 1] == pytest.approx(3.0)


def test_failed_cells_keep_the_time_of_their_failure(pictures):
    failures = Failures()
    for picture in pictures:
        failures.see(picture)
    late = pictures[-1]
    assert np.array_equal(np.isnan(failures.time), late.sheet.intact)
    first = next(p for p in pictures if not p.sheet.intact.all())
    assert np.nanmin(failures.time) == first.t_ns / 1e9


def test_the_load_along_the_waterline_is_all_of_it(run, pictures):
    """The synthetic run has no places; forces that are put there add up to what is drawn, slice by slice."""
    from dataclasses import replace

    from coupling.attack import PointForces

    scene, rng = scene_of(run), np.random.default_rng(2)
    force = np.abs(rng.normal(size=(40, 3))) * [1.0, 0.0, 0.0]
    place = np.column_stack((np.full(40, -15.0), rng.uniform(-14, 14, 40), np.zeros(40)))
    loaded = [replace(p, forces=PointForces(place, force, np.zeros(40, int), np.full(40, -1))) for p in pictures[:3]]
    edges, t, load = along_waterline(scene, loaded)
    assert load.shape == (3, len(edges) - 1)
    assert (load * np.diff(edges)).sum(axis=1) == pytest.approx(force[:, 0].sum(), rel=1e-12)
    assert t.tolist() == [p.t_ns / 1e9 for p in pictures[:3]]
    assert edges[0] < place[:, 1].min()
    assert edges[-1] > place[:, 1].max()
    assert busiest(loaded[0]) == place[force[:, 0].argmax(), 1]
    figure = Figure()
    draw_waterline(figure, scene, loaded)
    assert len(figure.axes) == 3
    assert along_waterline(scene, pictures[:1])[2].shape == (0, 0)


def test_structures_of_every_kind_have_cut_waterline_and_tower(run):
    from dataclasses import replace

    from cosim.scenario.loading import load_scenario

    for name in ("first_cone", "upward_plane", "icefloe_gla_upward_cone"):
        scenario = load_scenario(name)
        scene = scene_of(replace(run, texts={"scenario.toml": scenario.resolved_toml()}))
        assert len(scene.cut(0.0)) >= 4, name
        assert len(scene.waterline()) >= 2
        assert (scene.tower() is None) == (name == "upward_plane")


def test_ice_on_a_slope_that_looks_up_is_not_drawn_as_hidden(run, seen):
    """Blocks lie on it; below a cone that looks down they are outlined."""
    from dataclasses import replace

    from matplotlib.figure import Figure

    from cosim.scenario.loading import load_scenario

    for name, hidden in (("first_cone", 1), ("icefloe_gla_upward_cone", 0), ("upward_plane", 0)):
        texts = {"scenario.toml": load_scenario(name).resolved_toml()}
        ax = Figure().add_subplot()
        plan.draw_plan(ax, scene_of(replace(run, texts=texts)), seen["most load by sliding"])
        outlined = [c for c in ax.collections if c.get_linestyle()[0][1] is not None and c.get_zorder() < 7]
        assert len(outlined) == hidden, name


def test_cracks_do_not_shine_through_what_lies_in_front(run, run_file, pictures):
    """A sheet that is cracked throughout covers no more of a plate above it than one that is whole."""
    last = pictures[-1]
    sheet = dataclasses.replace(last.sheet, damage=np.ones_like(last.sheet.damage))
    thickness, view = scene_of(run).thickness, View(scene_of(run), recorded_structure(run_file), (450, 450))
    up = dataclasses.replace(last.blocks, outline=last.blocks.outline + thickness * np.array([-2.0, 1.2]))
    seen = []
    try:
        for whole in (True, False):
            elastic = np.full(len(sheet.intact), whole)
            image = view.draw(dataclasses.replace(last, sheet=sheet, blocks=up, elastic=elastic)).astype(int)
            colours = [np.array(ImageColor.getrgb(BLOCK[phase])) for phase in (Phase.ROTATING, Phase.SLIDING)]
            dark = image.sum(axis=2) < 160
            hue = [np.abs(image / image.sum(axis=2, keepdims=True) - c / c.sum()).max(axis=2) < 0.1 for c in colours]
            seen.append(((hue[0] | hue[1]) & ~dark, dark))
    finally:
        view.close()
    (blocks, _), (still, dark) = seen
    assert dark.mean() > 0.1  # cracks are seen
    assert blocks.sum() > 500
    assert (still & blocks).sum() > 0.98 * blocks.sum()


def test_a_structure_that_moves_is_drawn_where_it_is(tmp_path):
    """A cone on a carriage, 1 m from where it was built: the ice presses where its outline is drawn."""
    moves = ["drift.velocity='0 m/s'", "water.current=['0 m/s', '0 m/s']", "scenario.duration='2 s'"]
    moves += ["structure.motion.kind='prescribed'", "structure.motion.velocity=['-0.5 m/s', '0 m/s', '0 m/s']"]
    path = tmp_path / "moves.mcap"
    with Recorder(path) as recorder:
        run_scenario(load_scenario("first_cone", moves), [recorder])
    run, last = read_run(path), list(recorded_pictures(path))[-1]
    rests = scene_of(run)
    there = rests.at(run, last.t_ns)
    assert there.place == pytest.approx((-1.0, 0, 0, 0, 0, 0))
    x, y, z = last.forces.position.T
    assert len(x)
    for scene, off in ((there, 0.0), (rests, 1.0)):
        cuts = [scene.cut(float(at)) for at in y]
        away = [np.hypot(*(cut - (a, c)).T).min() for cut, a, c in zip(cuts, x, z, strict=True)]
        assert np.median(away) == pytest.approx(0.75 * off, abs=0.3)
    assert there.waterline().min(axis=0) == pytest.approx(rests.waterline().min(axis=0) - (1.0, 0.0))
    assert plan.extent(there, last, False)[0] == pytest.approx(plan.extent(rests, last, False)[0] - 1.0)
    assert section.extent(there, 0.0)[0] == pytest.approx(section.extent(rests, 0.0)[0] - 1.0)
    view = View(rests, recorded_structure(path), (200, 200))
    try:
        images = [view.draw(last, place).astype(int) for place in (rests.place, there.place)]
    finally:
        view.close()
    assert (np.abs(images[0] - images[1]).max(axis=2) > 30).mean() > 0.02


def test_a_structure_that_pitches_is_cut_turned(run):
    """By a right angle about the waterline point: what was below is ahead."""
    rests = scene_of(run)
    turned = dataclasses.replace(rests, place=(0.0, 0.0, 0.0, 0.0, 0.5 * np.pi, 0.0))
    x, z = rests.cut(0.0).T
    assert turned.cut(0.0) == pytest.approx(np.column_stack((z, -x)))
