"""The table of a sweep on disk: it holds every variant that has ended, whatever happens to the others.

CSV is written anew as each variant ends. Parquet is made for many variants: each row goes at once to a journal beside
the table, of which the table itself is made every few seconds and at the end, whole or not at all; so a sweep that was
broken off, however, goes on where it was.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from pathlib import Path
from typing import IO, Protocol, Self

from cosim.errors import FailedError
from cosim.outputs import grow, rewrite, trouble
from cosim.study.sweep import with_ratios
from cosim.study.task import COMPONENTS, RESULTS, Row, columns


class Table(Protocol):
    """What rows are written to."""

    def __enter__(self) -> Self:
        """Takes the file."""

    def begin(self, known: dict[int, Row]) -> None:
        """Rows that are there already, by number."""

    def add(self, row: Row) -> None:
        """A variant that has ended."""

    def __exit__(self, kind: object, *_: object) -> None:
        """Brings the file to its end."""


def as_csv(keys: Sequence[str], rows: Sequence[Row]) -> str:
    """One line for each variant: name, varied keys (empty: as in the base), results in SI units, ratios, error."""
    names = ["variant", *keys, *RESULTS, *columns(rows), *(f"{c}_ratio" for c in COMPONENTS), "error"]
    text = io.StringIO(newline="")
    writer = csv.DictWriter(text, names, restval="", lineterminator="\n", extrasaction="ignore")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue()


class NoTable:
    """Nothing is written."""

    def __enter__(self) -> Self:
        return self

    def begin(self, known: dict[int, Row]) -> None:
        """Nothing."""

    def add(self, row: Row) -> None:
        """Nothing."""

    def __exit__(self, kind: object, *_: object) -> None:
        """Nothing."""


class CsvTable:
    """A file that is written anew as each variant ends.

    A file that takes no more does not end the sweep: its table is shown, and the file is complained of at the end.
    """

    def __init__(self, path: Path, keys: Sequence[str]) -> None:
        self._path, self._keys = path, keys
        self._rows: dict[int, Row] = {}
        self._file: IO[bytes] | None = None
        self._trouble: FailedError | None = None

    def __enter__(self) -> Self:
        self._file = grow(self._path, ".csv")
        return self

    def begin(self, known: dict[int, Row]) -> None:
        """As `Table.begin`."""
        self._rows = dict(known)

    def add(self, row: Row) -> None:
        """As `Table.add`."""
        self._rows[row["number"]] = dict(row)
        if self._file is None:
            return
        try:
            ended = with_ratios([self._rows[k] for k in sorted(self._rows)])
            rewrite(self._file, as_csv(self._keys, ended).encode())
            self._trouble = None
        except OSError as error:
            self._trouble = trouble(self._path, error)

    def __exit__(self, kind: object, *_: object) -> None:
        if self._file is not None:
            try:
                self._file.close()
            except OSError as error:
                self._trouble = self._trouble or trouble(self._path, error)
        if self._trouble is not None and kind is None:
            raise self._trouble
