"""The layout for Foxglove: as its files are made up, and about topics and fields that a recording has."""

import json
import re
from pathlib import Path

import pytest

from cosim.recording.channels import CHANNELS

LAYOUT = json.loads((Path(__file__).parents[2] / "docs/foxglove_layout.json").read_text("utf-8"))
#: panels of Foxglove by the first part of their ids, and what their configurations have to have
PANELS = {
    "3D": {"cameraState", "followMode", "scene", "topics", "transforms", "layers", "imageMode"},
    "Plot": {"paths", "showLegend", "isSynced", "xAxisVal"},
    "RosOut": {"minLogLevel", "topicToRender"},
    "RawMessages": {"topicPath"},
}


def leaves(node):
    """Panels of a tree of rows and columns; each split has two sides, a direction and a share."""
    if isinstance(node, str):
        return [node]
    assert set(node) == {"direction", "first", "second", "splitPercentage"}
    assert node["direction"] in ("row", "column")
    assert 0.0 < node["splitPercentage"] < 100.0
    return leaves(node["first"]) + leaves(node["second"])


def faults(layout):
    """What of a layout Foxglove could not show."""
    found = []
    panels = layout["configById"]
    shown = leaves(layout["layout"])
    if sorted(shown) != sorted(panels) or len(set(shown)) != len(shown):
        found.append("a panel is not in the tree, or twice")
    for name, config in panels.items():
        kind, _, own = name.partition("!")
        if not own or PANELS.get(kind, {"?"}) - set(config):
            found.append(f"{name}: not such a panel")
        paths = [p["value"] for p in config.get("paths", [])] + [
            config[k] for k in ("topicToRender", "topicPath") if k in config
        ]
        for path in [*paths, *config.get("topics", {})]:
            topic, _, field = path.partition(".")
            if topic not in CHANNELS:
                found.append(f"{name}: no topic {topic}")
            elif field and field not in CHANNELS[topic].schema.DESCRIPTOR.fields_by_name:
                found.append(f"{name}: no field {path}")
    return found


def test_the_layout_can_be_shown():
    assert {"configById", "globalVariables", "userNodes", "playbackConfig", "layout"} == set(LAYOUT)
    assert faults(LAYOUT) == []
    colours = re.findall(r'"#(\w+)"', json.dumps(LAYOUT))
    assert all(len(colour) in (6, 8) for colour in colours)


@pytest.mark.parametrize(
    ("wrong", "what"),
    [
        (lambda p: p["configById"]["Plot!fx"]["paths"][0].update(value="/load/structure.fq"), "no field"),
        (lambda p: p["configById"]["RosOut!log"].update(topicToRender="/lag"), "no topic"),
        (lambda p: p["configById"].pop("Plot!fz"), "not in the tree"),
        (lambda p: p["configById"].update({"Blot!x": {}}), "not such a panel"),
    ],
)
def test_a_layout_that_cannot_be_shown_is_found(wrong, what):
    broken = json.loads(json.dumps(LAYOUT))
    wrong(broken)
    assert any(what in fault for fault in faults(broken))
