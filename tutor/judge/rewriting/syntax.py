"""Repair syntax errors: find the smallest change of a file's lines after which Python can read it.

The candidates undo typical typing mistakes: a missing or extra bracket, comma, colon or quotation mark, or a wrong
indentation. The result only shapes the wording of a diagnosis, never a verdict.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterator, Sequence

from tutor.judge.edits import Edit, describe_edits, replace_lines
from tutor.judge.syntax_tree import compile_quietly

_LINES_ABOVE = 6
"""How many lines above the one at which Python stops are searched for the mistake."""
_LINES_IN_BRACKETS = 20
"""How many lines below an opened bracket are searched for the place of the missing closing one."""
_MAX_REPAIRS = 3
"""How many mistakes in one file are repaired in one step."""
_ENDS = (")", "]", "}", ":", "):", "'", '"', "')", '")', "),", "],", "},", ",", "',", '",', "])", "))", "})", ")))")
_KEYWORDS = ("class", "def", "elif", "else:", "except", "finally:", "for", "from", "if", "import", "return", "while")
_OPEN = re.compile(r"'([(\[{])' was never closed")
_CLOSES = {"(": ")", "[": "]", "{": "}"}
_COMMENT = re.compile(r"\s+#[^'\"]*$")
_QUOTES = str.maketrans("\u201c\u201d\u2018\u2019", "\"\"''")


def make_readable(text: str, file: str = "") -> str | None:
    """The step after which Python can read the file; None if it already can, or if no small change helps."""
    found = repair(text)
    return describe_edits(text, found, file=file) if found else None


def repair(text: str) -> list[Edit] | None:
    """The edits of `make_readable`; empty if Python can already read the file, None if no small change helps."""
    lines = text.replace("\0", "").splitlines()
    for _ in range(_MAX_REPAIRS):
        error = _find_error(lines)
        if error is None:
            break
        reached = [(_error_line(each) or len(each) + 1, cost, each) for cost, each in _candidates(lines, *error)]
        furthest = max(reached, key=lambda each: (each[0], -each[1]), default=(0, 0.0, lines))
        if furthest[0] <= error[0]:
            return None
        lines = furthest[2]
    return _diff(text.splitlines(), lines) if _find_error(lines) is None else None


def _find_error(lines: Sequence[str]) -> tuple[int, str] | None:
    """The line number and message of the first syntax error; None if there is none."""
    try:
        compile_quietly("\n".join(lines) + "\n")
    except SyntaxError as error:
        return max(1, min(error.lineno or 1, len(lines))), error.msg
    except (ValueError, RecursionError, MemoryError):
        return 1, ""
    return None


def _error_line(lines: Sequence[str]) -> int | None:
    error = _find_error(lines)
    return error[0] if error is not None else None


def _candidates(lines: Sequence[str], stop: int, message: str) -> Iterator[tuple[float, list[str]]]:
    """The lines after each change that may help, with its cost: its distance from the error and its implausibility."""
    for number in range(stop, max(0, stop - 1 - _LINES_ABOVE), -1):
        line = lines[number - 1]
        if not line.strip():
            continue
        for order, new in enumerate(dict.fromkeys(_repair_line(line))):
            closes = abs(_balance(new)) < abs(_balance(line)) and _balance(new) == 0
            yield stop - number + order / 100 - 10 * closes, [*lines[: number - 1], new, *lines[number:]]
        for order, moved in enumerate(_reindent(lines, number)):
            # A margin that is no multiple of four is more likely to be a mistake, and never a good correction.
            unlikely = (_margin(line) % 4 == 0) + (_margin(moved[number - 1]) % 4 != 0)
            yield stop - number + 0.5 + order / 100 + _LINES_ABOVE * unlikely, moved
        if line.rstrip().endswith(":"):
            yield stop - number + 3 * _LINES_ABOVE, [*lines[: number - 1], f"{line.rstrip()} pass", *lines[number:]]
    if opened := _OPEN.search(message):  # the error is at the opening bracket, but the call may span several lines
        for number in range(stop + 1, min(stop + _LINES_IN_BRACKETS, len(lines)) + 1):
            for order, new in enumerate(_add_end(lines[number - 1].rstrip(), (_CLOSES[opened[1]],))):
                closes = _balance(new) == 0 and bool(new.strip())
                yield number - stop + order / 100 - 10 * closes, [*lines[: number - 1], new, *lines[number:]]


def _balance(line: str) -> int:
    """The number of opening minus closing brackets, outside of string literals."""
    bare = re.sub(r"'[^']*'|\"[^\"]*\"", "", line)
    return sum(bare.count(each) for each in "([{") - sum(bare.count(each) for each in ")]}")


def _repair_line(line: str) -> Iterator[str]:
    """The line after each repair of a mistake that it may contain."""
    code = _COMMENT.sub("", line.rstrip())
    yield line.translate(_QUOTES)
    if re.match(r"\s*(?:if|elif|while)\b", code):
        yield re.sub(r"(?<![=!<>:])=(?!=)", "==", code)
    yield re.sub(r"\belse if\b", "elif", code)
    yield re.sub(r"\bprint +([^(].*)$", r"print(\1)", code)
    for quote in ('"', "'"):
        if code.count(quote) % 2:
            yield from (
                code[: each.start()] + quote + code[each.start() :] for each in re.finditer(r"[,)\]:}]|$", code)
            )
    yield from _add_end(code, _ENDS)
    for found in re.finditer(r"(?<=[\w'\")\]}]) +(?=[\w'\"(\[{])", code):
        yield f"{code[: found.start()]},{code[found.start() :]}"
    for found in re.finditer(r"[()\[\]{},:]", code):
        yield code[: found.start()] + code[found.end() :]
    word = code.split(maxsplit=1)[0] if code.strip() else ""
    for near in difflib.get_close_matches(word, _KEYWORDS, n=1, cutoff=0.6):
        yield code.replace(word, near, 1)


def _add_end(code: str, ends: Sequence[str]) -> Iterator[str]:
    """The line with each of these added at its end, or before its final comma or colon."""
    for end in ends:
        yield code + end
        if code.endswith((",", ":")):
            yield code[:-1] + end + code[-1]


def _reindent(lines: Sequence[str], number: int) -> Iterator[list[str]]:
    """The lines after changing the indentation of one line, or of its whole block, to one that occurs above."""
    before = next((each for each in reversed(lines[: number - 1]) if each.strip()), "")
    margin = _margin(lines[number - 1])
    last = number
    while last < len(lines) and (not lines[last].strip() or _margin(lines[last]) >= max(margin, 1)):
        last += 1
    known = {_margin(each) for each in lines[: number - 1] if each.strip()} | {margin - margin % 4}
    if before.rstrip().endswith(":"):
        known = {_margin(before) + 4}
    for target in sorted(known, key=lambda each: (abs(each - margin), -each)):
        for end in dict.fromkeys((number, last)):
            moved = [
                " " * max(0, _margin(each) + target - margin) + each.strip() if each.strip() else each
                for each in lines[number - 1 : end]
            ]
            yield [*lines[: number - 1], *moved, *lines[end:]]


def _margin(line: str) -> int:
    spaces = line.expandtabs(4)
    return len(spaces) - len(spaces.lstrip())


def _diff(before: Sequence[str], after: Sequence[str]) -> list[Edit]:
    """The edits of all lines that differ; a line whose indentation differs is shown with the line above it."""
    found: list[Edit] = []
    number = 1
    while number <= len(before):
        first = number
        while number <= len(before) and before[number - 1] != after[number - 1]:
            number += 1
        if number > first:
            found.append(_edit(before, after, first, number - 1))
        number += 1
    return found


def _edit(before: Sequence[str], after: Sequence[str], first: int, last: int) -> Edit:
    if all(_indent(before[at]) == _indent(after[at]) for at in range(first - 1, last)) and first == last:
        return replace_lines(first, after[first - 1].strip())
    while first > 1 and (not after[first - 1].strip() or _indent(before[first - 1]) != _indent(after[first - 1])):
        first -= 1
    margin = len(_indent(after[first - 1]))
    shallow = min(len(_indent(each)) for each in after[first - 1 : last] if each.strip())
    while first > 1 and (margin > shallow or not after[first - 1].strip()):
        first -= 1
        margin = len(_indent(after[first - 1])) if after[first - 1].strip() else margin
    return replace_lines(first, "\n".join(each[margin:] for each in after[first - 1 : last]), last)


def _indent(line: str) -> str:
    return line[: len(line) - len(line.lstrip())]
