"""Replay: a rerun file, views that rerun draws, pictures and films without a viewer."""

import importlib.util
import io
import subprocess
import time
from pathlib import Path

import imageio_ffmpeg
import numpy as np
import pytest
from PIL import Image, ImageColor

from cosim.errors import FailedError
from cosim.recording import shapes
from cosim.recording.reader import read_run
from cosim.show import replay, still, viewer
from cosim.show.ice import palette
from coupling.interface import Phase


def test_a_rerun_file_is_valid(run_file, tmp_path):
    import rerun_cli

    out = tmp_path / "run.rrd"
    replay.save(run_file, out)
    binary = Path(rerun_cli.__file__).with_name("rerun")
    done = subprocess.run([binary, "rrd", "verify", out], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr


def test_a_measured_series_lies_over_the_curves(cosim, run_file, tmp_path):
    """In the time of the run, in the unit of its curves; the drift has an arrow."""
    import rerun_cli

    run, series, out = read_run(run_file), tmp_path / "measured.csv", tmp_path / "run.rrd"
    lines = (f"{t:.4f},{f:.1f}\n" for t, f in zip(run.t, run.component("fx"), strict=True))
    series.write_text("time [s],Fx [N]\n" + "".join(lines), encoding="utf-8")
    code, _, err = cosim("replay", run_file, "--measured", series, "--save", out)
    assert code == 0, err
    binary = Path(rerun_cli.__file__).with_name("rerun")
    told = subprocess.run([binary, "rrd", "print", "-v", out], capture_output=True, text=True, timeout=60).stdout
    assert "load/fx/measured" in told
    assert "load/fz/measured" not in told
    assert "world/drift" in told
    code, _, err = cosim("replay", run_file, "--measured", series, "--video", tmp_path / "x.mp4")
    assert code == 2
    assert "--measured lies over curves of a viewer" in err


def test_a_recording_opens_in_rerun_without_us(run_file):
    """Nested messages all set, schemas known: the stock decoders find nothing to complain about."""
    import rerun_cli

    binary = Path(rerun_cli.__file__).with_name("rerun")
    done = subprocess.run([binary, "mcap", "check", run_file], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.fixture(scope="module")
def headless():
    """The module `headless.py` beside this file."""
    spec = importlib.util.spec_from_file_location("cosim_headless", Path(__file__).with_name("headless.py"))
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def near(image, rgb, reach=40):
    """Number of pixels of about this colour."""
    rgb = ImageColor.getrgb(rgb) if isinstance(rgb, str) else rgb
    return int((np.abs(image - np.array(rgb)).max(axis=2) < reach).sum())


def pixels(data):
    return np.asarray(Image.open(io.BytesIO(data)).convert("RGB"), int)


def test_the_views_of_rerun_are_drawn_without_errors(run_file, headless):
    run = read_run(run_file)
    try:
        with headless.headless_viewer((1400, 900)) as (url, client):
            with replay.stream() as stream:
                stream.connect_grpc(url, default_blueprint=replay.blueprint(run))
                replay.send(stream, run_file, run)
            headless.wait_until_loaded(client, run)
            client.set_time(replay.TIMELINE, duration=10.0, play_state="paused")
            time.sleep(1.0)
            image = pixels(client.take_screenshot())
            reports = [str(report) for view in client.get_state().views for report in view.reports]
    except headless.NoDriverError as error:
        pytest.skip(f"no Vulkan driver: {error}")
    assert reports == []
    left = image[:, : image.shape[1] * 6 // 10]
    assert near(left, (215, 232, 245)) > 10_000  # ice
    assert near(left, shapes.STRUCTURE_RGB) > 1_000
    assert near(left, shapes.PHASE_RGB[Phase.SLIDING], 70) > 200


def test_a_picture_needs_no_viewer_and_no_screen(run_file, tmp_path, cosim):
    """Ice, water, structure, blocks, cracks and curves by colour and place, without the chrome of a viewer."""
    out = tmp_path / "x.png"
    code, text, err = cosim("replay", run_file, "--screenshot", out, "--at", "10")
    assert (code, text) == (0, ""), err
    image = pixels(out.read_bytes())
    assert image.shape == (900, 1600, 3)
    left, right = image[:, :898], image[:, 898:]
    assert near(left, "#eef5fa", 40) > 20_000  # ice
    for colour in (palette.BLOCK[Phase.ROTATING], palette.BLOCK[Phase.SLIDING]):
        assert near(left, colour, 60) > 100, colour
        assert near(right[:600], colour, 40) > 100, colour
    assert near(right[:600], palette.STRUCTURE, 10) > 5_000
    assert near(right[:600], palette.WATER, 10) > 5_000
    curves = right[620:]
    for phase in ("breaking", "rotating", "sliding"):
        seen = 0.75 * np.array(ImageColor.getrgb(palette.PHASE_COLOURS[phase])) + 0.25 * 255.0
        assert near(curves, seen, 20) > 100, phase
    column = np.abs(curves - np.array(ImageColor.getrgb("#c0185a"))).max(axis=2) < 30
    at = np.flatnonzero(column.sum(axis=0) > 100)  # the line at the time of the picture: 10 of 12 s
    width = right.shape[1]
    assert np.abs(at / width - (0.12 + 0.85 * 10 / 12)).max() < 0.01


def test_what_a_picture_cannot_be_of_is_told(run_file, tmp_path, cosim):
    for options, what in (
        (("--screenshot", tmp_path / "x.png", "--at", "99"), "0 to 12 s"),
        (("--at", "3"), "belong to --screenshot"),
        (("--web", "--video", tmp_path / "x.mp4"), "exclude each other"),
    ):
        code, out, err = cosim("replay", run_file, *options)
        assert (code, out) == (2, "")
        assert what in err
    assert list(tmp_path.iterdir()) == []


def test_a_film_has_its_pictures(run_file, tmp_path):
    told = []
    out = tmp_path / "x.mp4"
    run = read_run(run_file)
    assert still.video(run, run_file, out, lambda done, of: told.append((done, of)), most=3) == 3
    assert told == [(1, 3), (2, 3), (3, 3)]
    assert out.read_bytes()[4:8] == b"ftyp"
    film = imageio_ffmpeg.read_frames(str(out))
    about = next(film)
    assert about["size"] == (1600, 900)
    frames = [np.frombuffer(frame, np.uint8).reshape(900, 1600, 3).astype(int) for frame in film]
    assert len(frames) == 3
    assert near(frames[-1][:600, 898:], palette.BLOCK[Phase.SLIDING], 60) > 100
    assert near(frames[0][:600, 898:], palette.BLOCK[Phase.SLIDING], 60) < 50


def test_a_viewer_that_never_starts_is_told(monkeypatch, run_file):
    real = subprocess.Popen
    monkeypatch.setattr(viewer.subprocess, "Popen", lambda *a, **k: real(["false"]))
    with pytest.raises(FailedError, match=r"exit code 1\).*--screenshot"):
        replay.open_viewer(run_file)
