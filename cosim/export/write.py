"""A recording as a file of another form, chosen by the ending of its name."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

from cosim.analysis.run_data import RunData
from cosim.errors import InputError
from cosim.export.flat import write_csv, write_parquet
from cosim.export.netcdf import write_netcdf
from cosim.export.openfast import write_openfast
from cosim.export.tables import TABLES
from cosim.nearest import hint
from cosim.outputs import trouble, whole, writable

#: by ending: kind of file, see `cosim.outputs.MAGIC`, and what it is
FORMS = {
    ".csv": (".table.csv", "a table, as text"),
    ".parquet": (".parquet", "a table, in columns"),
    ".nc": (".nc", "all numbers of the run, by the CF conventions"),
    ".h5": (".nc", "the same"),
    ".pvd": (".pvd", "a series for ParaView"),
    ".dat": (".dat", "a prescribed load series for OpenFAST"),
}
SERIES = ".pvd"
FLAT: dict[str, Callable[[RunData, str, Path], None]] = {".csv": write_csv, ".parquet": write_parquet}
WHOLE: dict[str, Callable[[RunData, Path], None]] = {
    ".nc": write_netcdf,
    ".h5": write_netcdf,
    ".dat": write_openfast,
}


def check(out: Path, table: str | None, recording: Path) -> Path:
    """Refuses an ending that is none of `FORMS`, a table that there is not, and a place that cannot be written."""
    form = out.suffix.lower()
    if form not in FORMS:
        known = ", ".join(f"{ending} ({about})" for ending, (_, about) in FORMS.items())
        raise InputError(f"{out}: the ending says the form; use one of {known}")
    if table is not None and form not in FLAT:
        raise InputError(f"--table belongs to {' and '.join(FLAT)}; {form} holds {FORMS[form][1]}")
    if table is not None and table not in TABLES:
        raise InputError(f"--table {table}: no such table; {hint(table, TABLES)}")
    writable(out, FORMS[form][0], [recording])
    return out


def export(run: RunData, recording: Path, out: Path, table: str | None = None) -> None:
    """Write ``out``; the form follows from its ending, see `FORMS`. Nothing is left of a file that is not whole."""
    form = check(out, table, recording).suffix.lower()
    if form == SERIES:
        _export_series(run, recording, out)
        return
    with whole(out, FORMS[form][0]) as part:
        if form in FLAT:
            FLAT[form](run, table or "loads", part)
        else:
            WHOLE[form](run, part)


def _export_series(run: RunData, recording: Path, out: Path) -> None:
    from cosim.export.vtk import folder_of, write_series
    from cosim.recording.reader import recorded_pictures, recorded_structure

    folder = folder_of(out)
    try:
        folder.mkdir()
    except FileExistsError:
        raise InputError(f"{folder}: is there already and is kept; remove it or name another file") from None
    done = False
    try:
        thickness = float(run.metadata["thickness_m"])
        with whole(out, SERIES) as part:
            write_series(recorded_pictures(recording), recorded_structure(recording), thickness, part, folder)
        done = True
    except OSError as error:
        raise trouble(folder, error) from error
    finally:
        if not done:
            shutil.rmtree(folder)
