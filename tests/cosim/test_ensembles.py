"""Designs, distributions and indices against closed forms, with cases that they must tell apart."""

import numpy as np
import pytest
from scipy import stats

from cosim.analysis.reference import Feature, Reference
from cosim.errors import FailedError, InputError
from cosim.show.ensemble_figure import ensemble
from cosim.study.design import Design
from cosim.study.sensitivity import indices
from cosim.study.statistics import distribution, ensembles, interval
from cosim.study.sweep import row_of
from cosim.study.variants import Axis, Range, Variant, parse_axis

UNIT = [
    Range("contact.friction", 0.0, 1.0, ""),
    Range("ice.thickness", 1.0, 2.0, "m"),
    Range("water.damping", 0, 1, ""),
]


# ---- designs -------------------------------------------------------------------------------------------------------


def test_one_at_a_time_and_grid():
    axes = [Axis("a.x", ("1", "2")), Axis("b.y", ("3",))]
    assert [v.name for v in Design().variants(axes, 0)] == ["base", "a.x = 1", "a.x = 2", "b.y = 3"]
    grid = Design("grid").variants(axes, 0)
    assert [v.overrides for v in grid] == [(), ("a.x=1", "b.y=3"), ("a.x=2", "b.y=3")]
    with pytest.raises(InputError, match="twice"):
        Design("grid").variants([axes[0], axes[0]], 0)


def test_seeds_go_on_from_that_of_the_scenario_and_make_a_group():
    chosen = Design(seeds=3).variants([Axis("a.x", ("1",))], 2018)
    assert [v.seed for v in chosen] == ["2018", "2019", "2020"] * 2
    assert [v.group for v in chosen] == ["base"] * 3 + ["a.x = 1"] * 3
    assert chosen[4].overrides == ("a.x=1", "scenario.seed=2019")
    assert len(Design(seeds=32).variants([], 0)) == 32


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("ice.thickness=1 m..2500 mm", Range("ice.thickness", 1.0, 2.5, "m")),
        ("contact.friction=0.05..0.3", Range("contact.friction", 0.05, 0.3, "")),
        ("contact.strength=200 kPa..2 MPa", Range("contact.strength", 2e5, 2e6, "Pa")),
    ],
)
def test_ranges_are_read_in_si(text, expected):
    assert parse_axis(text) == expected


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("ice.thickness=2 m..1 m", "turn it round"),
        ("ice.thickness=1..2", "needs its unit"),
        ("ice.thicknes=1 m..2 m", "no key"),
        ("sheet.back=held..free", "no real number"),
        ("contact.friction=a..b", "no number"),
    ],
)
def test_a_wrong_range_is_one_line(text, says):
    with pytest.raises(InputError, match=says) as error:
        parse_axis(text)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("design", "axes", "says"),
    [
        (Design("sobol"), [Axis("a.x", ("1",))], "draws from a range"),
        (Design("grid"), UNIT[:1], "needs --design random"),
        (Design("sobol", samples=48), UNIT, "powers of 2"),
        (Design(), [], "nothing varies"),
        (Design("random", seeds=3), [], "nothing varies"),
        (Design(seeds=3), [Axis("scenario.seed", ("1",))], "exclude each other"),
        (Design(seeds=999_999), [Axis("a.x", ("1", "2"))], "more than 1000000"),
    ],
)
def test_designs_that_cannot_be_are_one_line(design, axes, says):
    with pytest.raises(InputError, match=says):
        design.variants(axes, 0)


def test_points_lie_in_their_ranges_and_are_written_to_the_last_bit():
    for design in (Design("random", samples=200, draw=3), Design("sobol", samples=64, draw=3)):
        points, chosen = design.points(UNIT), design.variants(UNIT, 0)
        assert len(chosen) == len(points) == {"random": 200, "sobol": 64 * 5}[design.name]
        assert (points >= [0, 1, 0]).all()
        assert (points <= [1, 2, 1]).all()
        read = [[float(value.split()[0]) for _, value in v.changes] for v in chosen]
        assert (np.array(read) == points).all()
        assert chosen[0].changes[1][1].endswith(" m")
        assert (design.points(UNIT) == points).all()
    assert (Design("random", draw=1).points(UNIT) != Design("random", draw=2).points(UNIT)).all()


# ---- indices -------------------------------------------------------------------------------------------------------


def rows_of(chosen, values, **more):
    return [
        row_of(k, v, {f"{c}_peak": float(y) for c in ("fx", "fz", "f")} | more)
        for k, (v, y) in enumerate(zip(chosen, values, strict=True))
    ]


def g_function(x, a=(0.0, 1.0, 9.0)):
    """Sobol's G; closed form: V_i = 1/3 / (1 + a_i)^2, V = prod (1 + V_i) - 1."""
    share = x - np.array([0.0, 1.0, 0.0])
    return np.prod((np.abs(4 * share - 2) + a) / (1 + np.array(a)), axis=1)


def test_sobol_indices_of_the_g_function():
    design = Design("sobol", samples=4096)
    chosen, y = design.variants(UNIT, 0), g_function(design.points(UNIT))
    found = [row for row in indices(design, UNIT, chosen, rows_of(chosen, y)) if row["quantity"] == "fx_peak"]
    V = 1 / 3 / (1 + np.array([0.0, 1.0, 9.0])) ** 2
    whole = np.prod(1 + V) - 1
    total = V * np.prod(1 + V) / (1 + V) / whole
    assert [row["first"] for row in found] == pytest.approx(V / whole, abs=0.02)
    assert [row["total"] for row in found] == pytest.approx(total, abs=0.02)
    assert found[0]["first_interval"] < 0.06


def test_random_points_find_the_key_that_counts():
    design = Design("random", samples=500)
    chosen, x = design.variants(UNIT, 0), design.points(UNIT)
    found = indices(design, UNIT, chosen, rows_of(chosen, x[:, 1] + 0.1 * x[:, 2]))[:3]
    assert found[1]["first"] == pytest.approx(1 / 1.01, abs=1e-6)
    assert found[1]["explained"] == pytest.approx(1.0)
    assert found[1]["delta"] > 0.5 > 3 * found[0]["delta"]


def test_a_few_dozen_random_points_tell_keys_apart_and_what_keys_alone_do_not_explain():
    """2 u + (3 w^2 - 1) of u, w in -1..1 and a product of variance 4/45: shares of 1.3333, 0.8 and 0.0889 of 2.2222.

    A twin that knows straight lines only gives the square nothing.
    """
    design, keys = Design("random", samples=48), UNIT[:2]
    x = design.points(keys)
    u, w = ((x - [r.low for r in keys]) / [r.high - r.low for r in keys] * 2.0 - 1.0).T
    found = indices(
        design, keys, chosen := design.variants(keys, 0), rows_of(chosen, 2 * u + 3 * w * w - 1 + 0.9 * u * w)
    )
    first = [row["first"] for row in found[:2]]
    whole = 4 / 3 + 4 / 5 + 0.09
    assert first == pytest.approx([4 / 3 / whole, 4 / 5 / whole], abs=0.06)
    assert all(abs(f - t) < row["first_interval"] for f, t, row in zip(first, [0.6, 0.36], found, strict=False))
    assert 0.9 < found[0]["explained"] < 0.99
    product = indices(design, keys, chosen, rows_of(chosen, u * w))
    assert product[0]["explained"] < 0.1  # nothing but interaction
    assert max(row["first"] for row in product[:2]) < 0.2
    assert "delta" not in found[0]


def test_a_failed_point_takes_its_block_and_nothing_else():
    design = Design("sobol", samples=512)
    chosen, y = design.variants(UNIT, 0), g_function(design.points(UNIT))
    rows = rows_of(chosen, y)
    rows[7] = row_of(7, chosen[7], {"error": "it failed"})
    found = indices(design, UNIT, chosen, rows)[0]
    assert found["points"] == 5 * 511
    assert found["first"] == pytest.approx(0.742, abs=0.06)
    assert indices(design, UNIT, chosen, rows[:3]) == []


def test_points_stand_for_the_mean_over_their_seeds():
    one, two = Design("sobol", samples=256), Design("sobol", samples=256, seeds=2)
    y = g_function(one.points(UNIT))
    plain = indices(one, UNIT, one.variants(UNIT, 0), rows_of(one.variants(UNIT, 0), y))
    noise = np.column_stack((y + 0.3, y - 0.3)).ravel()
    seeded = indices(two, UNIT, two.variants(UNIT, 0), rows_of(two.variants(UNIT, 0), noise))
    assert [r["first"] for r in seeded] == pytest.approx([r["first"] for r in plain], abs=1e-9)


# ---- distributions -------------------------------------------------------------------------------------------------


def test_quantiles_and_their_intervals_on_a_known_distribution():
    """A median's interval covers the true one in about 95 of 100 ensembles, of the width that theory gives it."""
    rng = np.random.default_rng(1)
    covered, width, n = 0, [], 60
    for _ in range(100):
        low, high = interval(rng.standard_normal(n), 0.5)
        covered += low <= 0.0 <= high
        width.append(high - low)
    assert 87 <= covered <= 99
    assert np.mean(width) == pytest.approx(2 * 1.96 * np.sqrt(np.pi / 2 / n), rel=0.1)
    exact = distribution([float(k) for k in range(101)])
    assert (exact["p05"], exact["median"], exact["p95"], exact["n"]) == (5.0, 50.0, 95.0, 101)


def test_rank_and_exceedance_of_a_measured_value():
    values = [1.0, 2.0, 3.0, 4.0, None]
    found = distribution(values, (2.5, 2.5))
    assert (found["rank"], found["below"], found["above"], found["exceedance"]) == (3, 2, 2, 0.5)
    assert (found["n"], found["missing"]) == (4, 1)
    expected = stats.beta.ppf([0.025, 0.975], [2, 3], [3, 2])  # Clopper and Pearson 1934
    assert found["exceedance_interval"] == pytest.approx(expected.tolist())
    ends = distribution(values, (1.5, 3.5))
    assert (ends["below"], ends["above"], ends["measured"], ends["measured_range"]) == (1, 1, 2.5, [1.5, 3.5])
    assert distribution([None, None]) == {"n": 0, "missing": 2}
    assert distribution([1.0])["median_interval"] is None


def ensemble_rows(n=8):
    chosen = Design(seeds=n).variants([Axis("a.x", ("1",))], 0)
    rows = rows_of(chosen, [1e6 * (1 + k % n) for k in range(len(chosen))], fx_time=1.0)
    for row in rows:
        row["feature_first"] = row["fx_peak"] / 2
    rows[n // 2] = row_of(n // 2, chosen[n // 2], {"error": "no"})
    return rows


REFERENCE = Reference("r", (Feature("first", "encounter_load", "N", "s", measured=(2e6, 2e6)),))


def test_groups_are_runs_that_differ_in_their_seed():
    found = {(row["group"], row["quantity"]): row for row in ensembles(ensemble_rows(), REFERENCE)}
    assert len(found) == 8
    assert (found["base", "fx_peak"]["n"], found["a.x = 1", "fx_peak"]["n"]) == (7, 8)
    assert found["a.x = 1", "fx_peak"]["median"] == 4.5e6
    assert found["a.x = 1", "first"]["rank"] == 4
    assert found["base", "fx_peak"]["measured"] is None


def test_the_picture_of_an_ensemble_is_drawn(tmp_path):
    rows = ensemble_rows()
    content = {"scenario": "s", "variants": rows, "ensembles": ensembles(rows, REFERENCE)}
    ensemble(content, tmp_path / "e.png")
    assert (tmp_path / "e.png").read_bytes()[:4] == b"\x89PNG"
    one = ensemble_rows(1)[1:]
    with pytest.raises(FailedError, match="not drawn"):
        ensemble({**content, "variants": one, "ensembles": ensembles(one, REFERENCE)}, tmp_path / "f.png")


def test_a_variant_without_changes_is_the_base():
    assert (Variant().name, Variant((("scenario.seed", "3"),)).group) == ("base", "base")
