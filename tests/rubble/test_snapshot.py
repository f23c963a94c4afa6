"""A snapshot goes on with the bits of the run that it was taken from."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from rubble.layer import RubbleLayer
from rubble.sheet import SheetMotion
from rubble.snapshot import checkpoint, restore, save


def test_a_run_goes_on_from_its_checkpoint_with_the_same_bits(scene):
    live, saved = checkpoint(scene.drive(scene.filled(), 40))
    scene.drive(live, 40)
    again = scene.drive(restore(saved, live), 40)
    assert live.load_on_structure.any()
    assert scene.picture(live) == scene.picture(again)
    assert live.time == again.time
    assert live.cleared == again.cleared


def test_a_crowded_section_has_room_for_its_pairs_at_once_and_from_a_checkpoint(scene):
    """Rows of blocks that stand in each other: 500 pairs in the first sub-step, 256 fit into a list at first."""
    layer = RubbleLayer(scene.PHYSICS, scene.WIDTH)
    for i in range(300):
        scene.add(layer, 0, -20.0 - 4.9 * (i % 20), -4.0 - 2.95 * (i // 20), velocity=(0.0, 0.0), alone=False)
    layer.advance(1)
    assert layer.section(0).pairs.count > 500
    live, saved = checkpoint(layer)
    live.advance(2)
    again = restore(saved, live)
    again.advance(2)
    assert scene.picture(live) == scene.picture(again)


def test_loading_disturbs_nothing(scene):
    """Contacts keep their history: a settled pile goes on as if nothing had happened."""
    layer = RubbleLayer(scene.PHYSICS, scene.WIDTH, solids=scene.cone_cut)
    x = np.arange(-10.0, -50.0, -2.8)
    for i in range(8):
        scene.add(layer, 0, -20.0 - 5.5 * (i % 4), -3.2 - 3.2 * (i // 4), velocity=(0.0, 0.0))
    for _ in range(400):
        layer.set_sheet(0, SheetMotion(x, 0 * x, x[0] + 1.4, np.zeros((len(x), 2)), 3.0))
        layer.advance(10)
    layer.advance(200)  # no hand-over of the sheet between the windows that are compared
    layer.advance(10)
    copy, _ = checkpoint(layer)
    before = layer.sheet_forces(0).sum(axis=0)
    layer.advance(10)
    copy.advance(10)
    assert copy.sheet_forces(0).sum(axis=0) == pytest.approx(before, rel=1e-4, abs=1.0)
    assert copy.table().velocity == pytest.approx(layer.table().velocity, abs=1e-8)


def test_a_wrong_copy_is_noticed(scene):
    live, saved = checkpoint(scene.drive(scene.filled(), 20))
    other = restore(saved, live)
    other.block(0).velocity[1] += 1e-9
    assert scene.picture(scene.drive(live, 20)) != scene.picture(scene.drive(other, 20))


@pytest.mark.slow
def test_another_process_has_the_same_bits(scene, tmp_path):
    live, saved = checkpoint(scene.drive(scene.filled(), 20))
    (tmp_path / "saved").write_bytes(saved)
    script = (
        "import sys; sys.path.insert(0, sys.argv[2]); from pathlib import Path; from cone_scene import *; "
        "from rubble.snapshot import restore; import hashlib; "
        "layer = drive(restore(Path(sys.argv[1]).read_bytes(), filled()), 20); "
        "print(hashlib.sha256(picture(layer)).hexdigest())"
    )
    run = [sys.executable, "-c", script, str(tmp_path / "saved"), str(Path(__file__).parent)]
    here = [subprocess.run(run, capture_output=True, text=True, check=True).stdout for _ in range(2)]
    assert here[0] == here[1]
    assert len(here[0]) > 60
    assert len(save(live)) > 1000
