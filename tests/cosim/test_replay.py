"""Replay: a rerun file, and a picture without a screen in which ice, structure, blocks and curves are seen."""

import io
import subprocess
from pathlib import Path

import numpy as np
import pytest

from cosim.errors import FailedError, InputError
from cosim.recording import shapes
from cosim.show import replay, viewer
from coupling.interface import Phase


def test_a_rerun_file_is_valid(run_file, tmp_path):
    import rerun_cli

    out = tmp_path / "run.rrd"
    replay.save(run_file, out)
    binary = Path(rerun_cli.__file__).with_name("rerun")
    done = subprocess.run([binary, "rrd", "verify", out], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr


def test_a_recording_opens_in_rerun_without_us(run_file):
    """Nested messages all set, schemas known: the stock decoders find nothing to complain about."""
    import rerun_cli

    binary = Path(rerun_cli.__file__).with_name("rerun")
    done = subprocess.run([binary, "mcap", "check", run_file], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stdout + done.stderr


def test_a_time_outside_of_the_run_is_refused(run_file, tmp_path):
    with pytest.raises(InputError, match="0 to 12 s"):
        replay.screenshot(run_file, tmp_path / "x.png", at=99.0)


def near(image, rgb, reach=40):
    """Number of pixels of about this colour."""
    return int((np.abs(image - np.array(rgb)).max(axis=2) < reach).sum())


def photograph(run_file, out):
    """What the views complain about; skipped where no driver is installed."""
    try:
        return replay.screenshot(run_file, out, at=10.0, size=(1400, 900), fade=1.0)
    except FailedError as error:
        if "Vulkan" in str(error):
            pytest.skip(str(error))
        raise


def test_picture_without_a_screen(run_file, tmp_path):
    from PIL import Image

    out = tmp_path / "x.png"
    reports = photograph(run_file, out)
    assert reports == []
    image = np.asarray(Image.open(io.BytesIO(out.read_bytes())).convert("RGB"), int)
    left = image[:, : image.shape[1] * 6 // 10]
    assert near(left, (215, 232, 245)) > 20_000  # ice
    assert near(left, shapes.STRUCTURE_RGB) > 1_500
    assert near(left, shapes.PHASE_RGB[Phase.ROTATING], 60) > 500
    assert near(left, shapes.PHASE_RGB[Phase.SLIDING], 70) > 500
    right = image[image.shape[0] // 2 :, image.shape[1] * 6 // 10 :]  # Fz and events: no notices there
    assert near(right, replay.TOTAL_RGB, 30) > 500
    assert near(right, shapes.PHASE_RGB[Phase.BREAKING]) > 100


def test_without_a_driver_the_remedy_is_named(monkeypatch, cosim, run_file, tmp_path):
    """The viewer answers, and ends when it is to draw; what is asked next is a broken connection."""
    for name in ("VK_DRIVER_FILES", "VK_ICD_FILENAMES"):
        monkeypatch.setenv(name, "/nonexistent")
    code, out, err = cosim("replay", run_file, "--screenshot", tmp_path / "x.png")
    assert (code, out) == (1, "")
    assert err.startswith("cosim: the viewer ended by itself (exit code")
    assert "apt-get install mesa-vulkan-drivers" in err
    assert err.count("\n") == 1
    assert not (tmp_path / "x.png").exists()
    with pytest.raises(pytest.skip.Exception, match="Vulkan"):
        photograph(run_file, tmp_path / "x.png")


def test_a_viewer_that_never_starts_is_told_from_one_that_breaks(monkeypatch, run_file, tmp_path):
    real = subprocess.Popen
    monkeypatch.setattr(viewer.subprocess, "Popen", lambda *a, **k: real(["false"]))
    with pytest.raises(FailedError, match=r"exit code 1\).*mesa-vulkan-drivers"):
        replay.screenshot(run_file, tmp_path / "x.png")


def test_a_fault_of_ours_beside_a_living_viewer_stays_what_it_is(monkeypatch, run_file, tmp_path):
    real = subprocess.Popen
    monkeypatch.setattr(viewer.subprocess, "Popen", lambda *a, **k: real(["sleep", "60"]))
    monkeypatch.setattr(viewer, "_connect", lambda *a: None)
    with pytest.raises(ZeroDivisionError), viewer.headless_viewer((10, 10)):
        raise ZeroDivisionError
