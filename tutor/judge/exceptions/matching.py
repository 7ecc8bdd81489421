"""Which known exception a traceback is, and what is said of it."""

from __future__ import annotations

import ast
import difflib
import re
import textwrap
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from tutor.judge import edits
from tutor.judge.edits import Edit
from tutor.judge.exceptions.rewriting import REWRITERS
from tutor.judge.known_exception import WORD, KnownException
from tutor.judge.source import Function, SourceFile
from tutor.judge.tracebacks import Frame, Traceback, is_in_folder
from tutor.judge.verdict import Cause

_NEAR = 0.75
"""Two names are near each other from this ratio of difflib's on."""


@dataclass(frozen=True, slots=True)
class RaisedException:
    """A traceback, the learner's own line in it, and the file that it is in, whose text serves the words only."""

    traceback: Traceback
    folder: str
    line: Frame | None
    file: str = ""
    source: str = ""


def explain(seen: RaisedException, table: Iterable[KnownException], *, cause: str, after: str = "") -> Cause | None:
    """What the first entry that fits says of it; None where none does.

    `cause` is its name where the entry has none, `after` what the exception led to.
    """
    for known in table:
        if (words := _words(known, seen)) is not None:
            own: object = seen.line
            if known.of_source:
                own = f"{seen.file}, line {words['there']}: {words['there_code']}"
            raised = seen.traceback.raised + (f" ({own})" if own else "") + after
            step = _edited(known, seen, words) or _fill_in(known.step, words)
            return Cause(known.cause or cause, f"{raised}: {_fill_in(known.says, words)}", step)
    return None


def _words(known: KnownException, seen: RaisedException) -> dict[str, str] | None:
    """The words that the entry's texts ask for; None where it does not fit."""
    found, own = seen.traceback, seen.line
    kind = re.fullmatch(known.type, found.type.rsplit(".", 1)[-1])
    text = re.search(known.text, found.message)
    if kind is None or text is None or not _raised_at(known.at, found):
        return None
    words = {"raised": found.raised, **_groups(kind), **_groups(text)}
    if own is not None:
        words |= {"file": own.name, "number": str(own.line), "code": own.code, "function": own.function}
    line = re.search(known.line, own.code if own else "")
    if line is None:
        return None
    words |= _groups(line)
    for step in (_words_of_way, _words_of_source, _words_of_table, _words_of_replacement):
        more = step(known, seen, words)
        if more is None:
            return None
        words |= more
    return words if known.placeholders <= words.keys() else None


def _raised_at(pattern: str, found: Traceback) -> bool:
    last = found.frames[-1] if found.frames else None
    return re.search(pattern, f"{last.path}, {last.function}" if last else "") is not None


def _words_of_way(known: KnownException, seen: RaisedException, words: Mapping[str, str]) -> dict[str, str] | None:
    """The first of the learner's lines, from the outermost on, that `through` is found in."""
    if not known.through:
        return {}
    for frame in seen.traceback.frames:
        if is_in_folder(frame.path, seen.folder) and (
            way := re.search(known.through, f"{frame.function}: {frame.code}")
        ):
            return {"via": str(frame.line), **_groups(way)}
    return None


def _words_of_source(known: KnownException, seen: RaisedException, words: Mapping[str, str]) -> dict[str, str] | None:
    """The first place in the learner's file that `source` is found in."""
    source = seen.source
    if known.without and re.search(_fill_in(known.without, words, escaped=True), source, re.MULTILINE):
        return None
    if not known.source:
        return {}
    pattern = re.compile(_fill_in(known.source, words, escaped=True), re.MULTILINE)
    # A call goes on for lines: what is wrong in it stands on its first line, or below it.
    lines = source.splitlines(keepends=True)[: int(words.get("number", 1)) - 1] if known.of_source else []
    there = pattern.search(source, sum(map(len, lines))) or pattern.search(source)
    if there is None:
        return None
    number = source.count("\n", 0, there.start("there" if "there" in there.re.groupindex else 0)) + 1
    code = source.splitlines()[number - 1].strip()
    return {**_groups(there), "there": str(number), "there_code": code}


def _words_of_table(known: KnownException, seen: RaisedException, words: Mapping[str, str]) -> dict[str, str] | None:
    """What the table of words has for the group `name`."""
    if not known.look_up:
        return {}
    name = words.get("name", "")
    near = [name] if name in known.words else []
    if not near and not known.exact:
        near = difflib.get_close_matches(name, known.words, n=1, cutoff=_NEAR)
    return {"found": known.words[near[0]], "nearest": near[0]} if near else None


def _words_of_replacement(
    known: KnownException, seen: RaisedException, words: Mapping[str, str]
) -> dict[str, str] | None:
    """What the line becomes; None where it would stay as it is."""
    if known.replace is None:
        return {}
    pattern, by = _fill_in(known.replace.pattern, words, escaped=True), _fill_in(known.replace.by, words)
    before = words.get("there_code" if known.of_source else "code", "")
    becomes = re.sub(pattern, by, before)
    return {"becomes": becomes} if becomes != before else None


def _edited(known: KnownException, seen: RaisedException, words: Mapping[str, str]) -> str | None:
    """The step as edits of the learner's file; None where the entry has none, or they do not fit."""
    for way in known.edits:
        found = [_edit(seen.source, each, words) for each in way]
        if None not in found and (step := edits.describe_edits(seen.source, *(each for each in found if each))):
            return step
    return None


def _edit(text: str, edit: Mapping[str, str | list[str]], words: Mapping[str, str]) -> Sequence[Edit] | None:
    """One edit, with all its words put in; None where there is no such word, line or function."""
    if "every" in edit:
        pattern, by = list(edit["every"])
        return edits.replace_pattern(text, _fill_in(pattern, words, escaped=True), _fill_in(by, words))
    if "rewritten" in edit:
        return REWRITERS[str(edit["rewritten"])](text, words)
    given = {key: _fill_in(str(value), words) for key, value in edit.items()}
    if any(WORD.fullmatch(word) for value in given.values() for word in re.findall(r"\{[a-z]\w*\}", value)):
        return None
    match given:
        case {"line": number, "becomes": code}:
            return [edits.replace_lines(int(number), code)]
        case {"top": code}:
            return edits.add_import(text, code)
        case {"async": number}:
            return _made_async(text, int(number))
        case {"function": name}:
            return _edits_of_function(_function(text, name, int(words.get("number", 0))), given)
    return _edits_of_statement(text, given)


def _edits_of_statement(text: str, given: Mapping[str, str]) -> Sequence[Edit] | None:
    number = next(given[key] for key in ("unwrapped", "moved", "removed", "above", "below") if key in given)
    there = SourceFile(text).statement_at(int(number))
    if there is None:
        return None
    end = there.end_lineno or there.lineno
    match given:
        case {"moved": _, **place}:
            return _moved(text, there, place)
        case {"removed": _}:
            return [edits.remove_lines(text, there.lineno, end)]
        case {"above": _, "code": code}:
            return [edits.insert_above(there.lineno, code)]
        case {"below": _, "code": code}:
            return [edits.insert_below(end, code, like=there.lineno)]
        case {"becomes": code} if isinstance(there, ast.With | ast.If | ast.Try):
            body = textwrap.dedent("\n".join(text.splitlines()[there.body[0].lineno - 1 : there.body[-1].end_lineno]))
            return [edits.replace_lines(there.lineno, f"{code}\n{body}", end)]
    return None


def _made_async(text: str, number: int) -> Sequence[Edit] | None:
    """The function that a line is in, as one that may await."""
    function = SourceFile(text).function_at(number)
    if function is None:
        return None
    code = text.splitlines()[function.lineno - 1].strip()
    return [] if code.startswith("async ") else [edits.replace_lines(function.lineno, f"async {code}")]


def _function(text: str, name: str, line: int) -> Function | None:
    """The function of this name: the one that `line` is in, else the last."""
    found = SourceFile(text).named(name)
    around = [each for each in found if each.lineno <= line <= (each.end_lineno or 0)]
    return next(iter([*around[-1:], *found[-1:]]), None)


def _edits_of_function(function: Function | None, given: Mapping[str, str]) -> Sequence[Edit] | None:
    if function is None:
        return None
    if "returns" in given:
        return edits.return_on_every_path(function, given["returns"])
    if "start" in given:
        return [edits.prepend_to_function(function, given["start"])]
    return [edits.append_to_function(function, given["end"])]


def _moved(text: str, moved: ast.stmt, place: Mapping[str, str]) -> Sequence[Edit] | None:
    """A statement taken to another place, above or below the statement of a line."""
    there = SourceFile(text).statement_at(int(next(iter(place.values()))))
    if there is None or moved.lineno == there.lineno:
        return None
    end = moved.end_lineno or moved.lineno
    code = textwrap.dedent("\n".join(text.splitlines()[moved.lineno - 1 : end]))
    below = edits.insert_after(there, code)
    return [
        edits.insert_above(there.lineno, code) if "above" in place else below,
        edits.remove_lines(text, moved.lineno, end),
    ]


def _groups(match: re.Match[str]) -> dict[str, str]:
    return {name: value or "" for name, value in match.groupdict().items()}


def _fill_in(text: str, words: Mapping[str, str], *, escaped: bool = False) -> str:
    """The text with the words in place of their names in braces."""

    def word(found: re.Match[str]) -> str:
        known = words.get(found[1])
        return found[0] if known is None else re.escape(known) if escaped else known

    return WORD.sub(word, text)
