"""Match a traceback with known exceptions."""

from __future__ import annotations

import difflib
import re
from collections.abc import Mapping

from tutor.judge.tracebacks import Traceback, is_in_folder
from tutor.mistakes.entry import Found
from tutor.mistakes.exceptions.known import WORD, Way
from tutor.mistakes.raised_exceptions import RaisedException

_SIMILARITY = 0.75
"""Minimum difflib ratio at which two names count as similar."""


def recognise(way: Way, seen: RaisedException) -> Found | None:
    """The mistake, as this way shows it; None if it does not.

    The words are those of `says` and `do`, which are filled in here.
    """
    words = _words(way, seen)
    if words is None:
        return None
    says, do = fill_in(way.says, words), fill_in(way.do, words)
    if way.of_source:
        number = int(words["there"])
        return Found({"says": says, "do": do}, seen.file, number, seen.source.splitlines()[number - 1].strip())
    line = seen.line
    place = (line.name, line.line, line.code) if line is not None else ("", 0, "")
    return Found({"says": says, "do": do}, *place)


def _words(way: Way, seen: RaisedException) -> dict[str, str] | None:
    """The values of the placeholders; None if a pattern does not match."""
    found, own = seen.traceback, seen.line
    kind = re.fullmatch(way.type, found.type.rsplit(".", 1)[-1])
    text = re.search(way.text, found.message)
    if kind is None or text is None or not _raised_at(way.at, found):
        return None
    words = {"raised": seen.raised, **_groups(kind), **_groups(text)}
    if own is not None:
        words |= {"file": own.name, "number": str(own.line), "code": own.code, "function": own.function}
    line = re.search(way.line, own.code if own else "")
    if line is None:
        return None
    words |= _groups(line)
    for find_words in (_match_through, _match_source, _look_up, _replace):
        more = find_words(way, seen, words)
        if more is None:
            return None
        words |= more
    return words if way.placeholders <= words.keys() else None


def _raised_at(pattern: str, found: Traceback) -> bool:
    last = found.frames[-1] if found.frames else None
    return re.search(pattern, f"{last.path}, {last.function}" if last else "") is not None


def _match_through(way: Way, seen: RaisedException, words: Mapping[str, str]) -> dict[str, str] | None:
    """Match `through` with the learner's frames, outermost first."""
    if not way.through:
        return {}
    for frame in seen.traceback.frames:
        if is_in_folder(frame.path, seen.folder) and (
            found := re.search(way.through, f"{frame.function}: {frame.code}")
        ):
            return {"via": str(frame.line), **_groups(found)}
    return None


def _match_source(way: Way, seen: RaisedException, words: Mapping[str, str]) -> dict[str, str] | None:
    """Match `without` and `source` with the learner's file; the first match from the raising line on is preferred."""
    source = seen.source
    if way.without and re.search(fill_in(way.without, words, escaped=True), source, re.MULTILINE):
        return None
    if not way.source:
        return {}
    pattern = re.compile(fill_in(way.source, words, escaped=True), re.MULTILINE)
    # A call may span several lines: the mistake is on its first line or below.
    lines = source.splitlines(keepends=True)[: int(words.get("number", 1)) - 1] if way.of_source else []
    there = pattern.search(source, sum(map(len, lines))) or pattern.search(source)
    if there is None:
        return None
    number = source.count("\n", 0, there.start("there" if "there" in there.re.groupindex else 0)) + 1
    return {**_groups(there), "there": str(number)}


def _look_up(way: Way, seen: RaisedException, words: Mapping[str, str]) -> dict[str, str] | None:
    """Look the group `name` up in the table of words."""
    if not way.look_up:
        return {}
    name = words.get("name", "")
    keys = [name] if name in way.words else []
    if not keys and not way.exact:
        keys = difflib.get_close_matches(name, way.words, n=1, cutoff=_SIMILARITY)
    return {"found": way.words[keys[0]], "nearest": keys[0]} if keys else None


def _replace(way: Way, seen: RaisedException, words: Mapping[str, str]) -> dict[str, str] | None:
    """What the learner's line becomes; None if that changes nothing."""
    if way.replace is None:
        return {}
    pattern, by = fill_in(way.replace.pattern, words, escaped=True), fill_in(way.replace.by, words)
    before = seen.source.splitlines()[int(words["there"]) - 1].strip() if way.of_source else words.get("code", "")
    becomes = re.sub(pattern, by, before)
    return {"becomes": becomes} if becomes != before else None


def _groups(match: re.Match[str]) -> dict[str, str]:
    return {name: value or "" for name, value in match.groupdict().items()}


def fill_in(text: str, words: Mapping[str, str], *, escaped: bool = False) -> str:
    """The text with its placeholders filled in, as far as they have a value; `escaped`: for use in a pattern."""

    def value(placeholder: re.Match[str]) -> str:
        found = words.get(placeholder[1])
        return placeholder[0] if found is None else re.escape(found) if escaped else found

    return WORD.sub(value, text)
