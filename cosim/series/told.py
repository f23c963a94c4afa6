"""What is told about a series: every repair and every choice that its file left open, in order."""

from __future__ import annotations

from dataclasses import dataclass, field

from cosim.errors import InputError


class SeriesError(InputError):
    """A series that cannot be used; the message is one line with its remedy."""


def count(n: int, what: str) -> str:
    """So many of something."""
    return f"{n} {what}" if n == 1 else f"{n} {what}s"


@dataclass
class Told:
    """Lines about a file, and its name for errors."""

    name: str  #: of the file
    lines: list[str] = field(default_factory=list)

    def say(self, text: str) -> None:
        """One more line."""
        self.lines.append(text)

    def wrong(self, text: str) -> SeriesError:
        """An error that names the file."""
        return SeriesError(f"{self.name}: {text}")
