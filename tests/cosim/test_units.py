"""Quantities: text with unit -> SI float, and nothing else."""

import math

import pytest
from pydantic_core import PydanticCustomError

from cosim.scenario.units import Unit, to_si


@pytest.mark.parametrize(
    ("text", "si", "value"),
    [
        ("3 m", "m", 3.0),
        ("300 cm", "m", 3.0),
        ("8.7 GPa", "Pa", 8.7e9),
        ("0.1 m/s", "m/s", 0.1),
        ("45 deg", "rad", math.pi / 4),
        ("50 ms", "s", 0.05),
        ("1 min", "s", 60.0),
        ("375 kN", "N", 375e3),
        ("846 kg/m^3", "kg/m^3", 846.0),
        ("0.846 t/m^3", "kg/m^3", 846.0),
        ("9.81 m/s^2", "m/s^2", 9.81),
        ("1 kN/m^2", "Pa", 1000.0),
    ],
)
def test_si(text, si, value):
    assert to_si(text, Unit(si, "")) == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize(
    "wrong",
    [
        "3",
        "3 kg",
        "m",
        "",
        "3 blub",
        "nan m",
        "inf m",
        "abc",
        "1 degC",
        3,
        3.0,
        True,
        None,
    ],
)
def test_refused(wrong):
    with pytest.raises(PydanticCustomError, match="for example"):
        to_si(wrong, Unit("m", "3 m"))


def test_a_bare_number_is_shown_with_its_unit():
    with pytest.raises(PydanticCustomError, match=r'for example "2\.5 m"'):
        to_si(2.5, Unit("m", "3 m"))


def test_a_bare_angle_is_shown_in_degrees():
    """Nobody who writes 55 means 55 rad."""
    with pytest.raises(PydanticCustomError, match=r'for example "55 deg"'):
        to_si(55, Unit("rad", "45 deg"))
