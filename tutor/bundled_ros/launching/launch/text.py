r"""Parser of texts with substitutions, such as `$(var topic)/raw` or `$(eval '$(var a) + 1')`.

An argument is a word or a text in single or double quotes, and may contain substitutions itself. A backslash escapes
the character that follows it.
"""

from __future__ import annotations

import re
import shlex
from collections.abc import Callable, Sequence
from typing import Any, NoReturn

from tutor.bundled_ros.launching.launch.base import Substitution
from tutor.bundled_ros.launching.launch.values import TextSubstitution

Argument = list[Substitution]


SUBSTITUTIONS: dict[str, tuple[int, int, Callable[..., Any]]] = {}
"""For each name, the minimum and maximum number of arguments and the factory of the substitution.

The modules that define the substitutions fill it.
"""


def make_substitution(name: str, arguments: Sequence[Argument]) -> Substitution:
    """Build the substitution `$(name arguments...)`.

    Raises RuntimeError for an unknown name, TypeError for a wrong number of arguments.
    """
    if name not in SUBSTITUTIONS:
        raise RuntimeError(f"Unknown substitution: {name}")
    fewest, most, substitution = SUBSTITUTIONS[name]
    if not fewest <= len(arguments) <= most:
        expected = f"{fewest}" if fewest == most else f"{fewest} or {most}"
        what = "1 argument" if expected == "1" else f"{expected} arguments" if most else "no arguments"
        raise TypeError(f"{name} substitution expects {what}")
    made: Substitution = substitution(*arguments)
    return made


_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]*")


def parse_substitution(text: str) -> list[Substitution]:
    """Split a text into its parts.

    Raises ValueError, with the position, for a syntax error, and RuntimeError for an unknown substitution.
    """
    reader = _Reader(text)
    parts = reader.read_until("")
    return parts or [TextSubstitution(text="")]


def parse_words(text: str) -> list[list[Substitution]]:
    """Split a command line into words, each as its parts. The result of a substitution is not split."""
    words: list[list[Substitution]] = []
    word: list[Substitution] = []
    for part in parse_substitution(text):
        if not isinstance(part, TextSubstitution):
            word.append(part)
            continue
        tokens = shlex.split(part.text)
        starts = [part.text[0].isspace()] + [True] * (len(tokens) - 1) if tokens else []
        for token, is_start in zip(tokens, starts, strict=True):
            if is_start and word:
                words.append(word)
                word = []
            word.append(TextSubstitution(text=token))
        if not tokens or part.text[-1].isspace():
            words.append(word)
            word = []
    return [*words, word] if word else words


class _Reader:
    """Reads a text from left to right."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._position = 0

    def read_until(self, end: str) -> list[Substitution]:
        """Read the parts up to and including the quote `end`, or up to the end of the text if `end` is empty."""
        parts: list[Substitution] = []
        plain = ""
        while self._has_more() and not (end and self._is_next(end)):
            if self._is_next("$("):
                parts += _as_parts(plain)
                plain = ""
                parts.append(self._read_substitution(end))
            else:
                plain += self._read_character()
        if end:
            self._expect(end)
        return parts + _as_parts(plain)

    def _read_substitution(self, quote: str) -> Substitution:
        start = self._position
        self._expect("$(")
        name = _NAME.match(self._text, self._position)
        if name is None:
            self._fail()
        self._position = name.end()
        arguments = []
        while self._is_next(" "):
            self._position += 1
            arguments.append(self._read_argument(quote))
        if not self._is_next(")"):
            self._position = start if not self._has_more() else self._position
            self._fail()
        self._position += 1
        return make_substitution(name[0], arguments)

    def _read_argument(self, quote: str) -> list[Substitution]:
        """Read an argument; `quote`, in which the whole substitution is quoted, cannot be used inside it."""
        if not quote and self._text[self._position : self._position + 1] in ("'", '"'):
            opened = self._text[self._position]
            self._position += 1
            return self.read_until(opened)
        parts: list[Substitution] = []
        plain = ""
        forbidden = quote or "'\""
        while self._has_more() and self._text[self._position] not in " ()":
            if self._is_next("$("):
                parts += _as_parts(plain)
                plain = ""
                parts.append(self._read_substitution(quote))
            elif self._text[self._position] in forbidden:
                break
            else:
                plain += self._read_character()
        parts += _as_parts(plain)
        if not parts:
            self._fail()
        return parts

    def _read_character(self) -> str:
        if self._is_next("\\") and self._position + 1 < len(self._text):
            self._position += 1
        self._position += 1
        return self._text[self._position - 1]

    def _has_more(self) -> bool:
        return self._position < len(self._text)

    def _is_next(self, text: str) -> bool:
        return self._text.startswith(text, self._position)

    def _expect(self, text: str) -> None:
        if not self._is_next(text):
            self._fail()
        self._position += len(text)

    def _fail(self) -> NoReturn:
        found = f"unexpected {self._text[self._position]!r}" if self._has_more() else "it ends too early"
        raise ValueError(f"the substitution in '{self._text}' cannot be read: {found} at column {self._position + 1}")


def _as_parts(plain: str) -> list[Substitution]:
    return [TextSubstitution(text=plain)] if plain else []
