"""Series from files in the wild: each is one clear line, or a repair that is told and a series that is right."""

from __future__ import annotations

import datetime

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from cosim.series.description import load_description
from cosim.series.read import read_series
from cosim.series.told import SeriesError

T = np.round(0.1 * np.arange(40), 10)
F = np.round(100.0 * np.sin(T) ** 2 + 5.0, 3)  # kN
ZERO = datetime.datetime(2026, 11, 25, 13, 0, 0)


def rows(sep=";", form="{:.1f}{s}{:.3f}", t=T, f=F, end="\n"):
    return "".join(form.format(a, b, s=sep) + end for a, b in zip(t, f, strict=True))


def stamps(pattern, sep=";", step=T):
    text = ((ZERO + datetime.timedelta(seconds=float(a))).strftime(pattern) for a in step)
    return "".join(f"{a}{sep}{b:.3f}\n" for a, b in zip(text, F, strict=True))


def comma(text):
    return text.replace(".", ",")


HEAD = "t [s];Fx [kN]\n"
GOOD = HEAD + rows()
LINES = GOOD.splitlines(keepends=True)
MANY = "".join(f"{b:.1f};{1000 * f:,.2f}\n".replace(",", "'") for b, f in zip(T, F, strict=True))
NAMELESS = ["time.column=1", "time.unit=s", "fx.column=2", "fx.unit=kN"]

#: file, settings, what is told; the series is right
TOLD = {
    "semicolon, point": (GOOD, [], "semicolon between fields and decimal point"),
    "semicolon, comma": (HEAD + comma(rows()), [], "semicolon between fields and decimal comma"),
    "comma, point": ("t [s],Fx [kN]\n" + rows(","), [], "comma between fields and decimal point"),
    "tab, comma": ("t [s]\tFx [kN]\n" + comma(rows("\t")), [], "tab between fields and decimal comma"),
    "white space": ("# t[s] Fx[kN]\n" + rows("   "), [], "white space"),
    "padded": ("t_[s] Fx_[kN]\n" + rows(form="{:12.1f}{s}{:14.3f}", sep=" "), NAMELESS, "white space"),
    "quoted": ('"t [s]","Fx [kN]"\n' + comma(rows(form='"{:.1f}";"{:.3f}"')).replace(";", ","), [], "decimal comma"),
    "bar": ("t [s]|Fx [kN]\n" + rows("|"), [], "| between fields"),
    "utf-8 mark": ("\ufeff" + GOOD, [], "UTF-8, by its byte order mark"),
    "utf-16 mark": (GOOD.encode("utf-16"), [], "UTF-16, by its byte order mark"),
    "utf-16 big-endian mark": (b"\xfe\xff" + GOOD.encode("utf-16-be"), [], "UTF-16, by its byte order mark"),
    "utf-16 without mark": (GOOD.encode("utf-16-le"), [], "UTF-16-LE, by every other byte"),
    "utf-16 big-endian without mark": (GOOD.encode("utf-16-be"), [], "UTF-16-BE, by every other byte"),
    "latin-1": (("Messung Südkegel, Größe 1:1, Prüfer Jörg Weiß\n" + GOOD).encode("latin-1"), [], "not UTF-8"),
    "windows line ends": (GOOD.replace("\n", "\r\n"), [], "semicolon"),
    "old mac line ends": (GOOD.replace("\n", "\r"), [], "semicolon"),
    "title lines": ("Basin test 12\nice 42 mm\n" + GOOD, [], "2 lines above the names"),
    "title with numbers": ("Test;12\nrate;10\n" + GOOD, [], "2 lines above the names"),
    "units in second row": ("t;Fx\ns;kN\n" + rows(), [], "units stand in a row of their own"),
    "units in brackets in second row": ("t;Fx\n[s];[kN]\n" + rows(), [], "units stand in a row of their own"),
    "channel numbers over names": ("1;2\n" + GOOD, [], "1 line above the names"),
    "remarks": ("# by hand\n" + HEAD + "".join(f"{r}# mark\n" for r in LINES[1:]), [], "40 remarks among the rows"),
    "percent remarks": ("% t [s]; Fx [kN]\n" + rows(), [], "'t' in s"),
    "own remarks": ("* hello\n" + GOOD, ["text.comment=*"], "semicolon"),
    "sep line": ("sep=;\n" + GOOD, [], "line 1 names the delimiter"),
    "no names": (rows(), NAMELESS, "no names above the 2 columns"),
    "blank lines": (GOOD.replace("\n", "\n\n"), [], "semicolon"),
    "delimiter at the end": ("t [s];Fx [kN];\n" + rows(end=";\n"), [], "last column is empty"),
    "delimiter at the end, not in the head": (HEAD + rows(end=";\n"), [], "last column is empty"),
    "nan": (GOOD + "4.0;NaN\n4.1;\n4.2;#N/A\n", [], "3 of 43 rows without a time or a value"),
    "infinite": (GOOD + "4.0;inf\n", [], "1 of 41 rows without"),
    "text for a value": (GOOD + "4.0;overload\n", [], "1 of 41 rows without"),
    "short line": (GOOD + "4.0\n", [], "1 line without 2 fields, the first is line 42 with 1"),
    "long line": (GOOD + "4.0;1;2\n", [], "1 line without 2 fields"),
    "second head": ("".join(LINES[:21]) + HEAD + "".join(LINES[21:]), [], "1 of 41 rows without"),
    "unsorted": (HEAD + "".join(LINES[21:]) + "".join(LINES[1:21]), [], "times go back at 1 place: rows sorted"),
    "reversed": (HEAD + "".join(LINES[:0:-1]), [], "rows sorted by time"),
    "repeated": (GOOD + LINES[-1], [], "1 row with a time that was there"),
    "other sign": (HEAD + rows(f=-F), ["fx.sign=-1"], "sign turned"),
    "milliseconds, newtons": ("t (ms);Fx (N)\n" + rows(t=1000 * T, f=1000 * F), [], "'t' in ms"),
    "units after a slash": ("t / s;Fx / kN\n" + rows(), [], "'Fx' in kN"),
    "units after in": ("Zeit in s;Kraft x in kN\n" + rows(), [], "'Kraft x' in kN"),
    "unit is overruled": ("t [s];Fx [MN]\n" + rows(), ["fx.unit=kN"], "in kN, as set"),
    "grouped digits": ("t [s];Fx [N]\n" + MANY, ["text.thousands='", "text.decimal=."], "'Fx' in N"),
    "exponents": (HEAD + rows(form="{:.6e}{s}{:.6E}"), [], "semicolon"),
    "fortran exponents": (HEAD + rows(form="{:.6e}{s}{:.6E}").replace("e", "D").replace("E", "d"), [], "semicolon"),
    "unicode minus": (HEAD + rows(f=-F).replace("-", "\u2212"), ["fx.sign=-1"], "sign turned"),
    "no times": ("Fx [kN]\n" + "".join(f"{b:.3f}\n" for b in F), ["time.step=100 ms"], "distance of 0.1 s, as set"),
    "stamps of the norm": ("time;Fx [kN]\n" + stamps("%Y-%m-%dT%H:%M:%S.%f"), [], "counted from 2026-11-25 13:00:00"),
    "stamps with zone": ("time;Fx [kN]\n" + stamps("%Y-%m-%d %H:%M:%S.%f+01:00"), [], "from 2026-11-25 12:00:00"),
    "german stamps": ("Zeit;Fx [kN]\n" + comma(stamps("%d.%m.%Y %H:%M:%S,%f")).replace(
        "25,11,2026", "25.11.2026"), [], "dates with the day first"),
    "american stamps": ("Time,Fx [kN]\n" + stamps("%m/%d/%Y %I:%M:%S.%f %p", ","), [], "dates with the month first"),
    "own format": ("Time;Fx [kN]\n" + stamps("%Y%m%d %H%M%S.%f"), ["time.format=%Y%m%d %H%M%S.%f"], "stamps, counted"),
    "date and clock apart": ("Date;Time;Fx [kN]\n" + stamps("%Y-%m-%d;%H:%M:%S.%f"), [], "clock in column 'Time'"),
    "clock": ("Uhrzeit;Fx [kN]\n" + stamps("%H:%M:%S.%f"), [], "clock, counted from 13:00:00"),
    "clock past midnight": ("t;Fx [kN]\n" + "".join(
        f"{'23:59:58' if k < 20 else '00:00:00'}.{k % 20 // 2 * 100 + 50 * (k % 2):03d};{b:.3f}\n"
        for k, b in enumerate(F)), [], "past midnight 1 times"),
}  # fmt: skip

#: file, settings, part of the line
WRONG = {
    "empty": ("", [], "is empty"),
    "blanks": ("\n  \n", [], "is empty"),
    "text": ("hello\nworld\n", [], "no row with at least 2 numbers"),
    "spreadsheet": (b"PK\x03\x04" + bytes(100), [], "a spreadsheet or archive"),
    "matlab": (b"MATLAB 5.0 MAT-file", [], "a MATLAB file"),
    "compressed": (b"\x1f\x8b\x08" + bytes(30), [], "compressed"),
    "noise": (bytes(range(256)) * 4, [], "no text"),
    "damaged parquet": (b"PAR1" + bytes(30), [], "Parquet cannot be read"),
    "names only": (HEAD, [], "no row with at least 2 numbers"),
    "three values": (HEAD + "0;1\n1;2\n2;3\n", [], "3 values: no series"),
    "no time unit": ("t;Fx [kN]\n" + rows(), [], "set time.unit"),
    "no load unit": ("t [s];Fx\n" + rows(), [], "set fx.unit"),
    "unit of mass": ("t [s];Fx [kg]\n" + rows(), [], "is no unit of force"),
    "unknown unit": ("t [s];Fx [kN]\n" + rows(), ["fx.unit=blobs"], "is no unit of force"),
    "no such column": (GOOD, ["fx.column=Fy"], "no such column; did you mean Fx?"),
    "column number": (GOOD, ["fx.column=7"], "there are columns 1 to 2"),
    "no load": ("t [s];depth [m]\n" + rows(), [], "which column is a load?"),
    "no time": ("a [s];Fx [kN]\n" + rows(), [], "time: which column?"),
    "two of a name": ("t [s];Fx [kN];Fx [kN]\n" + rows(form="{:.1f}{s}{:.3f}{s}1"), [], "columns 2 and 3 have"),
    "comma for both": ("t [s],Fx [kN]\n" + comma(rows(",")), [], "2 names stand over"),
    "grouped digits unsaid": ("t [s];Fx [N]\n" + MANY, [], "digits are grouped"),
    "day or month": ("t;Fx [kN]\n" + stamps("%d/%m/%Y %H:%M:%S.%f").replace("25/11", "05/11"), [], "day or month"),
    "most values lost": ("".join(LINES[:21]) + "".join(LINES[21:]).replace(";", ";x"), [], "without a time or a value"),
    "ragged": (HEAD + "".join(r if k % 2 else r.strip() + ";9;9\n" for k, r in enumerate(LINES[1:])), [], "alternate"),
    "unknown key": (GOOD, ["fx.units=kN"], "unknown key fx.units; did you mean unit?"),
    "unknown section": (GOOD, ["sensors.unloaded=1"], "unknown key sensors; did you mean sensor?"),
    "sign": (GOOD, ["fx.sign=2"], "fx.sign = 2"),
    "scale": (GOOD, ["scale.factor=-36"], "scale.factor = -36"),
    "encoding": (GOOD, ["text.encoding=utf-99"], "'utf-99' is not known"),
    "wrong encoding": ("größer\n".encode("latin-1") + GOOD.encode(), ["text.encoding=utf-8"], "cannot be read as"),
    "zero outside": (GOOD, ['sensor.unloaded=[["50 s", "60 s"]]'], "fewer than two values from 50 s to 60 s"),
    "zero turned": (GOOD, ['sensor.unloaded=[["3 s", "1 s"]]'], "is no time; turn it round"),
    "zero without unit": (GOOD, ["sensor.unloaded=[[0, 1]]"], "needs its unit"),
    "by hand without shift": (GOOD, ["align.by=hand"], "align.shift is missing"),
    "by event without event": (GOOD, ["align.by=event"], "align.event and align.at are missing"),
}  # fmt: skip


def read(path, data, settings):
    path.write_bytes(data if isinstance(data, bytes) else data.encode("utf-8"))
    description, file = load_description(path, settings)
    return read_series(file, description)


def test_there_are_enough():
    assert len(TOLD) + len(WRONG) >= 60


@pytest.mark.parametrize("name", TOLD)
def test_a_repair_is_told_and_the_series_is_right(name, tmp_path):
    data, settings, told = TOLD[name]
    series = read(tmp_path / "x.csv", data, settings)
    assert told in "\n".join(series.told)
    t = np.round(0.05 * np.arange(40), 10) if name == "clock past midnight" else T
    if name == "clock past midnight":
        t = np.where(np.arange(40) < 20, t, t + 1.0)
    np.testing.assert_allclose(series.t, t, rtol=0, atol=1e-6)
    np.testing.assert_allclose(series.loads["fx"], 1000 * F, rtol=1e-6)


@pytest.mark.parametrize("name", WRONG)
def test_what_cannot_be_read_is_one_clear_line(name, tmp_path):
    data, settings, line = WRONG[name]
    with pytest.raises(ValueError, match=r".") as error:
        read(tmp_path / "x.csv", data, settings)
    assert isinstance(error.value, SeriesError)
    assert line in str(error.value)
    assert "x.csv" in str(error.value)
    assert "\n" not in str(error.value)
    assert len(str(error.value)) < 300


def test_two_ways_to_read_a_file_are_asked_for(tmp_path):
    """``1,5`` alone in its line is one load and a half, or two loads."""
    data = "Fx [kN]\n" + "".join(f"{k},5\n" for k in range(20))
    with pytest.raises(SeriesError, match=r"set text\.delimiter"):
        read(tmp_path / "x.csv", data, ["time.step=1 s"])
    series = read(tmp_path / "x.csv", data, ["time.step=1 s", "text.decimal=','", "text.delimiter=;"])
    np.testing.assert_allclose(series.loads["fx"], 1000.0 * (np.arange(20) + 0.5))


def test_gaps_are_told_and_bridged(tmp_path):
    series = read(tmp_path / "x.csv", HEAD + rows(t=np.where(T > 2.05, T + 7.0, T)), [])
    assert "1 gap, the longest of 7.1 s after 2 s" in "\n".join(series.told)


def test_repeated_times_give_their_mean(tmp_path):
    series = read(tmp_path / "x.csv", GOOD + "3.9;0\n", [])
    assert series.loads["fx"][-1] == pytest.approx(500.0 * F[-1], rel=1e-12)


def test_parquet_with_units_and_stamps(tmp_path):
    stamp = [ZERO + datetime.timedelta(seconds=float(a)) for a in T]
    load = pa.field("Fx", pa.float32(), metadata={"unit": "kN"})
    schema = pa.schema([pa.field("time", pa.timestamp("us")), load, pa.field("note", pa.string())])
    pq.write_table(pa.table([stamp, F, ["x"] * len(T)], schema=schema), tmp_path / "x.parquet")
    description, file = load_description(tmp_path / "x.parquet")
    series = read_series(file, description)
    np.testing.assert_allclose(series.t, T, atol=1e-6)
    np.testing.assert_allclose(series.loads["fx"], 1000 * F, rtol=1e-6)


def test_a_description_beside_the_file_is_taken(tmp_path):
    (tmp_path / "series.toml").write_text('file = "x.csv"\n[time]\nunit = "ms"\n[fx]\ncolumn = "load"\nunit = "MN"\n')
    (tmp_path / "x.csv").write_text("t;load\n" + rows(t=1000 * T, f=F / 1000, form="{:.1f}{s}{:.6f}"))
    for name in ("x.csv", "series.toml"):
        description, file = load_description(tmp_path / name)
        np.testing.assert_allclose(read_series(file, description).loads["fx"], 1000 * F, rtol=1e-6)


def test_zero_and_drift_are_taken_off_and_told(tmp_path):
    t = np.round(0.1 * np.arange(400), 10)
    load = np.where((t > 10) & (t < 30), 50.0, 0.0)
    data = HEAD + rows(t=t, f=load + 3.0 + 0.2 * t, form="{:.1f}{s}{:.6f}")
    series = read(tmp_path / "x.csv", data, ['sensor.unloaded=[["0 s", "9 s"], ["31 s", "39 s"]]'])
    np.testing.assert_allclose(series.loads["fx"], 1000 * load, atol=1e-3)
    assert "zero of 3000 N drifting to 1.098e+04 N taken off" in "\n".join(series.told)
    zero_only = read(tmp_path / "x.csv", data, ['sensor.unloaded=[["0 s", "9 s"]]'])
    assert abs(zero_only.loads["fx"][-1]) > 5000.0


def test_froude_scales_times_and_forces(tmp_path):
    series = read(tmp_path / "x.csv", GOOD, ["scale.factor=36"])
    np.testing.assert_allclose(series.t, 6.0 * T, atol=1e-9)
    np.testing.assert_allclose(series.loads["fx"], 36.0**3 * 1000 * F, rtol=1e-9)


PIECES = (b";", b",", b"\n", b'"', b"1", b" ", b"-", b"9999999999", b"NaN", b"E", b":", b"/", b".", b"\xff", b"#")


@pytest.mark.parametrize("name", TOLD)
def test_a_damaged_file_is_read_or_one_clear_line(name, tmp_path):
    """Characters written over, put in and taken out, by seed: never another error, never a warning."""
    data, settings, _ = TOLD[name]
    source, random = data if isinstance(data, bytes) else data.encode(), np.random.default_rng(len(name))
    lines = []
    for _ in range(15):
        damaged = bytearray(source)
        for k in random.integers(0, len(source) - 40, int(random.integers(1, 8))):
            piece = PIECES[int(random.integers(len(PIECES)))]
            damaged[k : k + int(random.integers(0, 3))] = piece
        try:
            series = read(tmp_path / "x.csv", bytes(damaged), settings)
        except SeriesError as error:
            lines.append(str(error))
        else:
            assert np.isfinite(series.t).all()
            assert (np.diff(series.t) > 0).all()
            assert np.isfinite(series.loads["fx"]).all()
    assert not [line for line in lines if "\n" in line or len(line) > 400]
