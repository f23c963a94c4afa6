"""Reference files of wrong form or encoding: each one clear line; every shipped one is read."""

from pathlib import Path

import pytest

from cosim.analysis.reference import FeatureError, load_reference

GOOD = """title = "t"
[[feature]]
name = "split"
quantity = "event_load"
event = "split"
unit = "N"
source = "s"
measured = "3 MN"
"""


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ('"3 MN"', '["4 MN", "3 MN"]', "measured = ['4 MN', '3 MN']: a range goes from the lower to the higher value"),
        ('"3 MN"', '["1 MN", "2 MN", "3 MN"]', "give one value or a pair"),
        ('"3 MN"', "3", "a quantity needs its unit"),
        ('"3 MN"', "{}", "a quantity needs its unit"),
        ('"3 MN"', '"nan MN"', "not a finite number"),
        ('"s"', "7", "source = 7: one line of plain text is wanted"),
        ('"split"\nunit', "3\nunit", "event = 3: input should be"),
        ('"split"\nunit', '"split"\ncomponent = "fq"\nunit', "component = 'fq': use one of fx, fy, fz, f"),
        ('"split"\nunit', '"split"\ncomponent = ["fx"]\nunit', "component = ['fx']: input should be a valid string"),
        ('"event_load"\nevent = "split"', '"peak_load"\nphase = "x"', "phase = 'x': use one of breaking"),
        ('"event_load"', '["event_load"]', "quantity = ['event_load']: one line of plain text is wanted"),
        ('"event_load"', '"event_lode"', "did you mean event_load"),
        ('"3 MN"', '"3 MN"\ntolerance = "much"', "tolerance = 'much': a number above 0 is wanted"),
        ('"3 MN"', '"3 MN"\ntolerance = -0.1', "tolerance = -0.1: a number above 0 is wanted"),
        ('"3 MN"', '"3 MN"\nover = "-1 s"', "over = '-1 s': give a time, for example"),
        (GOOD, "feature = [1]", "feature = 1: write each as a table"),
        (GOOD, "feature = 1", "no features"),
        (GOOD, "[[feature]", "not valid TOML"),
    ],
)
def test_a_wrong_reference_is_one_line(cosim, run_file, tmp_path, old, new, says):
    file = tmp_path / "r.toml"
    assert old in GOOD
    file.write_text(GOOD.replace(old, new))
    code, out, err = cosim("compare", run_file, file)
    assert (code, out, err.count("\n")) == (2, "", 1), err
    assert str(file) in err
    assert says in err


def test_other_encodings_are_one_line_and_a_mark_of_utf8_is_none(tmp_path):
    file = tmp_path / "r.toml"
    file.write_bytes(GOOD.encode("utf-8-sig"))
    assert load_reference(file).features[0].measured == (3e6, 3e6)
    for data in (GOOD.encode("utf-16"), GOOD.replace("title", 'x = "\xe9"\ntitle').encode("latin-1")):
        file.write_bytes(data)
        with pytest.raises(FeatureError, match="not in UTF-8"):
            load_reference(file)


def test_every_shipped_reference_is_read():
    files = sorted((Path(__file__).parents[2] / "scenarios").glob("*/reference.toml"))
    assert len(files) >= 10
    assert all(load_reference(file).features for file in files)
