"""Match a traceback with the table of known exceptions, and explain it."""

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
from tutor.judge.source import Function, SourceFile, called_name
from tutor.judge.tracebacks import Frame, Traceback, is_in_folder
from tutor.judge.verdict import Cause

_SIMILARITY = 0.75
"""Minimum difflib ratio at which two names count as similar."""


@dataclass(frozen=True, slots=True)
class RaisedException:
    """A traceback, the learner's own line in it, and the file with that line; its text only shapes the wording."""

    traceback: Traceback
    folder: str
    line: Frame | None
    file: str = ""
    source: str = ""


def explain(seen: RaisedException, table: Iterable[KnownException], *, cause: str, after: str = "") -> Cause | None:
    """The cause by the first entry that matches; None if none does.

    `cause`: the name of the cause, if the entry has none. `after`: words on what the exception led to.
    """
    for known in table:
        if (words := _words(known, seen)) is not None:
            own: object = seen.line
            if known.of_source:
                own = f"{seen.file}, line {words['there']}: {words['there_code']}"
            raised = seen.traceback.raised + (f" ({own})" if own else "") + after
            step = _step_as_edits(known, seen, words) or _fill_in(known.step, words)
            return Cause(known.cause or cause, f"{raised}: {_fill_in(known.says, words)}", step)
    return None


def _words(known: KnownException, seen: RaisedException) -> dict[str, str] | None:
    """The values of the entry's placeholders; None if the entry does not match."""
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
    for find_words in (_match_through, _match_source, _look_up, _replace):
        more = find_words(known, seen, words)
        if more is None:
            return None
        words |= more
    return words if known.placeholders <= words.keys() else None


def _raised_at(pattern: str, found: Traceback) -> bool:
    last = found.frames[-1] if found.frames else None
    return re.search(pattern, f"{last.path}, {last.function}" if last else "") is not None


def _match_through(known: KnownException, seen: RaisedException, words: Mapping[str, str]) -> dict[str, str] | None:
    """Match `through` with the learner's frames, outermost first."""
    if not known.through:
        return {}
    for frame in seen.traceback.frames:
        if is_in_folder(frame.path, seen.folder) and (
            found := re.search(known.through, f"{frame.function}: {frame.code}")
        ):
            return {"via": str(frame.line), **_groups(found)}
    return None


def _match_source(known: KnownException, seen: RaisedException, words: Mapping[str, str]) -> dict[str, str] | None:
    """Match `without` and `source` with the learner's file; the first match from the raising line on is preferred."""
    source = seen.source
    if known.without and re.search(_fill_in(known.without, words, escaped=True), source, re.MULTILINE):
        return None
    if not known.source:
        return {}
    pattern = re.compile(_fill_in(known.source, words, escaped=True), re.MULTILINE)
    # A call may span several lines: the mistake is on its first line or below.
    lines = source.splitlines(keepends=True)[: int(words.get("number", 1)) - 1] if known.of_source else []
    there = pattern.search(source, sum(map(len, lines))) or pattern.search(source)
    if there is None:
        return None
    number = source.count("\n", 0, there.start("there" if "there" in there.re.groupindex else 0)) + 1
    code = source.splitlines()[number - 1].strip()
    return {**_groups(there), "there": str(number), "there_code": code}


def _look_up(known: KnownException, seen: RaisedException, words: Mapping[str, str]) -> dict[str, str] | None:
    """Look the group `name` up in the entry's table of words."""
    if not known.look_up:
        return {}
    name = words.get("name", "")
    keys = [name] if name in known.words else []
    if not keys and not known.exact:
        keys = difflib.get_close_matches(name, known.words, n=1, cutoff=_SIMILARITY)
    return {"found": known.words[keys[0]], "nearest": keys[0]} if keys else None


def _replace(known: KnownException, seen: RaisedException, words: Mapping[str, str]) -> dict[str, str] | None:
    """Apply the entry's replacement to the learner's line; None if that changes nothing."""
    if known.replace is None:
        return {}
    pattern, by = _fill_in(known.replace.pattern, words, escaped=True), _fill_in(known.replace.by, words)
    before = words.get("there_code" if known.of_source else "code", "")
    becomes = re.sub(pattern, by, before)
    return {"becomes": becomes} if becomes != before else None


def _step_as_edits(known: KnownException, seen: RaisedException, words: Mapping[str, str]) -> str | None:
    """The step as edits of the learner's file; None if the entry has none, or none that fit."""
    for alternative in known.edits:
        found = [_make_edits(seen.source, each, words) for each in alternative]
        if None not in found and (step := edits.describe_edits(seen.source, *(each for each in found if each))):
            return step
    return None


def _make_edits(text: str, edit: Mapping[str, str | list[str]], words: Mapping[str, str]) -> Sequence[Edit] | None:
    """The edits for one table of an entry, with its placeholders filled in.

    None if a placeholder has no value, or if there is no such line or function.
    """
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
            return _make_async(text, int(number))
        case {"function": name}:
            return _edit_function(_find_function(text, name, int(words.get("number", 0))), given)
    return _edit_statement(text, given)


def _edit_statement(text: str, given: Mapping[str, str]) -> Sequence[Edit] | None:
    number = next(given[key] for key in ("unwrapped", "moved", "removed", "above", "below") if key in given)
    file = SourceFile(text)
    statement = file.statement_at(int(number))
    if statement is None:
        return None
    first, last = statement.lineno, statement.end_lineno or statement.lineno
    match given:
        case {"moved": _, **place}:
            return _move(file, statement, place)
        case {"removed": _}:
            return [edits.remove_lines(text, first, last)]
        case {"above": _, "code": code}:
            return [edits.insert_above(first, code)]
        case {"below": _, "code": code}:
            return [edits.insert_below(last, code, like=first)]
        case {"becomes": code} if isinstance(statement, ast.With | ast.If | ast.Try):
            lines = text.splitlines()[statement.body[0].lineno - 1 : statement.body[-1].end_lineno]
            return [edits.replace_lines(first, f"{code}\n{textwrap.dedent('\n'.join(lines))}", last)]
    return None


def _make_async(text: str, number: int) -> Sequence[Edit] | None:
    """Turn the function that contains a line into a coroutine."""
    function = SourceFile(text).function_at(number)
    if function is None:
        return None
    code = text.splitlines()[function.lineno - 1].strip()
    return [] if code.startswith("async ") else [edits.replace_lines(function.lineno, f"async {code}")]


def _find_function(text: str, name: str, line: int) -> Function | None:
    """The function with this name: the one that contains `line`, else the last."""
    found = SourceFile(text).functions_named(name)
    around = [each for each in found if each.lineno <= line <= (each.end_lineno or 0)]
    return next(iter([*around[-1:], *found[-1:]]), None)


def _edit_function(function: Function | None, given: Mapping[str, str]) -> Sequence[Edit] | None:
    if function is None:
        return None
    if "returns" in given:
        return edits.return_on_every_path(function, given["returns"])
    if "start" in given:
        return [edits.prepend_to_function(function, given["start"])]
    return [edits.append_to_function(function, given["end"])]


def _move(file: SourceFile, statement: ast.stmt, place: Mapping[str, str]) -> Sequence[Edit] | None:
    """Move a statement above or below another one, given as {"above" or "below": line}.

    Declarations of parameters that follow one another are moved together.
    """
    other = file.statement_at(int(next(iter(place.values()))))
    if other is None or statement.lineno == other.lineno:
        return None
    moved = _declarations_around(statement, file.block_of(statement))
    start, end = moved[0].lineno, moved[-1].end_lineno or moved[-1].lineno
    if start <= other.lineno <= end:
        start, end = statement.lineno, statement.end_lineno or statement.lineno
    code = textwrap.dedent("\n".join(file.text.splitlines()[start - 1 : end]))
    return [
        edits.insert_above(other.lineno, code) if "above" in place else edits.insert_after(other, code),
        edits.remove_lines(file.text, start, end),
    ]


def _declarations_around(statement: ast.stmt, block: Sequence[ast.stmt]) -> Sequence[ast.stmt]:
    """The statement; with its neighbours if they all are nothing but declarations of parameters."""
    if not _declares_only(statement):
        return [statement]
    first = last = block.index(statement)
    while first > 0 and _declares_only(block[first - 1]):
        first -= 1
    while last + 1 < len(block) and _declares_only(block[last + 1]):
        last += 1
    return block[first : last + 1]


def _declares_only(statement: ast.stmt) -> bool:
    call = statement.value if isinstance(statement, ast.Expr) else None
    return isinstance(call, ast.Call) and called_name(call) == "declare_parameter"


def _groups(match: re.Match[str]) -> dict[str, str]:
    return {name: value or "" for name, value in match.groupdict().items()}


def _fill_in(text: str, words: Mapping[str, str], *, escaped: bool = False) -> str:
    """The text with its placeholders filled in, as far as they have a value; `escaped`: for use in a pattern."""

    def fill_in(placeholder: re.Match[str]) -> str:
        value = words.get(placeholder[1])
        return placeholder[0] if value is None else re.escape(value) if escaped else value

    return WORD.sub(fill_in, text)
