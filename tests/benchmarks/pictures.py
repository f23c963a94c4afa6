"""Pictures of the documentation: runs the cases, draws them at five times, and the report on screen and in print.

    python tests/benchmarks/pictures.py -o docs/pictures                        # all; some minutes on one core
    python tests/benchmarks/pictures.py first_cone -o docs/pictures --keep runs   # one; keeps or takes runs there
    python tests/benchmarks/pictures.py report -o docs/pictures                 # needs chromium and pdftoppm

The last tile of a sheet is a frame of the film or the plane of Mohr's circle. What the captions say is looked at by
hand: open what it wrote.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path

from matplotlib.figure import Figure
from PIL import Image

from cosim.cli import main as cosim
from cosim.recording.reader import recorded_stresses
from cosim.show.mohr import draw_mohr

TILE, GAP = (760, 428), 8  #: [pixel]
FIRST = ("first_cone", ())
FLOE = ("basin_2010_floe_165m", ("sheet.nodes=[30,30]", "scenario.duration='22 s'"))
PLANE = ("upward_plane", ("scenario.duration='30 s'",))
#: picture: case, changes, times [s], time of the frame of the film [s], None: the plane of Mohr's circle
SHEETS = {
    "first_cone": (*FIRST, (0.4, 3.8, 10.5, 16.3, 18.0), 10.8),
    "basin_floe_165m": (*FLOE, (0.5, 5.5, 9.7, 13.6, 19.0), None),
    "upward_plane": (*PLANE, (0.9, 6.3, 12.5, 25.0, 28.9), None),
}
REPORT = "report"
SCREEN = (1000, 1340)  #: of the head of the report [pixel]
PAGES = 4


def called(*words: str | Path) -> None:
    """A command of the program, in this process; SystemExit if it fails."""
    with contextlib.redirect_stdout(io.StringIO()):
        try:
            cosim([str(word) for word in words])
        except SystemExit as end:
            if end.code:
                raise


def recorded(case: str, changes: tuple[str, ...], folder: Path) -> Path:
    """The recording of a case in a folder, run if it is not there."""
    out = folder / f"{case}.mcap"
    if not out.exists():
        called("run", case, "-q", "-o", out, *(word for change in changes for word in ("--set", change)))
    return out


def stills(run: Path, times: tuple[float, ...], folder: Path) -> Iterator[Image.Image]:
    """As `cosim replay --screenshot --at` draws them."""
    for t in times:
        called("replay", run, "--screenshot", folder / "still.png", "--at", f"{t:g}")
        yield Image.open(folder / "still.png").convert("RGB").resize(TILE, Image.Resampling.LANCZOS)


def film_frame(run: Path, t: float, folder: Path) -> Image.Image:
    """The frame of `cosim replay --video` whose share of the film is that of the time in the run."""
    import imageio_ffmpeg

    called("replay", run, "--video", folder / "film.mp4")
    reader = imageio_ffmpeg.read_frames(str(folder / "film.mp4"))
    size = next(reader)["size"]
    frames = list(reader)
    end = float(_end(run))
    chosen = frames[min(round(t / end * (len(frames) - 1)), len(frames) - 1)]
    return Image.frombytes("RGB", size, chosen).resize(TILE, Image.Resampling.LANCZOS)


def _end(run: Path) -> float:
    from cosim.show.opening import opened

    return float(opened(run).t[-1])


def mohr(run: Path, folder: Path) -> Image.Image:
    """The cells of a run in the plane of Mohr's circle, as in its report."""
    figure = Figure(figsize=(9.5, 5.35), dpi=160, layout="constrained")
    draw_mohr(figure, *recorded_stresses(run))
    figure.savefig(folder / "mohr.png")
    return Image.open(folder / "mohr.png").convert("RGB").resize(TILE, Image.Resampling.LANCZOS)


def sheet(name: str, runs: Path, folder: Path) -> Image.Image:
    """Six tiles, two beside each other."""
    case, changes, times, film = SHEETS[name]
    run = recorded(case, changes, runs)
    tiles = [*stills(run, times, folder), mohr(run, folder) if film is None else film_frame(run, film, folder)]
    width, height = TILE
    whole = Image.new("RGB", (2 * width + GAP, 3 * height + 2 * GAP), "white")
    for k, tile in enumerate(tiles):
        whole.paste(tile, ((k % 2) * (width + GAP), (k // 2) * (height + GAP)))
    return whole


def report(runs: Path, folder: Path) -> Image.Image:
    """Its head on screen, and its first pages in print."""
    page, width = folder / "report.html", SCREEN[0]
    called("report", recorded(*FIRST, runs), "-o", page)
    _browser(page, "--hide-scrollbars", f"--window-size={width},{SCREEN[1]}", f"--screenshot={folder / 'screen.png'}")
    _browser(page, "--no-pdf-header-footer", f"--print-to-pdf={folder / 'print.pdf'}")
    print_ = ["pdftoppm", "-r", "70", "-l", str(PAGES), "-png", str(folder / "print.pdf"), str(folder / "page")]
    subprocess.run(print_, check=True)
    screen = Image.open(folder / "screen.png").convert("RGB")
    pages = [Image.open(file).convert("RGB") for file in sorted(folder.glob("page-*.png"))]
    height = 920
    left = screen.resize((round(width * height / SCREEN[1]), height), Image.Resampling.LANCZOS)
    half = (height - GAP) // 2
    small = [p.resize((round(p.width * half / p.height), half), Image.Resampling.LANCZOS) for p in pages]
    whole = Image.new("RGB", (left.width + 2 * (GAP + small[0].width), height), "#959da6")
    whole.paste(left, (0, 0))
    for k, part in enumerate(small):
        whole.paste(part, (left.width + GAP + (k % 2) * (part.width + GAP), (k // 2) * (half + GAP)))
    return whole


def _browser(page: Path, *words: str) -> None:
    """Chromium without a window on a page."""
    name = shutil.which("chromium") or shutil.which("google-chrome")
    if name is None:
        raise SystemExit("pictures of the report need chromium; install it, or name the other pictures")
    common = ["--headless", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=20000"]
    subprocess.run([name, *common, *words, page.resolve().as_uri()], check=True, capture_output=True)


def main() -> None:
    """Writes a picture for each name."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", choices=[[], *SHEETS, REPORT])
    parser.add_argument("-o", "--out", type=Path, required=True)
    parser.add_argument("--keep", type=Path, help="folder of the recordings; those that are there are not run again")
    asked = parser.parse_args()
    asked.out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        runs = asked.keep or folder
        runs.mkdir(parents=True, exist_ok=True)
        for picture in asked.names or [*SHEETS, REPORT]:
            image = report(runs, folder) if picture == REPORT else sheet(picture, runs, folder)
            image.save(asked.out / f"{picture}.jpg", quality=82, optimize=True)
            print(asked.out / f"{picture}.jpg", image.size, flush=True)


if __name__ == "__main__":
    main()
