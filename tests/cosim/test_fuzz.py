"""Scenarios and references that are damaged at random: a documented exit code, one line for each fault, and no more.

What the loader takes is run for two windows. 300 mutations of each on every run, 10 000 in the slow suite.
"""

from __future__ import annotations

import contextlib
import io
import signal
from collections import Counter
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from cosim.cli import main
from cosim.scenario.cost import cost_of
from cosim.scenario.errors import ScenarioError
from cosim.scenario.loading import load_scenario

OFTEN, SLOW = 300, 10_000
LIMIT = 30  #: seconds that one call may take
LINE = 1500  #: characters of a line, paths included
WILD = [
    '"12,5 m"', '"1 500 mm"', '"9**9**9 m"', '"2**2**2**2**2**2 m"', '"3 m**9**9**9"', '"45 %"', '"nan m"',
    '"1e400 m"', '"1e-300 m"', '"1e300 Pa"', '"-1 m"', '"0 m"', '"0.7 mPa"', '"5000 km"', '"3 m"', '"1 s"', '"1 ns"',
    '"45 deg"', '"[/x]"', '"\\u001b[31m"', '"\\u202e"', '""', '" "', '"rate-dependent"', '"held"', '"upward"',
    '"cone"', '"open"', '"dynamic"', 'nan', 'inf', '-inf', '1e300', '-1', '0', '1', '2', '3.0', 'true', '[]', '{}',
    '[1, 2]', '["3 m", "2 m"]', '[40000, 40000]', '[["-1 m", "1 m"]]', '[["-9 m", "9 m"], ["5 m", "1 m"]]',
    "0x" + "f" * 400, "9" * 5000, '1979-05-27', '"' + "x" * 3000 + '"', '["combined-tension"]',
    '["spalling", "spalling"]', '"split"', '"fx"', "'''a\nb'''", "[" * 300, '"0.5 m"', '"30 deg"', '"2 MPa"',
    '"1 GPa"', '"0.05 m/s"', '"1.5 m/s"', '"10 ms"', '"0.2 s"', '0.3', '0.0', '"free"', '"roller"', '"crushing"',
    '"plane"', '"downward"', '"closing"', '[8, 8]', '[21, 21]',
]  # fmt: skip
SCENARIO = """
[scenario]
title = "small"
duration = "0.1 s"
[ice]
thickness = "0.8 m"
density = "900 kg/m^3"
youngs_modulus = "5 GPa"
poisson_ratio = 0.3333333333333333
tensile_strength = "500 kPa"
flexural_strength = "500 kPa"
compressive_strength = "2.5 MPa"
[water]
density = "1025 kg/m^3"
[sheet]
length = "20 m"
width = "20 m"
nodes = [11, 11]
axis_from_side = "10 m"
back = "held"
[structure]
kind = "cone"
slope = "55 deg"
waterline_radius = "5 m"
neck_radius = "3 m"
toe_depth = "5 m"
top = "4 m"
[contact]
strength = "2.5 MPa"
friction = 0.1
[drift]
velocity = "0.3 m/s"
[fracture]
cracks = "open"
[rubble]
friction_ice_ice = 0.1
initial_porosity = 0.3
[coupling]
window = "50 ms"
[recording]
every = "50 ms"
averaging = "0.3 s"
[baseline]
rubble_height = "2 m"
"""
REFERENCE = """
title = "measured"
over = "0.3 s"
[[feature]]
name = "peak"
quantity = "peak_load"
component = "fx"
phase = "breaking"
unit = "N"
measured = ["1 MN", "2 MN"]
source = "a paper"
[[feature]]
name = "period"
quantity = "cycle_period"
unit = "s"
after = "circumferential"
smooth = 0.5
prominence = 0.2
source = "a paper"
[[feature]]
name = "first"
quantity = "encounter_load"
unit = "N"
n = 1
event = ["circumferential", "split"]
thesis = "3 MN"
over = "0 s"
tolerance = 0.1
source = "a paper"
"""
#: the same mutations on every machine and in every run of the same sources
ALWAYS = settings(deadline=None, derandomize=True, database=None, suppress_health_check=list(HealthCheck))
POSITION = st.integers(0, 10_000)
BYTES = st.binary(min_size=1, max_size=6)
MUTATION = st.one_of(
    st.tuples(st.just("value"), POSITION, st.sampled_from(WILD).map(str.encode)),
    st.tuples(
        st.just("value"), POSITION, st.text(max_size=12).map(lambda t: b'"' + t.encode("utf-8", "ignore") + b'"')
    ),
    st.tuples(st.just("insert"), POSITION, BYTES),
    st.tuples(st.just("replace"), POSITION, BYTES),
    st.tuples(st.just("cut"), POSITION, BYTES),
    st.tuples(st.just("drop"), POSITION, st.just(b"")),
    st.tuples(st.just("again"), POSITION, st.just(b"")),
)


def mutated(text: str, mutations: list[tuple[str, int, bytes]]) -> bytes:
    """A text after some changes: values for others, bytes put in, over or out, lines dropped and doubled."""
    data = text.encode()
    for kind, place, piece in mutations:
        lines = data.split(b"\n")
        k, at = place % len(lines), place % max(len(data), 1)
        if kind == "value" and b"=" in lines[k]:
            lines[k] = lines[k].split(b"=")[0] + b"= " + piece
        elif kind == "drop":
            del lines[k]
        elif kind == "again":
            lines.insert(k, lines[k])
        data = b"\n".join(lines)
        if kind == "insert":
            data = data[:at] + piece + data[at:]
        elif kind == "replace":
            data = data[:at] + piece + data[at + len(piece) :]
        elif kind == "cut":
            data = data[:at] + data[at + 20 * len(piece) :]
    return data


def call(*arguments: object) -> tuple[int, str, str]:
    """Exit code, standard output and error of a command; it may not take long."""

    def hang(*_: object) -> None:
        raise AssertionError(f"it hangs: {arguments}")

    out, err = io.StringIO(), io.StringIO()
    before = signal.signal(signal.SIGALRM, hang)
    signal.alarm(LIMIT)
    try:
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err), pytest.raises(SystemExit) as stop:
            main([str(a) for a in arguments])
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)
    return int(stop.value.code or 0), out.getvalue(), err.getvalue()


def tried(*arguments: object, lines: int | None = 1) -> int:
    """The exit code, after a look at what was said."""
    code, out, err = call(*arguments)
    said = out + err
    assert code in (0, 1, 2), said
    assert "Traceback" not in said
    assert "unexpected" not in err, err
    assert "\x1b" not in said
    told = [line for line in err.splitlines() if line.startswith("cosim: ")]
    assert bool(told) == (code != 0), err
    assert lines is None or len(told) <= lines, err
    assert all(len(line) < LINE for line in err.splitlines()), err
    return code


def small(file: Path) -> bool:
    """Whether a scenario that is read runs in a moment."""
    try:
        model = load_scenario(file).model
    except ScenarioError:
        return False
    cost = cost_of(model)
    return cost.nodes <= 400 and cost.windows <= 5 and model.coupling.window / model.rubble.substep <= 100


def try_scenarios(folder: Path, count: int) -> Counter[str]:
    """Check, and where it passes, run."""
    seen: Counter[str] = Counter()
    file = folder / "s.toml"

    @settings(ALWAYS, max_examples=count)
    @given(st.lists(MUTATION, min_size=1, max_size=2))
    def trial(mutations: list[tuple[str, int, bytes]]) -> None:
        data = mutated(SCENARIO, mutations)
        file.write_bytes(data)
        code = tried("check", file, lines=None)
        seen["mutations"] += 1
        seen[f"check: exit {code}"] += 1
        if code == 0 and small(file):
            seen[f"run: exit {tried('run', file, '-q')}"] += 1
        assert file.read_bytes() == data
        assert [f.name for f in folder.iterdir()] == ["s.toml"]

    trial()
    return seen


def try_references(folder: Path, recording: Path, count: int) -> Counter[str]:
    """Compare a recording with each."""
    seen: Counter[str] = Counter()
    file, before = folder / "r.toml", recording.read_bytes()

    @settings(ALWAYS, max_examples=count)
    @given(st.lists(MUTATION, min_size=1, max_size=2))
    def trial(mutations: list[tuple[str, int, bytes]]) -> None:
        data = mutated(REFERENCE, mutations)
        file.write_bytes(data)
        seen["mutations"] += 1
        seen[f"compare: exit {tried('compare', recording, file)}"] += 1
        assert file.read_bytes() == data

    trial()
    assert recording.read_bytes() == before
    return seen


def told(capsys: pytest.CaptureFixture[str], what: str, seen: Counter[str]) -> None:
    """The counts, also where tests are quiet."""
    with capsys.disabled():
        print(f"\n{what}: " + ", ".join(f"{n} {kind}" for kind, n in sorted(seen.items())))


@pytest.mark.parametrize("count", [OFTEN, pytest.param(SLOW, marks=pytest.mark.slow)])
def test_damaged_scenarios(tmp_path: Path, capsys: pytest.CaptureFixture[str], count: int) -> None:
    (tmp_path / "s.toml").write_text(SCENARIO)
    assert tried("check", tmp_path / "s.toml") == tried("run", tmp_path / "s.toml", "-q") == 0
    seen = try_scenarios(tmp_path, count)
    told(capsys, "scenarios", seen)
    assert seen["mutations"] >= count
    assert seen["check: exit 2"] > seen["mutations"] // 3
    assert seen["run: exit 0"] > 0


@pytest.mark.parametrize("count", [OFTEN, pytest.param(SLOW, marks=pytest.mark.slow)])
def test_damaged_references(tmp_path: Path, run_file: Path, capsys: pytest.CaptureFixture[str], count: int) -> None:
    (tmp_path / "r.toml").write_text(REFERENCE)
    assert tried("compare", run_file, tmp_path / "r.toml") == 0
    seen = try_references(tmp_path, run_file, count)
    told(capsys, "references", seen)
    assert seen["mutations"] >= count
    assert seen["compare: exit 2"] > seen["mutations"] // 3
    assert seen["compare: exit 0"] > 0
