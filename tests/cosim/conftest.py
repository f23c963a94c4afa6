"""Helpers of these tests, loaded by path: there are no packages among the tests."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

import pytest

from cosim.recording.channels import CHANNELS
from cosim.recording.writer import Recorder
from cosim.scenario.loading import load_scenario

SHORT = ("scenario.duration='12 s'", "sheet.nodes=[40,40]", "recording.every='500 ms'")


@pytest.fixture(scope="session")
def synthetic():
    """The module `synthetic.py` beside this file."""
    spec = importlib.util.spec_from_file_location("cosim_synthetic", Path(__file__).with_name("synthetic.py"))
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="session")
def record(synthetic):
    """record(path, overrides) writes a synthetic run and returns the path."""

    def write(path, overrides=SHORT, stop_after=None, channels=CHANNELS):
        scenario = load_scenario("van_vliet_2018_floe_165m", overrides)
        recorder = Recorder(path, channels)
        try:
            recorder.on_start(synthetic.run_info(scenario))
            for k, frame in enumerate(synthetic.frames(scenario)):
                if k == stop_after:
                    break
                recorder.on_frame(frame)
        finally:
            recorder.on_close()
        return path

    return write


@pytest.fixture(scope="session")
def run_file(record, tmp_path_factory):
    """A complete recording of 12 s."""
    return record(tmp_path_factory.mktemp("run") / "run.mcap")
