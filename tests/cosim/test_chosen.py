"""Steps that a scenario leaves open follow from thickness, drift and spacing, and are told and recorded."""

import tomllib

import pytest

from cosim.scenario.loading import load_scenario
from cosim.scenario.template import CONE, SLOPE, scenario_text

#: thickness, drift, cells of a 60 m floe -> window, sub-step, longest step [ms]
CASES = [
    ("0.8 m", "0.3 m/s", 40, (50.0, 5.0, 200.0)),
    ("3 m", "0.3 m/s", 40, (50.0, 5.0, 200.0)),  # never longer
    ("10 cm", "0.3 m/s", 40, (20.0, 2.0, 80.0)),  # (0.1 m / 1 m)^0.5 = 0.32
    ("4 cm", "0.3 m/s", 40, (10.0, 1.0, 40.0)),  # 1:25 of ice of 1 m, where 50 and 5 ms are 10 and 1 ms
    ("0.8 m", "2 m/s", 80, (20.0, 5.0, 80.0)),  # 0.1 x 0.75 m / 2 m/s = 37 ms
    ("0.8 m", "2 m/s", 240, (10.0, 2.0, 40.0)),  # 12.5 ms
]


def case(folder, *options):
    file = folder / "pier.toml"
    file.write_text(scenario_text(CONE))
    return load_scenario(file, options)


def steps(s):
    return tuple(1e3 * t for t in (s.coupling.window, s.rubble.substep, s.fracture.longest_step))


@pytest.mark.parametrize(("thickness", "drift", "cells", "expected"), CASES)
def test_steps_follow_from_the_case(tmp_path, thickness, drift, cells, expected):
    n = cells + 1
    s = case(tmp_path, f"ice.thickness={thickness}", f"drift.velocity={drift}", f"sheet.nodes=[{n}, {n}]")
    assert steps(s) == pytest.approx(expected, rel=1e-12)
    assert s.window_ns % round(s.rubble.substep * 1e9) == 0


def test_what_is_given_stays(tmp_path):
    assert steps(case(tmp_path, "ice.thickness=10 cm", "coupling.window=100 ms")) == pytest.approx((100.0, 2.0, 400.0))
    assert steps(case(tmp_path, "ice.thickness=10 cm", "rubble.substep=5 ms")) == pytest.approx((20.0, 5.0, 80.0))
    assert steps(case(tmp_path, "fracture.longest_step=50 ms")) == pytest.approx((50.0, 5.0, 50.0))


def test_what_was_chosen_is_told_and_recorded(cosim, tmp_path):
    s = case(tmp_path, "ice.thickness=10 cm")
    told = tomllib.loads(s.resolved_toml())
    chosen = (told["coupling"]["window"], told["rubble"]["substep"], told["fracture"]["longest_step"])
    assert chosen == ("0.02 s", "0.002 s", "0.08 s")
    out = cosim("check", tmp_path / "pier.toml", "--set", "ice.thickness=10 cm")[1]
    assert "window 20 ms, sub-step 2 ms" in " ".join(out.split())


def test_the_templates_run_in_whole_windows(tmp_path):
    for values in (CONE, SLOPE):
        (tmp_path / "x.toml").write_text(scenario_text(values))
        s = load_scenario(tmp_path / "x.toml")
        assert s.duration_ns % s.window_ns == 0
