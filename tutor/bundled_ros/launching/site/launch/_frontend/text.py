r"""Texts with substitutions in them: `$(var topic)/raw`, `$(eval '$(var a) + 1')`.

An argument is a word, which may hold substitutions itself, or stands in single or double quotes. A backslash takes the
meaning off the character behind it.
"""

from __future__ import annotations

import re
import shlex
from collections.abc import Callable, Sequence
from typing import Any, NoReturn

from .. import substitutions as subs
from .._entities import Substitution, TextSubstitution

Argument = list[Substitution]


def _python(expression: Argument, modules: Argument | None = None) -> Substitution:
    if modules is None:
        return subs.PythonExpression(expression)
    named = "".join(part.text for part in modules if isinstance(part, TextSubstitution))
    return subs.PythonExpression(expression, [name.strip() for name in named.split(",") if name.strip()])


def _env(name: Argument, default: Argument | None = None) -> Substitution:
    return subs.EnvironmentVariable(name, default_value=default)


def _var(name: Argument, default: Argument | None = None) -> Substitution:
    return subs.LaunchConfiguration(name, default=default)


def _command(command: Argument, on_stderr: Argument | None = None) -> Substitution:
    return subs.Command(command) if on_stderr is None else subs.Command(command, on_stderr=on_stderr)


TABLE: dict[str, tuple[int, int, Callable[..., Any]]] = {
    "all": (0, 99, subs.AllSubstitution),
    "and": (2, 2, subs.AndSubstitution),
    "anon": (1, 1, subs.AnonName),
    "any": (0, 99, subs.AnySubstitution),
    "command": (1, 2, _command),
    "dirname": (0, 0, subs.ThisLaunchFileDir),
    "env": (1, 2, _env),
    "equals": (2, 2, subs.EqualsSubstitution),
    "eval": (1, 2, _python),
    "file-content": (1, 1, subs.FileContent),
    "filename": (0, 0, subs.ThisLaunchFile),
    "find-exec": (1, 1, lambda name: subs.FindExecutable(name=name)),
    "if": (2, 3, subs.IfElseSubstitution),
    "launch_log_dir": (0, 0, subs.LaunchLogDir),
    "log_dir": (0, 0, subs.LaunchLogDir),
    "not": (1, 1, subs.NotSubstitution),
    "not-equals": (2, 2, subs.NotEqualsSubstitution),
    "or": (2, 2, subs.OrSubstitution),
    "var": (1, 2, _var),
}
"""For each name the fewest and the most arguments, and what makes the substitution of them."""


def make(name: str, arguments: Sequence[Argument]) -> Substitution:
    """The substitution `$(name arguments...)`; RuntimeError, TypeError where there is none such."""
    if name not in TABLE:
        raise RuntimeError(f"Unknown substitution: {name}")
    fewest, most, substitution = TABLE[name]
    if not fewest <= len(arguments) <= most:
        expected = f"{fewest}" if fewest == most else f"{fewest} or {most}"
        what = "1 argument" if expected == "1" else f"{expected} arguments" if most else "no arguments"
        raise TypeError(f"{name} substitution expects {what}")
    made: Substitution = substitution(*arguments)
    return made


_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]*")


def parse_substitution(text: str) -> list[Substitution]:
    """The parts of a text; ValueError, with the place, where it cannot be read, RuntimeError for an unknown name."""
    reader = _Reader(text)
    parts = reader.until("")
    return parts or [TextSubstitution(text="")]


def parse_words(text: str) -> list[list[Substitution]]:
    """The words of a command line, each as its parts. What a substitution gives is not split."""
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
    """Reads a text from the left."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._at = 0

    def until(self, end: str) -> list[Substitution]:
        """The parts up to the quote `end`, which is left behind, or up to the end of the text."""
        parts: list[Substitution] = []
        plain = ""
        while self._rest() and not (end and self._is_at(end)):
            if self._is_at("$("):
                parts += _text(plain)
                plain = ""
                parts.append(self._substitution(end))
            else:
                plain += self._character()
        if end:
            self._expect(end)
        return parts + _text(plain)

    def _substitution(self, quote: str) -> Substitution:
        start = self._at
        self._expect("$(")
        name = _NAME.match(self._text, self._at)
        if name is None:
            self._fail()
        self._at = name.end()
        arguments = []
        while self._is_at(" "):
            self._at += 1
            arguments.append(self._argument(quote))
        if not self._is_at(")"):
            self._at = start if not self._rest() else self._at
            self._fail()
        self._at += 1
        return make(name[0], arguments)

    def _argument(self, quote: str) -> list[Substitution]:
        """`quote`: the one in which the substitution stands; it cannot be used within."""
        if not quote and self._text[self._at : self._at + 1] in ("'", '"'):
            opened = self._text[self._at]
            self._at += 1
            return self.until(opened)
        parts: list[Substitution] = []
        plain = ""
        forbidden = quote or "'\""
        while self._rest() and self._text[self._at] not in " ()":
            if self._is_at("$("):
                parts += _text(plain)
                plain = ""
                parts.append(self._substitution(quote))
            elif self._text[self._at] in forbidden:
                break
            else:
                plain += self._character()
        parts += _text(plain)
        if not parts:
            self._fail()
        return parts

    def _character(self) -> str:
        if self._is_at("\\") and self._at + 1 < len(self._text):
            self._at += 1
        self._at += 1
        return self._text[self._at - 1]

    def _rest(self) -> bool:
        return self._at < len(self._text)

    def _is_at(self, text: str) -> bool:
        return self._text.startswith(text, self._at)

    def _expect(self, text: str) -> None:
        if not self._is_at(text):
            self._fail()
        self._at += len(text)

    def _fail(self) -> NoReturn:
        found = f"unexpected {self._text[self._at]!r}" if self._rest() else "it ends too early"
        raise ValueError(f"the substitution in '{self._text}' cannot be read: {found} at column {self._at + 1}")


def _text(plain: str) -> list[Substitution]:
    return [TextSubstitution(text=plain)] if plain else []
