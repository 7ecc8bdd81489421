"""The table of known exceptions: TOML files, loaded once."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

from tutor.errors import TableError
from tutor.judge.exceptions.rewriting import REWRITERS
from tutor.judge.known_exception import WORD, Example, KnownException, Replace

GIVEN = frozenset(
    {"raised", "file", "number", "code", "function", "via", "there", "there_code", "becomes", "found", "nearest"}
)
"""The placeholders that `matching` fills in, in addition to the named groups of an entry's own patterns."""

_PATTERNS = ("type", "text", "line", "source", "without", "through", "at")
_TEXTS = ("cause", "says", "step", "look_up")
EDITS: tuple[set[str], ...] = (
    {"line", "becomes"},
    {"above", "code"},
    {"below", "code"},
    {"removed"},
    {"moved", "above"},
    {"moved", "below"},
    {"function", "start"},
    {"function", "end"},
    {"function", "returns"},
    {"unwrapped", "becomes"},
    {"async"},
    {"top"},
    {"every"},
    {"rewritten"},
)
"""The kinds of edits, by their keys; the value of `rewritten` is the name of a function in `rewriting`.

Lines are given by number, as in the placeholders `{number}` and `{there}`.
"""

_ORDER = ("launch", "parameters", "attributes", "calls", "messages", "process", "imports", "python")


@cache
def load_shipped(*, validate: bool = False) -> tuple[KnownException, ...]:
    """The built-in table, in the order in which it is searched. `validate`: see `parse`."""
    folder = Path(__file__).parent
    return tuple(entry for name in _ORDER for entry in load(folder / f"{name}.toml", validate=validate))


def load(path: Path, *, validate: bool = True) -> tuple[KnownException, ...]:
    """Load a table. `validate`: see `parse`. Raises TableError if it cannot be read, or is not valid."""
    try:
        return parse(path.read_text(encoding="utf-8"), path.name, validate=validate)
    except (OSError, UnicodeError) as error:
        raise TableError(f"{path}: {error}") from error


def parse(text: str, name: str = "exceptions.toml", *, validate: bool = True) -> tuple[KnownException, ...]:
    """The entries of a table in TOML; `name` is the file's name in the message of a TableError.

    `validate`: compile all patterns, and look for unknown placeholders. A failed check has no time for that.
    """
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise TableError(f"{name}: {error}") from error
    tables = data.get("words", {})
    if unexpected := data.keys() - {"known", "words"}:
        raise TableError(f"{name}: there are only [[known]] and [words.NAME], not {', '.join(sorted(unexpected))}")
    entries = data.get("known", [])
    if not isinstance(entries, list) or not isinstance(tables, dict):
        raise TableError(f"{name}: write [[known]] for each entry, and [words.NAME] for a table of words")
    table = []
    for number, each in enumerate(entries, 1):
        where = f"{name}, entry {number}"
        known = _entry(each, tables, where)
        if validate:
            _validate_patterns(known, where)
        table.append(known)
    return tuple(table)


def _entry(data: Mapping[str, Any], tables: Mapping[str, Mapping[str, str]], where: str) -> KnownException:
    allowed = {*_PATTERNS, *_TEXTS, "replace", "edits", "example", "exact", "of_source"}
    if unexpected := data.keys() - allowed:
        raise TableError(
            f"{where}: unknown key {', '.join(sorted(unexpected))}; there are {', '.join(sorted(allowed))}"
        )
    for key in ("type", "says", "step"):
        if not data.get(key):
            raise TableError(f"{where}: {key} is missing")
    for key in (*_PATTERNS, *_TEXTS):
        if not isinstance(data.get(key, ""), str):
            raise TableError(f"{where}: {key} must be a string")
    table = data.get("look_up", "")
    if table and table not in tables:
        raise TableError(f"{where}: there is no [words.{table}]")
    return KnownException(
        **{key: data[key] for key in (*_PATTERNS, *_TEXTS) if key in data},
        exact=bool(data.get("exact", True)),
        of_source=bool(data.get("of_source", False)),
        replace=_replace(data.get("replace"), where),
        edits=_edits(data.get("edits", []), where),
        examples=tuple(_example(each, where) for each in data.get("example", [])),
        words=dict(tables[table]) if table else {},
    )


def _validate_patterns(known: KnownException, where: str) -> None:
    """Raise TableError if a pattern is no regular expression, or for a placeholder that is never filled in."""
    groups = frozenset(group for key in _PATTERNS for group in _groups(getattr(known, key), f"{where}, {key}"))
    replaced = [[known.replace.pattern, known.replace.by]] if known.replace else []
    replaced += [list(edit["every"]) for edits in known.edits for edit in edits if "every" in edit]
    for pattern, _ in replaced:
        _groups(pattern, f"{where}, replace")
    used = known.placeholders | frozenset(
        WORD.findall(" ".join((known.source, known.without, *((known.replace.by,) if known.replace else ()))))
    )
    values = [str(value) for alternative in known.edits for edit in alternative for value in edit.values()]
    used |= {word for value in values for word in WORD.findall(value)}
    if unknown := used - groups - GIVEN:
        raise TableError(f"{where}: unknown placeholder {', '.join(sorted(unknown))}")


def _replace(data: object, where: str) -> Replace | None:
    if data is None:
        return None
    if not isinstance(data, list) or len(data) != 2 or not all(isinstance(each, str) for each in data):
        raise TableError(f"{where}: replace must be ['pattern', 'text']")
    return Replace(*data)


def _edits(data: object, where: str) -> tuple[tuple[Mapping[str, str | list[str]], ...], ...]:
    """The alternatives for a step: lists of edits, each a table with the keys of one of the kinds in `EDITS`."""
    alternatives: list[Any] = data if isinstance(data, list) and data and isinstance(data[0], list) else [data]
    for edits in alternatives:
        if not isinstance(edits, list) or not all(isinstance(each, dict) and set(each) in EDITS for each in edits):
            kinds = "; ".join(" and ".join(sorted(kind)) for kind in EDITS)
            raise TableError(f"{where}: edits must be a list of tables, each with one of these: {kinds}")
        for each in edits:
            if "every" in each:
                _replace(each["every"], where)
            elif not all(isinstance(value, str) for value in each.values()):
                raise TableError(f"{where}: the values of an edit must be strings")
            elif each.get("rewritten", "log") not in REWRITERS:
                raise TableError(f"{where}: rewritten must be one of {', '.join(REWRITERS)}")
    return tuple(tuple(edits) for edits in alternatives if edits)


def _example(data: object, where: str) -> Example:
    try:
        return Example(**data)  # type: ignore[arg-type]
    except TypeError as error:
        raise TableError(f"{where}: an example has raised, step, and line, source, function or at ({error})") from error


def _groups(pattern: str, where: str) -> Sequence[str]:
    """The named groups of a pattern; a placeholder in it stands for any text."""
    try:
        return tuple(re.compile(WORD.sub("x", pattern)).groupindex)
    except re.error as error:
        raise TableError(f"{where}: {error}") from error
