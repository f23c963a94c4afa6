"""A terminal to which texts go as they are: no markup in them, and no escape sequence but the terminal's own."""

from __future__ import annotations

from collections.abc import Iterable

from rich.console import Console, ConsoleOptions, RenderableType
from rich.segment import Segment

from cosim.plain import plain


class Terminal(Console):
    """`rich.console.Console` for texts that others have written: scenarios, recordings, command lines."""

    def __init__(self, *, stderr: bool = False, width: int | None = None) -> None:
        super().__init__(stderr=stderr, width=width, markup=False, emoji=False)

    def render(self, renderable: RenderableType, options: ConsoleOptions | None = None) -> Iterable[Segment]:
        """Segments of whatever is printed; their texts command nothing."""
        for segment in super().render(renderable, options):
            yield segment if segment.control else Segment(plain(segment.text), segment.style)

    def on_broken_pipe(self) -> None:
        """Who reads has gone: an error like any other."""
        self.quiet = True
        raise BrokenPipeError(32, "closed by its reader")
