"""A test submission as a patch: what of the solution becomes what.

    says: it publishes on a topic of another name
    change:
      - from: /lamp/status              # what the solution has, exactly once
        to: /lamp/state                 # what becomes of it; without `to`, it is taken out
        in: lamp.py                     # only where the exercise has several files
    fails: [status]
    mistake: wrong-topic

`from` is a part of one line; or whole lines (`|`), whose common indentation does not count.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from textwrap import indent

from tutor.content.fields import Fields
from tutor.content.model import Lesson
from tutor.errors import ContentError


@dataclass(frozen=True, slots=True)
class Change:
    """One place of the solution that becomes another. `file` is empty if the exercise has only one.

    `source` and `line` say where the change itself is written.
    """

    old: str
    new: str
    file: str
    source: Path
    line: int | None

    def error(self, message: str) -> ContentError:
        """Return an error about this change."""
        return ContentError(self.source, message, line=self.line, field="change")


def read_changes(fields: Fields, source: Path) -> tuple[Change, ...]:
    """Take the field `change`; empty if absent. Raises ContentError."""
    return tuple(_read_change(change, source) for change in fields.mappings("change", optional=True))


def _read_change(fields: Fields, source: Path) -> Change:
    line = fields.error("from", "").line
    old, new = _read_code(fields, "from"), _read_code(fields, "to")
    if not old:
        raise fields.error("from", "this field is missing: say what of the solution changes")
    change = Change(old, new, fields.text("in", optional=True), source, line)
    fields.done()
    return change


def _read_code(fields: Fields, name: str) -> str:
    value = fields.anything(name)
    if value is None:
        return ""
    if not isinstance(value, str):
        raise fields.error(name, f"{value} is read as a value, not as text: put it in quotes")
    return value.strip("\n").rstrip()


def patched(lesson: Lesson, changes: Sequence[Change]) -> Mapping[str, str]:
    """Return the solution's files with these changes, by name. Raises ContentError for a change that does not fit."""
    sources = {file.name: file.solution.read_text(encoding="utf-8") for file in lesson.files if file.solution.is_file()}
    for change in changes:
        name = change.file or (next(iter(sources)) if len(sources) == 1 else "")
        if name not in sources:
            raise change.error(f"say with `in` which file it changes: {' or '.join(sources)}")
        sources[name] = _apply(change, name, sources[name])
    return sources


def write_patched(lesson: Lesson, changes: Sequence[Change], folder: Path) -> None:
    """Write the solution's files with these changes into a folder, which is made. Raises ContentError and OSError."""
    folder.mkdir(parents=True)
    for name, source in patched(lesson, changes).items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(source, encoding="utf-8")


def _apply(change: Change, name: str, source: str) -> str:
    by_lines = "\n" in change.old or "\n" in change.new
    found = list(_by_lines(change, source) if by_lines else _by_words(change, source))
    if len(found) == 1:
        return found[0]
    first, *others = change.old.splitlines()
    what = f"`{first} …`" if others else f"`{first}`"
    if not found:
        raise change.error(
            f"the solution's {name} has no {what}{' as whole lines: check their indentation' if by_lines else ''}"
        )
    raise change.error(f"the solution's {name} has {what} {len(found)} times: name more of it")


def _by_words(change: Change, source: str) -> list[str]:
    parts = source.split(change.old)
    return [
        change.old.join(parts[:number]) + change.new + change.old.join(parts[number:])
        for number in range(1, len(parts))
    ]


def _by_lines(change: Change, source: str) -> list[str]:
    lines, old = source.splitlines(), change.old.splitlines()
    found = []
    for start, line in enumerate(lines):
        margin = line[: len(line) - len(line.lstrip())]
        if lines[start : start + len(old)] == indent(change.old, margin).splitlines():
            new = indent(change.new, margin).splitlines()
            found.append("\n".join([*lines[:start], *new, *lines[start + len(old) :]]) + "\n")
    return found
