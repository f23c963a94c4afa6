"""The table of a sweep as Parquet, with its journal: written while it runs, and gone on with after it was broken off.

Each row that ends is one line of JSON in the journal ``.NAME.rows`` beside the table. What the table is made of stands
in its metadata under ``cosim.study``: another base, program or design is not mixed in.
"""

from __future__ import annotations

import json
import time
from collections.abc import Sequence
from pathlib import Path
from typing import IO, Any, Self

import pyarrow as pa
import pyarrow.parquet as pq

from cosim.errors import FailedError, InputError
from cosim.outputs import MAGIC, append, resolved, trouble, whole
from cosim.study.task import FEATURE, RESULTS, Row
from cosim.study.variants import Variant, si_value

KIND, JOURNAL = ".parquet", ".rows"
META = b"cosim.study"
#: the table is written anew at most so often [s], and for at most this share of the time
EVERY, SHARE = 2.0, 0.02
TEXTS = ("not_trustworthy",)
WHOLE = ("fragments", "blocks")


def schema(variants: Sequence[Variant], keys: Sequence[str], features: Sequence[str], about: dict[str, Any]) -> Any:
    """Columns: which variant, varied keys (numbers [SI] where all values are, else as written), results, error."""
    text, number = pa.string(), pa.float64()
    changes = [dict(v.changes) for v in variants]
    numeric = {key: all(si_value(key, change[key]) is not None for change in changes if key in change) for key in keys}
    kinds = {name: text if name in TEXTS else pa.int64() if name in WHOLE else number for name in RESULTS}
    fields = [
        pa.field("number", pa.int64()),
        *(pa.field(name, text) for name in ("variant", "group")),
        pa.field("seed", pa.int64()),
        *(pa.field(key, number if numeric[key] else text) for key in keys),
        *(pa.field(name, kind) for name, kind in kinds.items()),
        *(pa.field(FEATURE + name, number) for name in features),
        pa.field("error", text),
    ]
    return pa.schema(fields, metadata={META: json.dumps(about)})


class ParquetTable:
    """The table of the study that ``about`` tells: names of the base, of the program and of the design."""

    def __init__(
        self,
        path: Path,
        variants: Sequence[Variant],
        keys: Sequence[str],
        features: Sequence[str],
        about: dict[str, Any],
    ):
        self._path, self._variants, self._about = path, variants, about
        self._schema = schema(variants, keys, features, about)
        self._rows: dict[int, Row] = {}
        self._journal: IO[bytes] | None = None
        self._due = 0.0
        self._trouble: FailedError | None = None

    @property
    def journal(self) -> Path:
        """The file beside the table."""
        target = resolved(self._path)
        return target.with_name(f".{target.name}{JOURNAL}")

    def __enter__(self) -> Self:
        self._journal = append(self.journal, JOURNAL)
        return self

    def begin(self, known: dict[int, Row]) -> None:
        """As `Table.begin`."""
        self._rows = dict(known)
        self._write()

    def add(self, row: Row) -> None:
        """As `Table.add`."""
        self._rows[row["number"]] = dict(row)
        try:
            if self._journal is not None:
                self._journal.write(json.dumps(row).encode() + b"\n")
            if time.monotonic() >= self._due:
                self._write()
            self._trouble = None
        except OSError as error:
            self._trouble = trouble(self._path, error)
        except FailedError as error:
            self._trouble = error

    def _write(self) -> None:
        """The table of all rows; the journal begins anew."""
        began = time.monotonic()
        rows = [self._typed(self._rows[k]) for k in sorted(self._rows)]
        with whole(self._path, KIND) as part:
            pq.write_table(pa.Table.from_pylist(rows, self._schema), part)
        if self._journal is not None:
            self._journal.seek(0)
            self._journal.truncate()
            self._journal.write(MAGIC[JOURNAL] + b"\n" + json.dumps(self._about).encode() + b"\n")
        now = time.monotonic()
        self._due = now + max(EVERY, (now - began) / SHARE)

    def _typed(self, row: Row) -> Row:
        """Texts of keys as numbers where their column holds numbers."""
        typed = {**row, "seed": None if row["seed"] is None else int(row["seed"])}
        for field in self._schema:
            value = typed.get(field.name)
            if field.type == pa.float64() and isinstance(value, str):
                typed[field.name] = si_value(field.name, value)
        return typed

    def __exit__(self, kind: object, *_: object) -> None:
        try:
            self._write()
            self._trouble = None
            self.journal.unlink(missing_ok=True)
        except FailedError as error:
            self._trouble = error
        finally:
            if self._journal is not None:
                self._journal.close()
        if self._trouble is not None and kind is None:
            raise self._trouble


def known_rows(path: Path, variants: Sequence[Variant], about: dict[str, Any]) -> dict[int, Row]:
    """Rows without an error of an earlier sweep of this study, by the number that they have now; none without a file.

    InputError where the file is of another base, program or design.
    """
    places = {variant.name: k for k, variant in enumerate(variants)}
    keys = {key for variant in variants for key, _ in variant.changes}
    found: dict[int, Row] = {}
    for row in _stored(path, about):
        if row["variant"] not in places:
            raise InputError(
                f"{path}: holds the variant {row['variant']}, which this sweep does not have; name another file"
            )
        k = places[row["variant"]]
        if row["error"] is None:
            results = {name: value for name, value in row.items() if name not in keys}
            found[k] = {**results, **dict(variants[k].changes), "number": k, "seed": variants[k].seed}
    return found


def _stored(path: Path, about: dict[str, Any]) -> list[Row]:
    """Rows of the table, then those of its journal."""
    rows: list[Row] = []
    target = resolved(path)
    if target.exists():
        try:
            table = pq.read_table(target)
        except (pa.ArrowException, OSError) as error:
            raise InputError(f"{path}: is no table of a sweep ({error}); name another file") from None
        _same(path, json.loads((table.schema.metadata or {}).get(META, b"{}")), about)
        rows += table.to_pylist()
    journal = target.with_name(f".{target.name}{JOURNAL}")
    if journal.exists():
        told = journal.read_bytes().split(b"\n")[1:-1]  # the last line may be cut
        for head in told[:1]:
            _same(journal, json.loads(head), about)
        rows += [json.loads(line) for line in told[1:]]
    return rows


def _same(path: Path, theirs: dict[str, Any], ours: dict[str, Any]) -> None:
    for name, value in ours.items():
        if theirs.get(name) != value:
            raise InputError(
                f"{path}: was made with another {name} ({theirs.get(name)}, now {value}); name another file"
            )
