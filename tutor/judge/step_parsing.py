"""Apply a next step to the learner's files literally, as a beginner would follow it."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from tutor.judge.source_changes import attributes_of_classes, differs_in_words, is_sound_change

_EDIT_FORMS = (
    ("become", re.compile(r"lines? (?P<first>\d+)(?: (?:to|and) (?P<last>\d+))?(?: becomes?)?:(?P<code>.*)")),
    ("remove", re.compile(r"remove lines? (?P<first>\d+)(?: (?:to|and) (?P<last>\d+))?(?P<code>\b.*)")),
    ("above", re.compile(r"write above line (?P<first>\d+), with the same indentation:(?P<code>.*)")),
    ("deeper", re.compile(r"write below line (?P<first>\d+), four spaces deeper:(?P<code>.*)")),
    ("below", re.compile(r"write below line (?P<first>\d+), with the same indentation:(?P<last>)(?P<code>.*)")),
    ("below", re.compile(r"write below line (?P<first>\d+), with the indentation of line (?P<last>\d+):(?P<code>.*)")),
    ("top", re.compile(r"at the top of the file:(?P<code>.*)")),
)


class NotAnEdit(Exception):
    """Raised for a step, or a part of one, that is not an edit of lines."""


def apply_step(step: str, files: Mapping[str, str]) -> dict[str, str]:
    """The files after following the step literally; its line numbers refer to the original files.

    Raises NotAnEdit if a part of the step names no place or no file.
    """
    changed = {name: list(enumerate(text.splitlines(), start=1)) for name, text in files.items()}
    originals = {name: text.splitlines() for name, text in files.items()}
    file = next(iter(files)) if len(files) == 1 else ""
    for part in _parts(step):
        if named := re.match(r"in (?P<file>[\w./-]+\.\w+)[,:] ", part):
            file, part = named["file"], part[named.end() :]
        if file not in changed:
            raise NotAnEdit(part)
        _apply_part(part, changed[file], originals[file])
    return {name: "".join(f"{line}\n" for _, line in lines) for name, lines in changed.items()}


def is_applicable(step: str, files: Mapping[str, str]) -> bool:
    """Whether the step can be followed literally, and changes files without breaking them (see `is_sound_change`)."""
    try:
        after = apply_step(step, files)
    except NotAnEdit:
        return False
    changed = [(text, after[name]) for name, text in files.items() if differs_in_words(text, after[name])]
    defined = attributes_of_classes(files.values()) if len(files) > 1 else ()
    return bool(changed) and all(is_sound_change(text, edited, defined) for text, edited in changed)


def _parts(step: str) -> list[str]:
    """Split a step into its parts: each starts at column 0, and the indented lines below it belong to it."""
    parts: list[str] = []
    for line in step.splitlines():
        if parts and (line.startswith(" ") or not line):
            parts[-1] += f"\n{line}"
        else:
            parts.append(line)
    return parts


def _apply_part(part: str, lines: list[tuple[int, str]], original: Sequence[str]) -> None:
    """Apply one part to `lines`, a file as (original line number, or 0 for a new line; text)."""
    head, *below = part.split("\n")
    kind, found = next(((kind, found) for kind, each in _EDIT_FORMS if (found := re.fullmatch(each, head))), ("", None))
    if found is None:
        raise NotAnEdit(part)
    code = [line[4:] for line in below] or [found["code"].strip()]
    if kind == "top":
        lines[:0] = [(0, line) for line in code]
        return
    first = int(found["first"])
    last = int(found["last"] or first) if kind in ("become", "remove") else first
    if not 1 <= first <= last <= len(original):
        raise NotAnEdit(part)
    like = original[int(found["last"] or first) - 1 if kind == "below" else first - 1]
    margin = like[: len(like) - len(like.lstrip())] + ("    " if kind == "deeper" else "")
    new = [(0, f"{margin}{line}" if line else "") for line in code]
    place = next((at for at, (number, _) in enumerate(lines) if number == first), None)
    if place is None:  # an earlier part replaced or removed it
        raise NotAnEdit(part)
    end = next(at for at, (number, _) in enumerate(lines) if number == last) + 1
    match kind:
        case "become":
            lines[place:end] = new
        case "remove":
            del lines[place:end]
        case "above":
            lines[place:place] = new
        case _:
            lines[end:end] = new
