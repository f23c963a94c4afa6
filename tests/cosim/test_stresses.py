"""Stresses of the cells in the plane of Mohr's circle: the lines of the criteria, what a run records, the figure."""

import io
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image, ImageColor

from cosim.recording.reader import messages, recorded_pictures, recorded_stresses
from cosim.recording.stresses import BEGAN, WORST, gathered, packed, unpacked
from cosim.recording.writer import Recorder
from cosim.scenario.loading import load_scenario
from cosim.show.mohr import BEGAN as DARK
from cosim.show.mohr import beside_tips, caption, draw_mohr, extent, mohr_picture
from cosim.simulation import run_scenario
from cosim.strained import Watching, line_of
from cosim.stresses import Stresses
from lattice.criteria.judge import Judge
from lattice.criteria.table import CRITERIA
from lattice.grid import Grid
from lattice.ice import BeamTest, Ice

ICE = Ice(
    **{"E": 5e9, "nu": 0.3, "h": 1.2, "rho_i": 900.0, "rho_w": 1025.0},
    **{"sigma_t": 0.5e6, "sigma_f": 0.8e6, "sigma_c": 3e6, "sigma_spall": -20e6, "sigma_shear": 0.7e6, "K_IC": 1e5},
    **{"sigma_f_upward": 0.6e6, "sigma_f_downward": 0.9e6, "beam_test": BeamTest(5.0, 3.0, 1e5, 0.8)},
)
GRID = Grid.rectangle(20.0, 16.0, 11, 9, 0.0, 0.0)


def some_state(seed=1):
    """Displacements of all nodes: strains of 1e-4 and curvatures that stretch a face as much, in every direction."""
    rng = np.random.default_rng(seed)
    return 2e-4 * rng.normal(size=(GRID.nodes, 2)), 2e-4 * rng.normal(size=(GRID.nodes, 3))


def watched(*names):
    judge = Judge(GRID, ICE, tuple(CRITERIA[name] for name in names))
    live = np.ones(GRID.cells, bool)
    live[[33, 34, 35]] = False  # a crack, with its tips
    return Watching.of(judge), judge.standing(live)


@pytest.mark.parametrize("name", [name for name in CRITERIA if name != "out-of-plane-shear"])
def test_every_criterion_on_a_circle_is_a_line(name):
    """The utilisation that the line gives is that of the law, for all cells of a wild state; a wrong line is not."""
    judge, standing = watched(name)
    (u, q), cells = some_state(), np.flatnonzero(standing.live)
    if CRITERIA[name].at_tips:
        cells = np.flatnonzero(standing.live & standing.beside)
    found = judge.stresses(u, q, standing, cells)
    known = judge.utilisation(u, q, standing)[cells]
    assert found.cell.tolist() == cells.tolist()
    assert found.utilisation == pytest.approx(known, rel=1e-12)
    line = judge.lines[name]
    wrong = replace(found, lines={name: replace(line, along_mean=line.along_mean + 0.1)})
    assert np.abs(wrong.utilisation - known).max() > 1e-3


def test_the_stress_is_that_of_the_plate():
    """Uniaxial tension of 0.4 MPa is the point (0.2, 0.2) MPa, pure bending to 0.4 MPa at a face likewise."""
    judge, standing = watched("principal-stress")
    x, y = GRID.xy.T
    pulled = np.column_stack((0.4e6 / ICE.E * x, -ICE.nu * 0.4e6 / ICE.E * y))
    still = np.zeros((GRID.nodes, 3))
    cells = np.arange(5)
    found = judge.stresses(pulled, still, standing, cells)
    assert found.mean == pytest.approx(0.2e6, rel=1e-9)
    assert found.radius == pytest.approx(0.2e6, rel=1e-9)
    bent = still.copy()
    bent[:, 1], bent[:, 2] = 0.4e6 / ICE.E / (0.5 * ICE.h) * x, -ICE.nu * 0.4e6 / ICE.E / (0.5 * ICE.h) * y
    found = judge.stresses(np.zeros((GRID.nodes, 2)), bent, standing, cells)
    scaled = 0.2e6 * ICE.sigma_t / ICE.sigma_f  # (4.17)-(4.20)
    assert found.mean == pytest.approx(scaled, rel=1e-9)
    assert found.radius == pytest.approx(scaled, rel=1e-9)


def test_of_several_criteria_the_worst_counts_and_shear_has_no_place():
    judge, standing = watched("combined-tension", "combined-compression", "out-of-plane-shear")
    (u, q), cells = some_state(2), np.flatnonzero(standing.live)
    found = judge.stresses(u, q, standing, cells)
    worst = judge.causes(u, q, standing, cells)
    names = [list(judge.lines)[k] for k in found.criterion]
    assert set(worst) >= {"combined-tension", "out-of-plane-shear"}
    kept = [(c, w) for c, w in zip(cells.tolist(), worst, strict=True) if w != "out-of-plane-shear"]
    assert sorted(zip(found.cell.tolist(), names, strict=True)) == sorted(kept)
    assert line_of("out-of-plane-shear", ICE, 2.0) is None
    none, standing = watched("out-of-plane-shear")
    assert len(none.stresses(u, q, standing, cells).cell) == 0


def test_messages_are_read_back():
    judge, standing = watched("combined-tension", "combined-compression")
    u, q = some_state()
    found = judge.stresses(u, q, standing, np.arange(20))
    back = unpacked(packed(10**9, found))
    assert back.lines == found.lines
    assert back.cell.tolist() == found.cell.tolist()
    assert back.utilisation == pytest.approx(found.utilisation, rel=2.0**-10)
    assert packed(0, Stresses.none(judge.lines)) is None
    both = gathered([back, back])
    assert len(both.cell) == 40
    with pytest.raises(ValueError, match="different criteria"):
        gathered([back, replace(back, lines={})])
    with pytest.raises(ValueError, match="fit together"):
        unpacked(packed(0, replace(found, criterion=found.criterion + 2)))


@pytest.fixture(scope="module", params=["open", "closing"])
def recording(request, tmp_path_factory):
    """A real run until cells fail, on the implicit and on the explicit engine."""
    path = tmp_path_factory.mktemp("run") / f"{request.param}.mcap"
    own = ["sheet.nodes=[17, 13]", "scenario.duration='1.2 s'", f"fracture.cracks='{request.param}'"]
    with Recorder(path) as recorder:
        run_scenario(load_scenario("first_cone", own), [recorder])
    return path


def test_a_run_records_where_its_cells_began_to_crack(recording):
    """The first cell stands on its line; intact cells below it; each cell begins once, and as the pictures say."""
    began, worst = recorded_stresses(recording)
    first = unpacked(next(data for _, _, data in messages(recording, [BEGAN])))
    assert np.abs(first.utilisation - 1.0).min() < 2e-3
    assert began.utilisation.min() > 0.9
    assert worst.utilisation.max() < 1.0 + 2e-3
    assert len(set(began.cell.tolist())) == len(began.cell)
    last = list(recorded_pictures(recording))[-1]
    assert set(began.cell.tolist()) <= set(np.flatnonzero(~last.elastic).tolist())
    if "closing" in recording.name:
        assert last.begun.any()
        assert set(np.flatnonzero(last.begun).tolist()) <= set(began.cell.tolist())
    else:
        assert not last.begun.any()


def test_the_most_used_cells_are_those_of_the_pictures(recording):
    pictures = {p.t_ns: p for p in recorded_pictures(recording)}
    seen = [(t, unpacked(data)) for _, t, data in messages(recording, [WORST])]
    assert len(seen) > 2
    for t, found in seen:
        use = pictures[t].sheet.utilisation
        assert found.utilisation.max() == pytest.approx(use[pictures[t].sheet.present].max(), abs=0.01)


def test_the_figure_has_its_points_where_the_stresses_are(recording):
    began, worst = recorded_stresses(recording)
    inside = np.abs(began.utilisation - 1.0) < 0.02
    figure = Figure(figsize=(8, 5), dpi=100)
    draw_mohr(figure, began, worst)
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=100)
    image = np.asarray(Image.open(buffer).convert("RGB"), int)
    (ax,) = figure.axes
    low, high, top = extent([worst, began], min(line.strength for line in began.lines.values()))
    seen = 0
    for s, t in zip(began.mean[inside & ~beside_tips(began)], began.radius[inside & ~beside_tips(began)], strict=True):
        if not (low < s < high and t < 0.97 * top):
            continue
        column, row = ax.transData.transform((s / 1e3, t / 1e3))
        patch = image[image.shape[0] - int(row) - 3 : image.shape[0] - int(row) + 3, int(column) - 3 : int(column) + 3]
        seen += (np.abs(patch - np.array(ImageColor.getrgb(DARK))).max(axis=2) < 60).any()
    assert seen >= 1
    assert ax.get_xlabel().endswith("[kPa]")
    label = figure.legends[0].get_texts()[-1].get_text()
    assert ("(4.6)" in label) if "open" in recording.name else ("principal" in label)


def test_a_caption_explains_the_figure(recording):
    began, worst = recorded_stresses(recording)
    near = int((np.abs(began.utilisation - 1.0) <= 0.02).sum())
    assert f"{len(began.cell)} cells" in caption(began)
    assert f"{near} were found" in caption(began)
    assert "No cell" in caption(None)
    shown = mohr_picture(began, worst)
    assert shown["source"].startswith("data:image/svg+xml;base64,")
    assert mohr_picture(None, None) is None
    assert shown == mohr_picture(began, worst)  # the same bytes
