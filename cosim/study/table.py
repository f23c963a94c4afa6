"""The table of a sweep on disk: it holds every variant that has ended, whatever happens to the others."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from pathlib import Path
from typing import IO, Self

from cosim.errors import FailedError
from cosim.outputs import grow, rewrite, trouble
from cosim.study.sweep import COMPONENTS, RESULTS, Row


def as_csv(keys: Sequence[str], rows: Sequence[Row]) -> str:
    """One line for each variant: name, varied keys (empty: as in the base), results in SI units, ratios, error."""
    names = ["variant", *keys, *RESULTS, *(f"{c}_ratio" for c in COMPONENTS), "error"]
    text = io.StringIO(newline="")
    writer = csv.DictWriter(text, names, restval="", lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue()


class Table:
    """A file that is written anew as each variant ends. Without a path nothing is written.

    A file that takes no more does not end the sweep: its table is shown, and the file is complained of at the end.
    """

    def __init__(self, path: Path | None) -> None:
        self._path = path
        self._file: IO[bytes] | None = None
        self._trouble: FailedError | None = None

    def __enter__(self) -> Self:
        if self._path is not None:
            self._file = grow(self._path, ".csv")
        return self

    def write(self, keys: Sequence[str], rows: Sequence[Row]) -> None:
        """All rows that there are."""
        if self._file is None or self._path is None:
            return
        try:
            rewrite(self._file, as_csv(keys, rows).encode())
            self._trouble = None
        except OSError as error:
            self._trouble = trouble(self._path, error)

    def __exit__(self, kind: object, *_: object) -> None:
        if self._file is not None and self._path is not None:
            try:
                self._file.close()
            except OSError as error:
                self._trouble = self._trouble or trouble(self._path, error)
        if self._trouble is not None and kind is None:
            raise self._trouble
