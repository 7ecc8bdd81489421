"""Suspends the app and hands the terminal to the learner's own editor."""

from __future__ import annotations

import asyncio
import os
import shlex
import shutil
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from textual.app import App, SuspendNotSupported

from tutor.errors import EditorError
from tutor.process import prctl

VARIABLES = ("VISUAL", "EDITOR")
"""Environment variables that name the user's editor; the first one set wins."""

FALLBACKS = ("sensible-editor", "nano", "vim", "vi", "nvim", "micro", "emacs", "ed")
"""If no variable is set, the first of these that is installed; `sensible-editor` is Debian's and Ubuntu's choice."""


def editor_command(
    environ: Mapping[str, str] = os.environ, which: Callable[[str], str | None] = shutil.which
) -> list[str]:
    """Return the learner's editor as a command, without the file; `which` finds a program. Raises EditorError."""
    for variable in VARIABLES:
        if not (value := environ.get(variable, "").strip()):
            continue
        try:
            command = shlex.split(value)
        except ValueError as error:
            raise EditorError(f"{variable} is not a command ({str(error).lower()}): {value}") from error
        if not command or which(command[0]) is None:
            name = command[0] if command else value
            raise EditorError(f"There is no program {name}: set {variable} to your editor, or press e to edit here.")
        return command
    for name in FALLBACKS:
        if which(name) is not None:
            return [name]
    raise EditorError("No editor is installed: set EDITOR to yours, or press e to edit here.")


async def edit_outside(app: App[Any], path: Path) -> str:
    """Open `path` in the learner's editor, wait until it exits, and return what went wrong, or ""."""
    try:
        command = editor_command()
    except EditorError as error:
        return str(error)
    name, problem = command[0], ""
    try:
        prctl.adopt_orphans(False)  # processes that the editor leaves behind are the user's, not ours to reap
        with app.suspend(), app.batch_update():
            try:  # inside the `with`: the app gets the terminal back only if the block raises nothing
                process = await asyncio.create_subprocess_exec(*command, str(path))
                code = await process.wait()
            except OSError as error:
                problem = f"{name} cannot be started ({error.strerror}): set EDITOR to another one, or press e."
            else:
                if code:
                    how = f"exit code {code}" if code > 0 else f"signal {-code}"
                    problem = (
                        f"{name} ended with {how}. If it does not work here, set EDITOR to another one, or press e."
                    )
    except SuspendNotSupported:
        return "This terminal cannot be handed to an editor: open the file in another one."
    finally:
        prctl.adopt_orphans(True)
    return problem
