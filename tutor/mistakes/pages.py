"""Pages of the catalogue: found by id or by words, and written as Markdown or plain text."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from tutor.mistakes.entry import CATALOGUE, Catalogue, Mistake

_HEADING = re.compile(r"(Bad|Good|See it|Lesson):(?: |$)")


@dataclass(frozen=True, slots=True)
class Section:
    """A part of a page under one heading ("" before the first): a paragraph on one line, or lines of `code`."""

    heading: str
    text: str
    code: bool = False


def sections_of(entry: Mistake) -> Iterator[Section]:
    """Yield the parts of a page below its first line: paragraphs and items of lists, and whole examples of code."""
    heading, lines, code = "", list[str](), False

    def ended() -> Iterator[Section]:
        text = "\n".join(lines).strip("\n") if code else " ".join(line.strip() for line in lines).strip()
        lines.clear()
        if text:
            yield Section(heading, text, code)

    for line in entry.page.splitlines()[1:]:
        if code and not line.strip():
            lines.append("")
            continue
        found, indented = _HEADING.match(line), line.startswith("    ")
        if not line.strip() or found or line.startswith("- ") or indented != code:
            yield from ended()
        code = indented
        heading = found[1] if found else heading
        lines.append(line[found.end() :] if found else line.removeprefix("    "))
    yield from ended()


def every_mistake(catalogues: Sequence[Catalogue] = ()) -> Mapping[str, Mistake]:
    """All mistakes by id, those of other catalogues (an exercise's, a course's) first."""
    found: dict[str, Mistake] = {}
    for catalogue in (*catalogues, CATALOGUE):
        for entry in catalogue.entries.values():
            found.setdefault(entry.id, entry)
    return found


def search(words: str, mistakes: Iterable[Mistake]) -> list[Mistake]:
    """The mistakes whose id or page has all these words, those with the words in id or title first."""
    wanted = [word.casefold() for word in words.replace("-", " ").split()]

    def place(entry: Mistake) -> int:
        name = f"{entry.id} {entry.title}".replace("-", " ").casefold()
        texts = (name, f"{name} {entry.summary.casefold()}", f"{name} {entry.page.casefold()}")
        return next((at for at, text in enumerate(texts) if all(word in text for word in wanted)), len(texts))

    ranked = [(place(entry), entry) for entry in mistakes]
    return [entry for at, entry in sorted(ranked, key=lambda pair: pair[0]) if at < 3]


def nearest(id: str, mistakes: Iterable[str]) -> list[str]:
    """Of the ids of these mistakes, those that are spelled nearly like this one."""
    return difflib.get_close_matches(id.lower().replace(" ", "-"), list(mistakes), n=3)


def text_of(entry: Mistake) -> str:
    """The page as plain text: its name in the first line, each paragraph on one line, code indented."""
    paragraphs = entry.page.partition("\n")[2].strip("\n").split("\n\n")
    joined = (
        paragraph if paragraph.startswith("    ") else " ".join(paragraph.splitlines()) for paragraph in paragraphs
    )
    return f"{entry.id}: {entry.summary}\n\n" + "\n\n".join(joined) + "\n"


_CODE = re.compile(
    r"<[^<>]+>|[\w.@]+\([^()]*\)(?:\.\w+(?:\([^()]*\))?)*|\w+=[\w.]*\w|[\w.@/]*_(?:[\w.]*\w)?…?|\w*[*]+\w*|\d+\^\d+"
)
"""What is code in the prose of a page: calls, names with an underscore, keywords, objects as Python shows them."""


def in_markdown(text: str) -> str:
    """A page's prose as Markdown: what is code in it, and not in backticks yet, is put into them."""
    parts = text.split("`")
    parts[::2] = [_CODE.sub(r"`\g<0>`", part) for part in parts[::2]]
    return "`".join(parts)


def explanation_of(entry: Mistake) -> str:
    """What a page says between its first line and its examples, as one paragraph."""
    between = entry.page.partition("\n")[2].partition("\nBad:\n")[0]
    return " ".join(between.split())


def markdown_of(entry: Mistake) -> str:
    """The page as Markdown, with its name as a heading of level 2."""
    lines = [f"## {entry.id}", "", f"**{in_markdown(entry.summary)}**", ""]
    block: list[str] = []
    for line in [*entry.page.splitlines()[2:], ""]:
        if line.startswith("    ") or (block and not line.strip()):
            block.append(line[4:])
            continue
        if block:
            while block and not block[-1].strip():
                block.pop()
            lines += ["```python", *block, "```", ""]
            block = []
        lines.append(in_markdown(line))
    return "\n".join(lines).rstrip("\n") + "\n"
