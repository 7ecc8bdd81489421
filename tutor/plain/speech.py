"""How lessons and verdicts are said: a line for each thought, without signs that a voice would stumble over."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from tutor.judge.result import CriterionResult, ExerciseResult
from tutor.judge.verdict import Status
from tutor.report.plain import details, evidence_lines, one_line, seconds, tally
from tutor.terminal_text import printable

WORDS = {
    Status.PASSED: "passed",
    Status.FAILED: "failed",
    Status.SKIPPED: "skipped",
    Status.ERROR: "could not be judged; this is no fault of your code",
}

_HEADING = re.compile(r"#+\s+(.*)")
_ITEM = re.compile(r"\s*(?:[-*+]|\d+\.)\s")
_MARKUP = re.compile(r"`+([^`]+)`+|\*\*(.+?)\*\*|(?<![\w*])\*([^*\s][^*]*)\*(?![\w*])|\[([^\]]+)\]\([^)]*\)")


@dataclass(frozen=True, slots=True)
class Section:
    """A part of a lesson: its title, and its lines as they are said."""

    title: str
    lines: tuple[str, ...]


def sections(markdown: str) -> list[Section]:
    """A lesson's text by its headings. A paragraph is one line; code is said line by line, between two words."""
    found: list[tuple[str, list[str]]] = []
    for title, line in _said(markdown):
        if title:
            found.append((line, []))
        elif found:
            found[-1][1].append(line)
        else:
            found.append(("Introduction", [line]))
    return [Section(title, tuple(lines)) for title, lines in found]


def _said(markdown: str) -> Iterator[tuple[bool, str]]:
    """Each line, and whether it is a heading."""
    paragraph: list[str] = []
    fenced = False
    for line in [*markdown.splitlines(), ""]:
        fence = line.lstrip().startswith("```")
        heading = None if fenced else _HEADING.fullmatch(line)
        ends = fence or fenced or heading is not None or not line.strip() or _ITEM.match(line) is not None
        if ends and paragraph:
            yield False, _plain(" ".join(paragraph))
            paragraph = []
        if fence:
            fenced = not fenced
            yield False, "Code:" if fenced else "End of code."
        elif fenced:
            if line.strip():
                yield False, line
        elif heading is not None:
            yield True, _plain(heading[1])
        elif line.strip():
            paragraph.append(line.strip())


def _plain(text: str) -> str:
    return _MARKUP.sub(lambda found: next(group for group in found.groups() if group is not None), text)


def outcome(result: ExerciseResult) -> str:
    """How a check ended, in a line."""
    verdict = {Status.PASSED: "passed", Status.ERROR: "could not be judged"}.get(result.verdict, "not passed yet")
    return f"{result.id} {result.title}: {verdict}. {tally(result)}, after {seconds(result.duration_s)}."


def headline(criterion: CriterionResult) -> str:
    """One criterion and how it ended."""
    bonus = " (bonus)" if criterion.bonus else ""
    return f"{criterion.id}{bonus}: {WORDS[criterion.verdict.status]}."


def diagnosis(criterion: CriterionResult) -> list[str]:
    """What there is to say about a criterion that was not passed."""
    found = details(criterion.verdict)
    code = [line for label, text in found if label == "next step" for line in text.split("\n")[1:]]
    said = [(label.capitalize(), _line(label, text)) for label, text in found]
    if criterion.verdict.status is Status.SKIPPED:  # there are many where one thing is wrong: a line each
        return [" ".join([headline(criterion), *(f"{text[:1].upper()}{text[1:]}." for _, text in said)])]
    lines = [f"{label}: {text}" for label, text in said]
    return [headline(criterion), f"The criterion: {criterion.text}.", *lines, *code]


def _line(label: str, text: str) -> str:
    """A part of a diagnosis in one line; the code of a next step, which has lines of its own, left out."""
    return one_line(text.split("\n")[0] if label == "next step" else text, 1000).replace("`", "")


def evidence(criterion: CriterionResult) -> list[str]:
    """What was seen, line by line."""
    lines = evidence_lines(criterion.verdict)
    return [f"Evidence, {counted(len(lines), 'line')}:", *lines] if lines else ["There is no further evidence."]


def code(text: str) -> list[str]:
    """A file's lines, empty ones left out."""
    return [line for line in printable(text).splitlines() if line.strip()]


def counted(number: int, thing: str) -> str:
    """A number of things: "1 line", "3 lines"."""
    return f"{number} {thing}{'' if number == 1 else 's'}"


def listed(words: Iterable[str]) -> str:
    """Words as people list them: "a, b and c"."""
    *most, last = words
    return f"{', '.join(most)} and {last}" if most else last
