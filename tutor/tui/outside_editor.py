"""Hands the terminal to the learner's own editor."""

from __future__ import annotations

import asyncio
import shlex
from pathlib import Path
from typing import Any

from textual.app import App, SuspendNotSupported


async def edit_outside(app: App[Any], editor: str, path: Path) -> str:
    """Open `path` in `editor` and wait for its end; what went wrong, or nothing."""
    try:
        command = [*shlex.split(editor), str(path)]
    except ValueError:
        return f"EDITOR is no command: {editor}"
    try:
        with app.suspend(), app.batch_update():
            process = await asyncio.create_subprocess_exec(*command)
            await process.wait()
    except SuspendNotSupported:
        return "This terminal cannot be handed to an editor: open the file in another one."
    except OSError as error:
        return f"{command[0]} cannot be started ({error.strerror}): set EDITOR to yours."
    return ""
