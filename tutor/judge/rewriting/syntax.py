"""A file that Python cannot read: the smallest change of its lines after which it can.

What is tried is what a slip of the keyboard leaves out or puts in: a bracket, a comma, a colon, a quotation mark, an
indentation. It serves the words of a diagnosis, never a verdict.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterator, Sequence

from tutor.judge.edits import Edit, describe_edits, replace_lines

_NEAR = 6
"""This many lines above the one that Python stops at may be the one at fault."""
_LONGEST = 20
"""This many lines below the one that opens a bracket may be the one that lacks its partner."""
_SLIPS = 3
"""This many slips in one file are fixed in one step."""
_ENDS = (")", "]", "}", ":", "):", "'", '"', "')", '")', "),", "],", "},", ",", "',", '",', "])", "))", "})", ")))")
_KEYWORDS = ("class", "def", "elif", "else:", "except", "finally:", "for", "from", "if", "import", "return", "while")
_OPEN = re.compile(r"'([(\[{])' was never closed")
_CLOSES = {"(": ")", "[": "]", "{": "}"}
_COMMENT = re.compile(r"\s+#[^'\"]*$")
_QUOTES = str.maketrans("\u201c\u201d\u2018\u2019", "\"\"''")


def make_readable(text: str, file: str = "") -> str | None:
    """The step after which Python can read the file; None where it can already, or where no small change helps."""
    found = slips(text)
    return describe_edits(text, found, file=file) if found else None


def slips(text: str) -> list[Edit] | None:
    """The same as edits."""
    lines = text.replace("\0", "").splitlines()
    for _ in range(_SLIPS):
        stop = _stop(lines)
        if stop is None:
            break
        reached = [(_stopped_at(each) or len(each) + 1, cost, each) for cost, each in _tried(lines, *stop)]
        furthest = max(reached, key=lambda each: (each[0], -each[1]), default=(0, 0.0, lines))
        if furthest[0] <= stop[0]:
            return None
        lines = furthest[2]
    return _changed(text.splitlines(), lines) if _stop(lines) is None else None


def _stop(lines: Sequence[str]) -> tuple[int, str] | None:
    """The line that Python stops at, and what it complains of; None where it can read them all."""
    try:
        compile("\n".join(lines) + "\n", "<read>", "exec", dont_inherit=True)
    except SyntaxError as error:
        return max(1, min(error.lineno or 1, len(lines))), error.msg
    except (ValueError, RecursionError, MemoryError):
        return 1, ""
    return None


def _stopped_at(lines: Sequence[str]) -> int | None:
    stop = _stop(lines)
    return stop[0] if stop is not None else None


def _tried(lines: Sequence[str], stop: int, complaint: str) -> Iterator[tuple[float, list[str]]]:
    """The lines after each change that may help, with what speaks against it: how far it is, and how unlikely."""
    for number in range(stop, max(0, stop - 1 - _NEAR), -1):
        line = lines[number - 1]
        if not line.strip():
            continue
        for order, new in enumerate(dict.fromkeys(_slips(line))):
            closes = abs(_balance(new)) < abs(_balance(line)) and _balance(new) == 0
            yield stop - number + order / 100 - 10 * closes, [*lines[: number - 1], new, *lines[number:]]
        for order, moved in enumerate(_indented(lines, number)):
            # What is not indented by fours is the likelier slip, and never the right place.
            unlikely = (_margin(line) % 4 == 0) + (_margin(moved[number - 1]) % 4 != 0)
            yield stop - number + 0.5 + order / 100 + _NEAR * unlikely, moved
        if line.rstrip().endswith(":"):
            yield stop - number + 3 * _NEAR, [*lines[: number - 1], f"{line.rstrip()} pass", *lines[number:]]
    if opened := _OPEN.search(complaint):  # Python tells where a bracket is opened; a call may go on for lines
        for number in range(stop + 1, min(stop + _LONGEST, len(lines)) + 1):
            for order, new in enumerate(_closed(lines[number - 1].rstrip(), (_CLOSES[opened[1]],))):
                closes = _balance(new) == 0 and bool(new.strip())
                yield number - stop + order / 100 - 10 * closes, [*lines[: number - 1], new, *lines[number:]]


def _balance(line: str) -> int:
    bare = re.sub(r"'[^']*'|\"[^\"]*\"", "", line)
    return sum(bare.count(each) for each in "([{") - sum(bare.count(each) for each in ")]}")


def _slips(line: str) -> Iterator[str]:
    """The line without a slip that it may have."""
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
    yield from _closed(code, _ENDS)
    for found in re.finditer(r"(?<=[\w'\")\]}]) +(?=[\w'\"(\[{])", code):
        yield f"{code[: found.start()]},{code[found.start() :]}"
    for found in re.finditer(r"[()\[\]{},:]", code):
        yield code[: found.start()] + code[found.end() :]
    word = code.split(maxsplit=1)[0] if code.strip() else ""
    for near in difflib.get_close_matches(word, _KEYWORDS, n=1, cutoff=0.6):
        yield code.replace(word, near, 1)


def _closed(code: str, ends: Sequence[str]) -> Iterator[str]:
    """The line with one of these at its end, or before what ends it."""
    for end in ends:
        yield code + end
        if code.endswith((",", ":")):
            yield code[:-1] + end + code[-1]


def _indented(lines: Sequence[str], number: int) -> Iterator[list[str]]:
    """The lines with this one, or with all that belongs to it, indented as one of those above is, or deeper."""
    before = next((each for each in reversed(lines[: number - 1]) if each.strip()), "")
    margin = _margin(lines[number - 1])
    last = number
    while last < len(lines) and (not lines[last].strip() or _margin(lines[last]) >= max(margin, 1)):
        last += 1
    known = {_margin(each) for each in lines[: number - 1] if each.strip()} | {margin - margin % 4}
    if before.rstrip().endswith(":"):
        known = {_margin(before) + 4}
    for wanted in sorted(known, key=lambda each: (abs(each - margin), -each)):
        for end in dict.fromkeys((number, last)):
            moved = [
                " " * max(0, _margin(each) + wanted - margin) + each.strip() if each.strip() else each
                for each in lines[number - 1 : end]
            ]
            yield [*lines[: number - 1], *moved, *lines[end:]]


def _margin(line: str) -> int:
    spaces = line.expandtabs(4)
    return len(spaces) - len(spaces.lstrip())


def _changed(before: Sequence[str], after: Sequence[str]) -> list[Edit]:
    """The lines that are others now; one that is indented otherwise is given with the line above it."""
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
    if all(_head(before[at]) == _head(after[at]) for at in range(first - 1, last)) and first == last:
        return replace_lines(first, after[first - 1].strip())
    while first > 1 and (not after[first - 1].strip() or _head(before[first - 1]) != _head(after[first - 1])):
        first -= 1
    margin = len(_head(after[first - 1]))
    shallow = min(len(_head(each)) for each in after[first - 1 : last] if each.strip())
    while first > 1 and (margin > shallow or not after[first - 1].strip()):
        first -= 1
        margin = len(_head(after[first - 1])) if after[first - 1].strip() else margin
    return replace_lines(first, "\n".join(each[margin:] for each in after[first - 1 : last]), last)


def _head(line: str) -> str:
    return line[: len(line) - len(line.lstrip())]
