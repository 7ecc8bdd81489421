"""Read tables of known exceptions: TOML files."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from tutor.errors import TableError
from tutor.mistakes.exceptions.known import WORD, Example, KnownException, Replace, Way

GIVEN = frozenset({"raised", "file", "number", "code", "function", "via", "there", "becomes", "found", "nearest"})
"""The placeholders that `matching` fills in, in addition to the named groups of a way's own patterns."""

_PATTERNS = ("type", "text", "line", "source", "without", "through", "at")
_TEXTS = (*_PATTERNS, "says", "do", "look_up")
_KEYS = {*_TEXTS, "replace", "exact", "of_source", "example"}
_MISTAKE = {"id", "name", "page", "says", "do", "slip", "while_running", "when"}


def load(path: Path, *, validate: bool = True) -> tuple[KnownException, ...]:
    """Load a table. `validate`: see `parse`. Raises TableError if it cannot be read, or is not valid."""
    try:
        return parse(path.read_text(encoding="utf-8"), path.name, validate=validate)
    except (OSError, UnicodeError) as error:
        raise TableError(f"{path}: {error}") from error


def parse(text: str, name: str = "exceptions.toml", *, validate: bool = True) -> tuple[KnownException, ...]:
    """The mistakes of a table in TOML; `name` is the file's name in the message of a TableError.

    `validate`: compile all patterns, and look for unknown placeholders. A failed check has no time for that.
    """
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise TableError(f"{name}: {error}") from error
    words = data.get("words", {})
    if unexpected := data.keys() - {"mistake", "words"}:
        raise TableError(f"{name}: there are only [[mistake]] and [words.NAME], not {', '.join(sorted(unexpected))}")
    entries = data.get("mistake", [])
    if not isinstance(entries, list) or not isinstance(words, dict):
        raise TableError(f"{name}: write [[mistake]] for each mistake, and [words.NAME] for a table of words")
    return tuple(
        _mistake(entry, words, f"{name}, mistake {number}", validate) for number, entry in enumerate(entries, 1)
    )


def _mistake(data: Mapping[str, Any], words: Mapping[str, Any], where: str, validate: bool) -> KnownException:
    _refuse_unknown(data, _MISTAKE, where)
    for key in ("id", "page", "when"):
        if not data.get(key):
            raise TableError(f"{where}: {key} is missing")
    where = f"{where} ({data['id']})"
    ways = []
    for number, given in enumerate(data["when"], 1):
        place = f"{where}, when {number}"
        way = _way({**{key: data[key] for key in ("says", "do") if key in data}, **given}, words, place)
        if validate:
            _validate(way, place)
        ways.append(way)
    return KnownException(
        data["id"],
        data["page"].strip(),
        tuple(ways),
        bool(data.get("slip", False)),
        data.get("name", ""),
        bool(data.get("while_running", False)),
    )


def _way(data: Mapping[str, Any], words: Mapping[str, Any], where: str) -> Way:
    _refuse_unknown(data, _KEYS, where)
    for key in ("says", "do"):
        if not data.get(key):
            raise TableError(f"{where}: {key} is missing, here and in the mistake")
    for key in _TEXTS:
        if not isinstance(data.get(key, ""), str):
            raise TableError(f"{where}: {key} must be a string")
    table = data.get("look_up", "")
    if table and table not in words:
        raise TableError(f"{where}: there is no [words.{table}]")
    return Way(
        **{key: data[key] for key in _TEXTS if key in data},
        exact=bool(data.get("exact", True)),
        of_source=bool(data.get("of_source", False)),
        replace=_replace(data.get("replace"), where),
        examples=tuple(_example(example, where) for example in data.get("example", [])),
        words=dict(words[table]) if table else {},
    )


def _refuse_unknown(data: Mapping[str, Any], allowed: set[str], where: str) -> None:
    if unexpected := data.keys() - allowed:
        raise TableError(
            f"{where}: unknown key {', '.join(sorted(unexpected))}; there are {', '.join(sorted(allowed))}"
        )


def _validate(way: Way, where: str) -> None:
    """Raise TableError if a pattern is no regular expression, or for a placeholder that is never filled in."""
    groups = frozenset(group for key in _PATTERNS for group in _groups(getattr(way, key), f"{where}, {key}"))
    texts = [way.source, way.without]
    if way.replace:
        _groups(way.replace.pattern, f"{where}, replace")
        texts.append(way.replace.by)
    used = way.placeholders | frozenset(WORD.findall(" ".join(texts)))
    if unknown := used - groups - GIVEN:
        raise TableError(f"{where}: unknown placeholder {', '.join(sorted(unknown))}")


def _replace(data: object, where: str) -> Replace | None:
    if data is None:
        return None
    if not isinstance(data, list) or len(data) != 2 or not all(isinstance(part, str) for part in data):
        raise TableError(f"{where}: replace must be ['pattern', 'text']")
    return Replace(*data)


def _example(data: object, where: str) -> Example:
    try:
        return Example(**data)  # type: ignore[arg-type]
    except TypeError as error:
        raise TableError(f"{where}: an example has raised, line, source, function and at ({error})") from error


def _groups(pattern: str, where: str) -> Sequence[str]:
    """The named groups of a pattern; a placeholder in it stands for any text."""
    try:
        return tuple(re.compile(WORD.sub("x", pattern)).groupindex)
    except re.error as error:
        raise TableError(f"{where}: {error}") from error
