"""Puts the skeletons of a lesson's files into the workspace: at its start, and again when a file is reset."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence

from tutor.content import Lesson
from tutor.errors import StorageError, WorkspaceError
from tutor.session.paths import short_path
from tutor.tui import commands, messages, wording
from tutor.tui.control.files import Files
from tutor.tui.control.host import HostScreen
from tutor.tui.control.records import Records


class Skeletons:
    """Starts a lesson, and resets its files; what needs the files offers to start it first."""

    def __init__(self, host: HostScreen, files: Files, records: Records) -> None:
        self._host, self._files, self._records = host, files, records
        host.register(commands.START, self.start)
        host.register(commands.RESET, self.reset)

    def offer_start_if_missing(self, what: str) -> bool:
        """Return whether some of the lesson's files are missing, in which case offer to put the skeletons there."""
        model = self._host.model
        if not (missing := model.session.missing(model.lesson)):
            return False
        text = (
            f"{_listed(missing)} not in your workspace yet, so there is nothing to {what}.\n\nPut the skeleton there?"
        )
        self._host.ask(f"Start {wording.label(model.lesson)}", text, "Start", self.start)
        return True

    def start(self) -> None:
        """Put the lesson's skeletons into the workspace."""
        self._host.start_worker(self._start, self._host.model.lesson, group="start", exclusive=True)

    async def _start(self, lesson: Lesson) -> None:
        try:
            placed = await asyncio.to_thread(self._host.model.session.start, lesson)
        except (WorkspaceError, StorageError) as error:
            self._host.show_error(str(error))
            return
        self._host.post_message(messages.Started(lesson.id, tuple(path.name for path in placed.written)))
        self._records.read()

    def started(self, message: messages.Started) -> None:
        """Show the code, now that the skeletons are in the workspace, unless it is to be run before it is read."""
        lesson = self._host.model.lesson
        if message.exercise != lesson.id:
            return
        self._files.watch()
        if not lesson.live.has_hidden_fault:
            self._host.show_page("code")
        if message.written:
            then = "r to run it, 4 to watch it" if lesson.live.has_hidden_fault else "e to edit, F9 to check"
            self._host.say(f"{_listed(message.written)} in your workspace: {then}.")
        else:
            self._host.say("Your files are there already; nothing was changed.")

    def reset(self) -> None:
        """Put the skeleton back, after asking for confirmation."""
        if self.offer_start_if_missing("reset"):
            return
        name = self._host.model.file.name
        text = f"{name} becomes the skeleton again.\n\nYour version is kept beside it as a backup."
        self._host.ask(f"Reset {name}", text, "Reset", self._reset)

    def _reset(self) -> None:
        self._host.start_worker(self._reset_now, group="start", exclusive=True)

    async def _reset_now(self) -> None:
        model = self._host.model
        lesson, file = model.lesson, model.file
        try:
            placed = await self._files.let_change((model.path,), model.session.reset, lesson, file)
        except (WorkspaceError, StorageError) as error:
            self._host.show_error(str(error))
            return
        if placed is not None:
            where = f" Yours is kept as {short_path(placed.backups[0])}." if placed.backups else ""
            self._host.say(f"{file.name} is the skeleton again.{where}", warn=True)


def _listed(names: Sequence[str]) -> str:
    """The names of files, with the verb: "a.py is", "a.py and b.py are", "a.py and 6 more files are"."""
    if len(names) > 2:
        return f"{names[0]} and {len(names) - 1} more files are"
    return f"{' and '.join(names)} {'is' if len(names) == 1 else 'are'}"
