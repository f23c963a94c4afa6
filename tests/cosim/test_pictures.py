"""Pictures packed and unpacked: what a recorded frame shows comes back, to what is said of it."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cosim.recording import pictures, planes
from cosim.recording.reader import recorded_pictures, recorded_structure
from cosim.scenario.loading import load_scenario
from cosim.show import pictures as shown
from coupling.interface import BlockTable, Phase

whole = st.lists(st.integers(-(2**30) + 1, 2**30 - 1), max_size=60)


@given(whole)
def test_whole_numbers_come_back(values):
    assert planes.unpack(planes.pack(values)).tolist() == values


@given(st.lists(st.booleans(), max_size=40))
def test_bits_come_back(values):
    bits = np.array(values, bool)
    assert planes.unpack_bits(planes.pack_bits(bits), len(bits)).tolist() == values


def test_what_cannot_be_kept_is_refused():
    with pytest.raises(ValueError, match="too large"):
        planes.pack([2**30])
    with pytest.raises(ValueError, match="no numbers"):
        planes.unpack(b"12345")
    with pytest.raises(ValueError, match="where 9"):
        planes.unpack_bits(b"1", 9)


def test_rounded_numbers_keep_their_digits():
    values = np.array([0.0, -1.0, np.pi * 1e6, 3.3e-7])
    assert planes.rounded(values) == pytest.approx(values, rel=2.0**-12)
    assert planes.rounded(values)[:2].tolist() == [0.0, -1.0]


@pytest.fixture(scope="module")
def scenario():
    return load_scenario("van_vliet_2018_floe_165m", ["sheet.nodes=[40,40]"])


@pytest.fixture(scope="module")
def pair(scenario, synthetic):
    """A frame and the picture that comes back of it."""
    info = synthetic.run_info(scenario)
    (frame,) = (f for f in synthetic.frames(scenario) if f.t_ns == 9 * 10**9)
    parts = ((pictures.SHEET, pictures.sheet), (pictures.BLOCKS, pictures.blocks), (pictures.CONTACT, pictures.contact))
    (back,) = pictures.pictures([(topic, frame.t_ns, take(info, frame)) for topic, take in parts])
    return frame, back


def test_the_sheet_comes_back(pair):
    frame, back = pair
    half, here = 0.5 * pictures.quantum_of(3.0) * (1 + 1e-9), frame.sheet.present
    assert np.array_equal(back.sheet.present, here)
    assert np.array_equal(back.sheet.intact, frame.sheet.intact)
    assert (back.sheet.shape, back.sheet.cell_shape) == (frame.sheet.shape, frame.sheet.cell_shape)
    assert np.abs(back.sheet.position - frame.sheet.position)[here].max() <= half
    assert np.abs(back.sheet.damage - frame.sheet.damage)[here].max() <= 0.5 / 128
    assert np.abs(back.sheet.utilisation - frame.sheet.utilisation)[here].max() <= 0.5 / 128


def test_the_blocks_come_back(pair):
    frame, back = pair
    half = 0.5 * pictures.quantum_of(3.0) * (1 + 1e-9)
    for name in ("id", "section", "phase", "offset"):
        assert np.array_equal(getattr(back.blocks, name), getattr(frame.blocks, name)), name
    assert np.abs(back.blocks.position - frame.blocks.position).max() <= half
    assert np.abs(back.blocks.width - frame.blocks.width).max() <= half
    assert np.abs(back.blocks.outline - frame.blocks.outline).max() <= 2 * half


def test_a_sheet_that_has_gone_and_no_blocks_are_pictures_too(scenario, synthetic, pair):
    from dataclasses import replace

    info, (frame, _) = synthetic.run_info(scenario), pair
    gone = replace(frame.sheet, present=np.zeros_like(frame.sheet.present), intact=np.zeros_like(frame.sheet.intact))
    empty = replace(frame, sheet=gone, blocks=BlockTable.empty())
    parts = ((pictures.SHEET, pictures.sheet), (pictures.BLOCKS, pictures.blocks), (pictures.CONTACT, pictures.contact))
    (back,) = pictures.pictures([(topic, 0, take(info, empty)) for topic, take in parts])
    assert (back.sheet.present.sum(), back.blocks.count, len(back.forces.force)) == (0, 0, 0)
    assert [len(mesh.faces) for mesh in shown.meshes(back, 3.0)] == [0, 0, 0]


def test_a_picture_that_is_not_whole_is_refused(scenario, synthetic, pair):
    info, (frame, _) = synthetic.run_info(scenario), pair
    with pytest.raises(ValueError, match="not whole"):
        list(pictures.pictures([(pictures.CONTACT, 10**9, pictures.contact(info, frame))]))


def test_pictures_of_a_recording(run_file, synthetic):
    found = list(recorded_pictures(run_file))
    assert [p.t_ns for p in found] == [5 * 10**7, *(k * 5 * 10**8 for k in range(1, 25))]
    points, faces = recorded_structure(run_file)
    assert np.array_equal(points, synthetic.cone()[0])
    assert np.array_equal(faces, synthetic.cone()[1])
    names = {mesh.name: mesh for mesh in shown.meshes(found[-1], 3.0)}
    assert list(names) == ["sheet", "rubble/rotating", "rubble/sliding"]
    assert len(names["rubble/sliding"].faces) == 12 * (found[-1].blocks.phase == Phase.SLIDING).sum()
