"""The pages of the catalogue of mistakes, as HTML."""

from __future__ import annotations

import difflib
from collections.abc import Iterator, Mapping
from functools import cache

from tutor.content import Checklist, Course
from tutor.engine.loading import load_catalogues
from tutor.grade.formats.html.markup import Html, element, inline, joined
from tutor.grade.gradebook import Gradebook
from tutor.mistakes.entry import Mistake
from tutor.mistakes.pages import Section, every_mistake, in_markdown, sections_of

_EXAMPLES = {"Bad": ("bad", "✗ Bad"), "Good": ("good", "✓ Good")}


class Explanations:
    """What there is to say of each mistake, whatever the learner."""

    def __init__(self, mistakes: Mapping[str, Mistake]) -> None:
        self._mistakes = mistakes
        self.page = cache(self._page)

    @classmethod
    def of(cls, gradebook: Gradebook) -> Explanations:
        """Return the pages for the gradebook's exercises. Raises EngineError for a course that is broken."""
        return cls(every_mistake(load_catalogues(Course(gradebook.lessons, Checklist()))))

    def __contains__(self, mistake: str) -> bool:
        return mistake in self._mistakes

    def title(self, mistake: str) -> str:
        """Return what a mistake is called; the id of one that has no page."""
        return self._mistakes[mistake].title if mistake in self._mistakes else mistake

    def summary(self, mistake: str) -> str:
        """Return a mistake in one sentence; "" if it has no page."""
        return self._mistakes[mistake].summary if mistake in self._mistakes else ""

    def _page(self, mistake: str) -> Html:
        """Return the page of a mistake, without its title. Raises KeyError."""
        entry = self._mistakes[mistake]
        summary = element("p", inline(in_markdown(entry.summary)), class_="summary")
        return element("div", summary, *_parts(list(sections_of(entry))), class_="explanation")


def _parts(sections: list[Section]) -> Iterator[Html]:
    code = {section.heading: section.text for section in sections if section.code}
    items: list[Html] = []
    for section in sections:
        if section.text.startswith("- ") and not section.code:
            items.append(element("li", inline(in_markdown(section.text[2:]))))
            continue
        if items:
            yield element("ul", *items)
            items = []
        if section.code:
            yield _example(section, next((other for name, other in code.items() if name != section.heading), ""))
        else:
            label = (element("strong", f"{section.heading}:"), " ") if section.heading else ()
            yield element("p", *label, inline(in_markdown(section.text)))
    if items:
        yield element("ul", *items)


def _example(section: Section, other: str) -> Html:
    """Return an example of code, in which the lines that are not in the other one stand out."""
    kind, caption = _EXAMPLES.get(section.heading, ("", section.heading))
    changed = _lines_only_in(section.text, other) if other else set()
    lines = (
        element("span", line, class_="changed") if number in changed else line
        for number, line in enumerate(section.text.splitlines())
    )
    code = element("pre", element("code", joined(lines, "\n")))
    return element("figure", *([element("figcaption", caption)] if caption else []), code, class_=kind or False)


def _lines_only_in(source: str, other: str) -> set[int]:
    lines = source.splitlines()
    blocks = difflib.SequenceMatcher(None, lines, other.splitlines(), autojunk=False).get_matching_blocks()
    common = {block.a + step for block in blocks for step in range(block.size)}
    return {number for number, line in enumerate(lines) if number not in common and line.strip()}
