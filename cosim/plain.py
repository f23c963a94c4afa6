"""Text from outside as it may be shown: no character of it commands the terminal."""

from __future__ import annotations

import unicodedata

KEPT = "\n\t"
COMMANDS = ("Cc", "Cs", "Zl", "Zp")  #: categories of Unicode: control characters, halves of pairs, line separators
#: they turn the direction of writing, so that a line reads as something else
TURNS = frozenset("\u200e\u200f\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069\ufeff")


def plain(text: str, kept: str = KEPT) -> str:
    r"""The same text with what would command a terminal written out, ``\x1b`` for an escape; ``kept`` stays."""
    if text.isascii() and text.isprintable():
        return text
    return "".join(_shown(c, kept) for c in text)


def _shown(c: str, kept: str) -> str:
    if c in kept or not (c in TURNS or unicodedata.category(c) in COMMANDS):
        return c
    return c.encode("unicode_escape").decode("ascii") if not "\ud800" <= c <= "\udfff" else f"\\u{ord(c):04x}"


def one_line(text: str) -> str:
    """The same in one line."""
    return " ".join(plain(text).split())
