"""The two lines above the code: the lesson's files, and links to the views of the one shown."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from pathlib import Path

from textual.content import Content

from tutor.session.paths import short_path

_READ_ONLY_VIEWS = (
    ("skeleton", "k", "Skeleton"),
    ("changes", "d", "Changes"),
    ("solution", "v", "Solution"),
    ("against", "V", "Compare"),
)
"""Name, key and label of each read-only view."""


def file_line(paths: Sequence[Path], chosen: int, unsaved: Collection[Path], *, in_editor: bool, keys: bool) -> Content:
    """Return the names of the files, whether all is saved, and the folder of the chosen one; a click chooses another.

    `in_editor`: whether the chosen file has an editor. `keys`: whether letters are commands now.
    """
    shown = paths[chosen]
    parts: list[Content | str | tuple[str, str]] = []
    for index, path in enumerate(paths):
        mark = "● " if path in unsaved else ""
        if index == chosen:
            parts += [Content.styled(mark + path.name, "bold $primary"), "  "]
        else:
            parts += [mark, Content.from_markup(f"[@click=screen.show_file({index})]$name[/]", name=path.name), "  "]
    if len(paths) > 1 and keys:
        parts.append(("f: other file  ", "$quiet"))
    if in_editor:
        parts.append(("not saved yet  ", "$warn") if shown in unsaved else ("✓ saved  ", "$good"))
    parts.append((short_path(shown.parent), "$quiet"))
    return Content.assemble(*parts)


def view_line(*, editable: bool, keys: bool) -> Content:
    """Return the keys of the views of the learner's own file, which is shown.

    `editable`: whether a key leads to its editor. `keys`: whether letters are commands now.
    """
    parts: list[Content | str | tuple[str, str]] = []
    if editable:
        parts += [("e", "bold $accent"), (" edit  ", "$quiet")]
    if not keys:
        parts.append(("Esc, then  ", "$quiet"))
    for view, key, name in _READ_ONLY_VIEWS:
        parts += [(key, "bold $accent"), " ", Content.from_markup(f"[@click=screen.do('{view}')]{name}[/]"), "  "]
    return Content.assemble(*parts)


def back_line(title: str) -> Content:
    """Return the title of the read-only view that is shown, and the way back to the learner's own file."""
    return Content.assemble((title, "bold"), "  ", Content.from_markup("[@click=back]Esc: your file[/]"))
