"""The table of the campaign: each feature of each case beside what was measured and what others computed.

``ratio`` is that of `cosim.analysis.compare`, simulated over reference, of the median over the runs; ``ratio_p05`` and
``ratio_p95`` are those of the 5 and 95 % quantiles. A case without a run is in the table as not run.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from cosim.analysis.compare import ratio
from cosim.analysis.reference import Feature
from cosim.evidence.campaign import Planned
from cosim.outputs import whole, writable
from cosim.show.cells import number
from cosim.show.scale import scale_of
from cosim.study.cluster import program
from cosim.study.statistics import distribution
from cosim.study.task import FEATURE, Row

HEAD = ("case", "feature", "simulated", "runs", "measured", "ratio", "formula or thesis", "ratio", "trust")
NOT_RUN = "not run"
ENDS = {"": "median", "_p05": "p05", "_p95": "p95"}  #: end of the name of a ratio, and what it is the ratio of
#: columns of the Parquet table that hold texts; all others hold numbers
TEXTS = ("case", "scenario", "command", "feature", "unit", "source")


def content_of(cases: Sequence[Planned], rows: Mapping[str, Sequence[Row]], folder: Path) -> dict[str, Any]:
    """The whole table as one object, what ``--json`` prints."""
    return {"evidence": program(), "cases": [_case(the, rows.get(the.case.name, ()), folder) for the in cases]}


def _case(the: Planned, rows: Sequence[Row], folder: Path) -> dict[str, Any]:
    ran = [row for row in rows if row["error"] is None]
    return {
        "name": the.case.name,
        "scenario": the.case.scenario,
        "overrides": list(the.case.overrides),
        "claim": the.case.claim,
        "command": the.case.command(folder),
        "runs": len(ran),
        "wanted": len(the.plan.variants),
        "errors": [row["error"] for row in rows if row["error"] is not None],
        "not_trustworthy": [text for row in ran if (text := row["not_trustworthy"])],
        "simulated_s": max((row["simulated_s"] for row in ran), default=None),
        "wall_s": sum(row["wall_s"] for row in ran),
        "features": [_feature(f, [row.get(FEATURE + f.name) for row in ran]) for f in the.features],
    }


def _feature(f: Feature, values: Sequence[float | None]) -> dict[str, Any]:
    found = distribution([v if v is not None and math.isfinite(v) else None for v in values])
    row: dict[str, Any] = {"name": f.name, "unit": f.unit, "source": f.source, "n": found["n"]}
    row |= {name: found.get(name) for name in ("p05", "median", "p95")}
    for kind, value in (("measured", f.measured), ("thesis", f.thesis)):
        row[kind] = None if value is None else list(value)
        row |= {f"{kind}_ratio{end}": ratio(row[name], value) for end, name in ENDS.items()}
    return row


def markdown(content: dict[str, Any]) -> str:
    """The table for people."""
    lines = [f"# Evidence of brash {content['evidence']}", ""]
    lines += ["| " + " | ".join(HEAD) + " |", "|" + "---|" * len(HEAD)]
    for case in content["cases"]:
        lines += ["| " + " | ".join(cell.replace("|", "/") for cell in row) + " |" for row in cells(case)]
    lines += ["", "| case | claim | command |", "|---|---|---|"]
    lines += [f"| {c['name']} | {c['claim'].replace('|', '/')} | `{c['command']}` |" for c in content["cases"]]
    return "\n".join(lines) + "\n"


def cells(case: dict[str, Any]) -> list[tuple[str, ...]]:
    """Lines of a case, under `HEAD`."""
    runs = f"{case['runs']} of {case['wanted']}"
    if not case["runs"]:
        why = f"failed: {case['errors'][0]}" if case["errors"] else NOT_RUN
        return [(case["name"], "-", why, runs, "-", "-", "-", "-", "-")]
    trust = "doubtful" if case["not_trustworthy"] else "good"
    return [_cells(case["name"], runs, trust, f) for f in case["features"]] or [
        (case["name"], "-", "no feature", runs, "-", "-", "-", "-", trust)
    ]


def _cells(name: str, runs: str, trust: str, f: dict[str, Any]) -> tuple[str, ...]:
    values = [*(f["measured"] or ()), *(f["thesis"] or ()), f["median"]]
    scale = scale_of(values, f["unit"])
    spread = "" if f["n"] < 2 else f" ({scale.text(f['p05'])} to {scale.text(f['p95'])})"
    simulated = "none" if f["median"] is None else f"{scale.text(f['median'])}{spread} {scale.unit}"
    beside = []
    for kind in ("measured", "thesis"):
        ends = f[kind]
        text = "-" if ends is None else " to ".join(dict.fromkeys(scale.text(x) for x in ends)) + f" {scale.unit}"
        beside += [text, number(f[f"{kind}_ratio"], 1.0)]
    return name, f["name"], simulated, runs, *beside, trust


def write(content: dict[str, Any], folder: Path) -> list[Path]:
    """``evidence.md``, ``evidence.json`` and ``evidence.parquet``, each whole or not at all."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    files = [folder / f"evidence{kind}" for kind in (".md", ".json", ".parquet")]
    for file in files:
        writable(file, file.suffix, force=True)
    with whole(files[0], ".md") as part:
        part.write_text(markdown(content), encoding="utf-8")
    with whole(files[1], ".json") as part:
        part.write_text(json.dumps(content, indent=2, allow_nan=False) + "\n", encoding="utf-8")
    lines = [_flat(case, f) for case in content["cases"] for f in case["features"]]
    numbers = [name for name in _flat({}, {}) if name not in TEXTS]
    fields = [pa.field(name, pa.string() if name in TEXTS else pa.float64()) for name in (*TEXTS, *numbers)]
    with whole(files[2], ".parquet") as part:
        pq.write_table(pa.Table.from_pylist(lines, pa.schema(fields)), part)
    return files


def _flat(case: dict[str, Any], f: dict[str, Any]) -> dict[str, Any]:
    """A feature as one line of numbers and texts; ranges by their ends."""
    flat = {"case": case.get("name"), "scenario": case.get("scenario"), "command": case.get("command")}
    flat |= {"feature": f.get("name"), "unit": f.get("unit"), "source": f.get("source"), "n": f.get("n")}
    flat |= {name: f.get(name) for name in ENDS.values()}
    for kind in ("measured", "thesis"):
        low, high = f.get(kind) or (None, None)
        flat |= {f"{kind}_low": low, f"{kind}_high": high}
        flat |= {f"{kind}_ratio{end}": f.get(f"{kind}_ratio{end}") for end in ENDS}
    return flat
