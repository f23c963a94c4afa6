"""Ten thousand damaged recordings: no displayed value changes in silence, nothing breaks, no input is touched."""

import importlib.util
import random
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from cosim.recording.reader import RecordingError, read_run

spec = importlib.util.spec_from_file_location("mutations", Path(__file__).with_name("mutations.py"))
mutations = importlib.util.module_from_spec(spec)
sys.modules[spec.name] = mutations
spec.loader.exec_module(mutations)

SMALL = ("scenario.duration='7 s'", "recording.every='2 s'", "coupling.window='500 ms'")
SMALL += ("sheet.nodes=[6,6]", "sheet.length='30 m'", "sheet.width='30 m'")


@dataclass
class Whole:
    """The recording before it is damaged."""

    bytes: bytes
    run: Any

    def __getattr__(self, name):
        return getattr(self.run, name)


@pytest.fixture(scope="module")
def whole(record, tmp_path_factory):
    path = record(tmp_path_factory.mktemp("whole") / "run.mcap", SMALL)
    return Whole(path.read_bytes(), read_run(path))


def options(examples):
    return settings(
        max_examples=examples,
        deadline=60_000,  # [ms]
        database=None,
        derandomize=True,
        phases=[Phase.generate],
        suppress_health_check=list(HealthCheck),
    )


def fuzz(whole, folder, examples, capsys):
    path, out = folder / "x.mcap", folder / "y.mcap"
    commands = (("info", path), ("info", path, "--json"), ("compare", path, "--json"), ("recover", path, "-o", out))
    path.write_bytes(whole.bytes)
    for command in commands:  # what is loaded at first use takes its time
        mutations.check(path, whole, command)
    seen = dict.fromkeys((m.__name__ for m in mutations.MUTATIONS), 0)

    @options(examples)
    @given(st.sampled_from(mutations.MUTATIONS), st.integers(0, 2**32), st.sampled_from(commands))
    def one(mutation, seed, command):
        data = bytearray(whole.bytes)
        mutation(data, random.Random(seed))
        path.write_bytes(data)
        out.unlink(missing_ok=True)
        seen[mutation.__name__] += 1
        mutations.check(path, whole, command)

    one()
    assert min(seen.values()) > 0
    with capsys.disabled():
        print(f"\n{sum(seen.values())} damaged recordings: {seen}")


def test_damaged_recordings(whole, tmp_path, capsys):
    fuzz(whole, tmp_path, 300, capsys)


@pytest.mark.slow
def test_many_damaged_recordings(whole, tmp_path, capsys):
    fuzz(whole, tmp_path, 10_000, capsys)


def test_no_bit_of_the_metadata_can_be_flipped_in_silence(whole, tmp_path):
    """One bit of every byte; in a file without its end the seal of the record itself must do."""
    end = whole.bytes.index(b"attachments") + 90
    path = tmp_path / "x.mcap"
    for k, at in enumerate(range(end - 1100, end)):
        data = bytearray(whole.bytes)
        data[at] ^= 1 << k % 8
        path.write_bytes(data)
        with pytest.raises(RecordingError):
            read_run(path)
        if k % 4 == 0:
            path.write_bytes(data[: (at + len(data)) // 2])
            mutations.check(path, whole, ("info", path))
