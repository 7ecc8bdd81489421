"""Lessons and verdicts as spoken lines: one line per thought, without symbols that a screen reader stumbles over."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from tutor.content.markdown_blocks import Code, Heading, Item, Paragraph, Table, blocks
from tutor.content.plain_text import without_markup
from tutor.invocation import with_program_name
from tutor.judge.result import CriterionResult, ExerciseResult
from tutor.judge.verdict import Status
from tutor.judge.wording import counted
from tutor.report.plain import details, evidence_lines, one_line, remark_lines, seconds, tally
from tutor.terminal_text import printable

if TYPE_CHECKING:
    from tutor.mistakes import Mistake

_STATUS_WORDS = {
    Status.PASSED: "passed",
    Status.FAILED: "failed",
    Status.SKIPPED: "skipped",
    Status.ERROR: "could not be judged; this is no fault of your code",
}


@dataclass(frozen=True, slots=True)
class Section:
    """A section of a lesson: its title, and its spoken lines."""

    title: str
    lines: tuple[str, ...]


def sections(markdown: str) -> list[Section]:
    """Split a lesson at its headings. A paragraph or a row of a table becomes one line; code stays as it is."""
    found: list[tuple[str, list[str]]] = []
    for block in blocks(markdown):
        if isinstance(block, Heading):
            found.append((block.text, []))
            continue
        if not found:
            found.append(("Introduction", []))
        found[-1][1].extend(_spoken(block))
    return [Section(title, tuple(lines)) for title, lines in found]


def _spoken(block: Paragraph | Item | Code | Table) -> Iterator[str]:
    match block:
        case Code(lines):
            yield "Code:"
            yield from (line for line in lines if line.strip())
            yield "End of code."
        case Table(_, rows):
            yield f"Table, {counted(len(rows), 'row')}:"
            yield from block.spoken_rows()
            yield "End of table."
        case _:
            yield block.text


def outcome(result: ExerciseResult) -> str:
    """Return the result of a check on one line."""
    verdict = {Status.PASSED: "passed", Status.ERROR: "could not be judged"}.get(result.verdict, "not passed yet")
    return f"{result.id} {result.title}: {verdict}. {tally(result)}, after {seconds(result.duration_s)}."


def headline(criterion: CriterionResult) -> str:
    """Return a criterion and its verdict."""
    bonus = " (bonus)" if criterion.bonus else ""
    return f"{criterion.id}{bonus}: {_STATUS_WORDS[criterion.verdict.status]}."


def diagnosis(criterion: CriterionResult) -> list[str]:
    """Return the diagnosis of a criterion that was not passed."""
    found = [detail for detail in details(criterion.verdict) if detail[0] != "more"]
    spoken = [(label.capitalize(), one_line(text, 1000).replace("`", "")) for label, text in found]
    if criterion.verdict.status is Status.SKIPPED:  # one fault can skip many: one line each
        return [" ".join([headline(criterion), *(f"{text[:1].upper()}{text[1:]}." for _, text in spoken)])]
    lines = [f"{label}: {text}" for label, text in spoken]
    return [headline(criterion), f"The criterion: {criterion.text}.", *lines]


def remarks(result: ExerciseResult) -> list[str]:
    """Return what works but will bite, one line each."""
    return [f"This works, but: {one_line(line, 1000)}".replace("`", "") for line in remark_lines(result)]


def page(mistake: Mistake) -> Iterator[str]:
    """Yield the page of a mistake. A paragraph becomes one line; code stays as it is, between two lines."""
    from tutor.mistakes.pages import sections_of  # late, since it loads the catalogue

    yield f"{mistake.title}: {without_markup(mistake.summary)}"
    for section in sections_of(mistake):
        if not section.code:
            heading = f"{section.heading}: " if section.heading else ""
            yield f"{heading}{without_markup(with_program_name(section.text))}"
            continue
        lines = code(section.text)
        yield f"{section.heading} example, {counted(len(lines), 'line')} of code:"
        yield from lines
        yield "End of code."


def evidence(criterion: CriterionResult) -> list[str]:
    """Return the evidence, line by line."""
    lines = evidence_lines(criterion.verdict)
    return [f"Evidence, {counted(len(lines), 'line')}:", *lines] if lines else ["There is no further evidence."]


def code(text: str) -> list[str]:
    """Return a file's lines without the empty ones."""
    return [line for line in printable(text).splitlines() if line.strip()]


def listed(words: Iterable[str]) -> str:
    """Return words as a list in prose: "a, b and c"."""
    *most, last = words
    return f"{', '.join(most)} and {last}" if most else last
