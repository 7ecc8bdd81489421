"""What the systems around a class take: one renderer for each format."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from pathlib import Path

from tutor.grade.gradebook import Gradebook

DOCUMENTS = {"csv": "csv_table", "json": "json_document", "junit": "junit", "canvas": "canvas", "moodle": "moodle"}
"""Formats that are one document, and their modules, with `render(gradebook, template) -> str`. `template` is the
text of a file that the system has exported, for it to recognise its rows (`--gradebook`), or None."""

FILES = {"html": "html_pages", "gradescope": "gradescope", "classroom50": "classroom50", "check50": "check50"}
"""Formats that are several files, and their modules, with `files(gradebook) -> dict[str, str]`: from a path below the
folder of results to its text."""


def render(gradebook: Gradebook, format: str, template: str | None = None) -> str:
    """Render one of `DOCUMENTS`. Raises UsageError for a template that does not fit."""
    renderer: Callable[[Gradebook, str | None], str] = import_module(f"{__name__}.{DOCUMENTS[format]}").render
    return renderer(gradebook, template)


def files(gradebook: Gradebook, format: str) -> dict[str, str]:
    """Return the files of one of `FILES`, by their path below the folder of results."""
    make: Callable[[Gradebook], dict[str, str]] = import_module(f"{__name__}.{FILES[format]}").files
    return make(gradebook)


def write(gradebook: Gradebook, format: str, folder: Path) -> list[Path]:
    """Write the files of one of `FILES` below `folder`; return their paths. Raises StorageError."""
    from tutor.errors import StorageError
    from tutor.workspace import write_atomically

    written = []
    for name, text in files(gradebook, format).items():
        path = folder / name
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise StorageError.of(f"create {path.parent}", error) from error
        write_atomically(path, text)
        written.append(path)
    return written
