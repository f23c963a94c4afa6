"""Foreign recordings: sound as files, wrong in what they say. Each is one clear line, or is shown as it is."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import mcap.writer
import pytest
from foxglove_schemas_protobuf.PointCloud_pb2 import PointCloud
from mcap.records import Attachment, Channel, Message, Metadata, Schema

from cosim.recording import messages, metadata
from cosim.recording.reader import read_run
from cosim.recording.records import Records

ESCAPE = "\x1b]0;owned\x07\x1b[2J\u202e[/x]<b>&"
SHOWN = "\\x1b]0;owned\\x07\\x1b[2J\\u202e[/x]<b>&"


def rewritten(source, target, change, **options):
    """A recording with every record through ``change(record)``, which gives a list; all checksums right."""
    with target.open("wb") as file:
        writer = mcap.writer.Writer(file, enable_data_crcs=True, **options)
        writer.start(library="other")
        for record in Records(source):
            for r in change(record):
                if isinstance(r, Attachment):
                    writer.add_attachment(r.create_time, r.log_time, r.name, r.media_type, r.data)
                elif isinstance(r, Metadata):
                    writer.add_metadata(r.name, r.metadata)
                elif isinstance(r, Schema):
                    writer.register_schema(r.name, r.encoding, r.data)
                elif isinstance(r, Channel):
                    writer.register_channel(r.topic, r.message_encoding, r.schema_id, r.metadata)
                elif isinstance(r, Message):
                    writer.add_message(r.channel_id, r.log_time, r.data, r.publish_time, r.sequence)
        writer.finish()
    return target


class Loads:
    """Changes the message of ``/load/structure`` of one number; others stay."""

    def __init__(self, number, change):
        self.number, self.change, self.channel = number, change, None

    def __call__(self, record):
        if isinstance(record, Channel) and record.topic == "/load/structure":
            self.channel = record.id
        if isinstance(record, Message) and (record.channel_id, record.sequence) == (self.channel, self.number):
            return self.change(record)
        return [record]


def at(**values):
    def change(record):
        vars(record).update(values)
        return [record]

    return change


def not_finite(record):
    load = messages.Load.FromString(record.data)
    load.breaking_fx = float("nan")
    record.data = load.SerializeToString()
    return [record]


def meta(**values):
    def change(record):
        if isinstance(record, Metadata) and record.name == "run":
            bare = {key: value for key, value in record.metadata.items() if key != metadata.SEAL}
            record.metadata = metadata.sealed({k: v for k, v in {**bare, **values}.items() if v is not None})
        return [record]

    return change


def as_json(record):
    if isinstance(record, Channel) and record.topic == "/load/structure":
        record.message_encoding = "json"
    return [record]


def other_schema(record):
    if isinstance(record, Schema) and record.name == "cosim.Load":
        record.name = "cosim.Unload"
    return [record]


def attachment(**values):
    def change(record):
        if isinstance(record, Attachment) and record.name == "reference.toml":
            vars(record).update(values)
        return [record]

    return change


def without(kind, name):
    return lambda record: [] if isinstance(record, kind) and record.name == name else [record]


def twice(record):
    return [record, record] if isinstance(record, Metadata) and record.name == "run" else [record]


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (Loads(5, lambda r: [r, r]), "message 6 of /load/structure is missing, double or out of order (there is 5)"),
        (Loads(5, lambda r: []), "message 5 of /load/structure is missing, double or out of order (there is 6)"),
        (Loads(5, at(sequence=7)), "message 5 of /load/structure is missing, double"),
        (Loads(5, at(log_time=10**8)), "a window at 0.1 s after 4 others of a run of 12 s"),
        (Loads(5, at(log_time=2**64 - 1)), "a window at 1.84467e+10 s after 4 others of a run of 12 s"),
        (Loads(5, not_finite), "the load at 0.25 s is not finite"),
        (Loads(5, at(data=b"\xff\xff")), "Error parsing message"),
        (as_json, "/load/structure holds cosim.Load as json, not cosim.Load as protobuf"),
        (other_schema, "/load/structure holds cosim.Unload as protobuf, not cosim.Load"),
        (attachment(data=b"\xff\xfe\x00"), "reference.toml in it is no text"),
        (attachment(name="else.toml"), "reference.toml in it is missing"),
        (without(Metadata, "run"), "not a recording of cosim"),
        (twice, "its metadata stand there twice"),
        (meta(format="1"), "format 1 of version 0.1.0, this version reads 3; use that version, or run"),
        (meta(format=None), "format None"),
        (meta(duration_ns="soon"), "metadata duration_ns = 'soon' cannot be"),
        (meta(nodes="[40]"), "metadata nodes = '[40]' cannot be"),
        (meta(seed="-1"), "metadata seed = '-1' cannot be"),
        (meta(spacing_m="nan"), "metadata spacing_m = 'nan' cannot be"),
        (meta(title=None), "metadata title = None cannot be"),
        (meta(seed=f"1{ESCAPE}"), "metadata seed = "),
    ],
    ids=lambda value: value[:40] if isinstance(value, str) else "",
)
def test_what_cannot_be_is_one_line(cosim, run_file, tmp_path, change, says):
    path = rewritten(run_file, tmp_path / "x.mcap", change)
    before = path.read_bytes()
    for command in (("info", path), ("compare", path, "--json"), ("report", path, "-o", tmp_path / "r.html")):
        code, out, err = cosim(*command)
        assert (code, out, err.count("\n")) == (2, "", 1), err
        assert says in err
        assert "\x1b" not in err
    assert path.read_bytes() == before
    assert not (tmp_path / "r.html").exists()


def spoiled(content):
    """The pictures of the nodes hold something else."""

    def change(record):
        if isinstance(record, Channel) and record.topic == "/ice/sheet":
            spoiled.channel = record.id
        if isinstance(record, Message) and record.channel_id == spoiled.channel:
            record.data = content
        return [record]

    return change


@pytest.mark.parametrize("content", [b"\xff\xff", PointCloud(data=b"12345").SerializeToString()])
def test_a_picture_that_is_none_is_one_line(cosim, run_file, tmp_path, content):
    spoiled.channel = None
    path = rewritten(run_file, tmp_path / "x.mcap", spoiled(content))
    code, out, err = cosim("replay", path, "--save", tmp_path / "x.rrd")
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert "a picture in it cannot be read" in err
    assert list(tmp_path.glob("*.rrd")) + list(tmp_path.glob(".*")) == []


def test_an_attachment_that_is_no_text_of_ours_is_passed_over(cosim, run_file, tmp_path):
    def change(record):
        more = Attachment(0, 0, "photo.png", "image/png", b"\x89PNG\xff")
        return [more, record] if isinstance(record, Metadata) and record.name == "run" else [record]

    path = rewritten(run_file, tmp_path / "x.mcap", change)
    assert cosim("info", path)[0] == 0
    assert read_run(path).texts == read_run(run_file).texts


def hostile(record):
    """Everything that is text holds an escape sequence, markup of the terminal and of pages."""
    if isinstance(record, Message) and record.channel_id == hostile.events:
        event = messages.Event.FromString(record.data)
        event.kind, event.text, event.cause = ESCAPE, ESCAPE, ESCAPE
        record.data = event.SerializeToString()
    if isinstance(record, Channel) and record.topic == "/events":
        hostile.events = record.id
    if isinstance(record, Attachment) and record.name == "reference.toml" and hostile.reference:
        name = json.dumps(ESCAPE)
        text = record.data.decode().split("[[feature]]")[1].replace('name = "', f"name = {name} #", 1)
        record.data = f"title = {name}\n[[feature]]{text}".encode()
    return meta(title=ESCAPE, scenario=ESCAPE, overrides=json.dumps([ESCAPE]), version=ESCAPE)(record)


def test_no_text_of_a_recording_commands_the_terminal_or_a_page(cosim, run_file, tmp_path):
    hostile.events, hostile.reference = None, True
    path = rewritten(run_file, tmp_path / "x.mcap", hostile)
    code, out, err = cosim("compare", path)
    assert (code, out, err.count("\n"), "one line of plain text" in err) == (2, "", 1, True)
    assert "\x1b" not in err
    hostile.reference = False
    path = rewritten(run_file, tmp_path / "y.mcap", hostile)
    for command in (("info", path), ("info", path, "--events"), ("compare", path)):
        code, out, err = cosim(*command)
        assert (code, err) == (0, "")
        assert "\x1b" not in out
        assert "\u202e" not in out
        assert command[0] == "compare" or SHOWN in out.replace("\n", "")
    assert cosim("report", path, "-o", tmp_path / "r.html")[0] == 0
    page = (tmp_path / "r.html").read_text("utf-8")
    assert "[/x]&lt;b&gt;&amp;" in page
    assert "<b>&" not in page
    assert cosim("replay", path, "--save", tmp_path / "r.rrd")[0] == 0


def test_escape_sequences_of_the_command_line_are_written_out(cosim):
    for command in (("run", ESCAPE), ("info", f"/{ESCAPE}.mcap"), (ESCAPE,), ("run", "x", f"--{ESCAPE}")):
        code, out, err = cosim(*command)
        assert (code, out, err.count("\n")) == (2, "", 1)
        assert "\x1b" not in err


BOMB = """
import resource, sys
from cosim.cli import main
resource.setrlimit(resource.RLIMIT_AS, (6 * 2**30, 6 * 2**30))
try:
    main(["info", sys.argv[1]])
finally:
    print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024)
"""


def memory(path):
    """Exit code, error and largest memory [MiB] of reading a file."""
    done = subprocess.run([sys.executable, "-c", BOMB, path], capture_output=True, text=True, timeout=120)
    return done.returncode, done.stderr, int(done.stdout.splitlines()[-1])


def test_a_small_file_cannot_take_much_memory(run_file, tmp_path):
    def change(record):
        if isinstance(record, Message) and record.sequence == 1:
            record.data = bytes(2**27)
        return [record]

    path = rewritten(run_file, tmp_path / "x.mcap", change)
    assert path.stat().st_size < 3 * run_file.stat().st_size
    _, _, plain = memory(run_file)
    code, err, bomb = memory(path)
    assert (code, err.count("\n")) == (2, 1)
    assert "no recording does so" in err
    assert bomb < plain + 60


def test_a_length_that_is_a_lie_takes_no_memory(run_file, tmp_path):
    data = bytearray(run_file.read_bytes())
    data[9:17] = (2**40).to_bytes(8, "little")  # of the first record
    (tmp_path / "x.mcap").write_bytes(data)
    code, err, most = memory(tmp_path / "x.mcap")
    assert (code, "damaged: a record ends behind the file" in err) == (2, True)
    assert most < memory(run_file)[2] + 50


def listening():
    """Addresses and ports that something listens at, from /proc."""
    found = set()
    for name in ("tcp", "tcp6"):
        for line in Path(f"/proc/net/{name}").read_text().splitlines()[1:]:
            address, state = line.split()[1], line.split()[3]
            if state == "0A":
                found.add(tuple(address.split(":")))
    return found


@pytest.mark.skipif(not Path("/proc/net/tcp").exists(), reason="needs /proc")
def test_the_web_viewer_listens_on_this_machine_only(run_file):
    before = listening()
    process = subprocess.Popen(
        [sys.executable, "-m", "cosim", "replay", str(run_file), "--web"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "BROWSER": "true", "PYTHONUNBUFFERED": "1"},
    )
    try:
        page = process.stdout.readline()
        port = int(re.match(r"http://127\.0\.0\.1:(\d+)/", page)[1])
        ours = {(address, int(p, 16)) for address, p in listening() - before}
        assert port in {p for _, p in ours}
        assert {address for address, p in ours if p == port or f"A{p}%2F" in page} == {"0100007F"}
    finally:
        process.terminate()
        _, err = process.communicate(timeout=20)
    assert (process.returncode, err) == (143, "cosim: stopped by SIGTERM\n")
    assert not {p for _, p in listening() - before} & {format(port, "04X")}
