"""The check of one exercise: begun, watched, cancelled, begun anew on each save."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from tutor.content import Lesson
from tutor.invocation import command
from tutor.judge.events import ExerciseJudged
from tutor.judge.verdict import Status
from tutor.tui import messages
from tutor.tui.checking import Checking
from tutor.tui.control.files import Files
from tutor.tui.control.records import Records
from tutor.tui.control.remember import Memory
from tutor.tui.findings import Findings
from tutor.tui.screens.stage import Deed, Stage

CRASHED = (
    "This is a fault of ros-tutor or of the machine, not of your code. Check again; if it stays, run: "
    f"{command('doctor')}"
)


class Checks:
    """At most one check runs; `show` is told the findings each time they change."""

    def __init__(
        self, stage: Stage, files: Files, records: Records, memory: Memory, show: Callable[[Findings], object]
    ) -> None:
        self._stage, self._files, self._records, self._memory, self._show = stage, files, records, memory, show
        self.running: Checking | None = None
        self._checked: dict[str, dict[Path, str]] = {}
        """What each exercise's files held when they were last checked."""
        self._next: Lesson | None = None
        """What is to be checked when the running check has been cancelled."""
        self.deeds = {
            "check": Deed(self.check, lambda: self.running is None),
            "cancel": Deed(self.cancel, lambda: self.running is not None),
            "watch": Deed(self.watch),
        }

    def check(self) -> None:
        """Save and check the lesson that is shown."""
        if not self._files.needed_for("check"):
            self._begin(self._stage.session.lesson)
            if self._stage.has_class("-folded"):
                self._stage.show_page("criteria")

    def cancel(self) -> None:
        """Stop the running check; its processes are ended."""
        self._next = None
        self._stop("cancelling: your node is being ended")

    def watch(self) -> None:
        """Switch checking on save."""
        on = not self._stage.session.state.check_on_save
        self._memory.note(check_on_save=on)
        self._stage.say("Each save now begins a check." if on else "A save no longer begins a check.")
        self._stage.refresh_bindings()

    def saved(self, message: messages.FileSaved) -> None:
        """A file was saved: check anew, where that is wanted."""
        session = self._stage.session
        if not session.state.check_on_save or message.path not in session.paths or session.desk.missing(session.lesson):
            return
        if self.running is None:
            self._begin(session.lesson)
        else:
            self._next = session.lesson
            self._stop("begun anew: your file has changed")

    def edited(self) -> None:
        """A file holds something else now: verdicts on what it held before are marked, until that is back."""
        session = self._stage.session
        found = session.findings[session.lesson.id]
        checked, held = self._checked.get(session.lesson.id, {}), self._files.texts(session.lesson)
        outdated = any(held.get(path, text) != text for path, text in checked.items())
        if outdated != found.outdated:
            self._tell(replace(found, outdated=outdated))

    def _begin(self, lesson: Lesson) -> None:
        desk = self._stage.session.desk
        self.running = Checking(lesson.id, desk.check_command(lesson), desk.workspace.root, self._stage.post_message)
        self._tell(self._stage.session.findings[lesson.id].begun())
        self._stage.refresh_bindings()
        self._stage.work(self._run, lesson, self.running, group="check")

    async def _run(self, lesson: Lesson, checking: Checking) -> None:
        await self._files.save_all()
        self._checked[lesson.id] = self._files.texts(lesson)
        await checking.run()

    def _stop(self, note: str) -> None:
        if self.running is not None and not self.running.cancelled:
            self.running.cancel()
            self._tell(self._stage.session.findings[self.running.exercise].stopped(note))

    def event(self, message: messages.CheckEvent) -> None:
        """The running check has found something."""
        if self.running is None or self.running.cancelled:
            return
        self._tell(self._stage.session.findings[self.running.exercise].after(message.event))
        if isinstance(message.event, ExerciseJudged):
            self._records.add(message.event.result)

    def over(self, message: messages.CheckOver) -> None:
        """The check's process is gone."""
        self.running = None
        session = self._stage.session
        found = session.findings[message.exercise]
        if message.cancelled:
            found = found.stopped("cancelled")
        elif message.fault:
            found = found.broken(message.fault, CRASHED, message.evidence)
        elif found.checking:
            found = found.stopped()
        self._tell(found)
        self._stage.refresh_bindings()
        if self._next is not None:
            again, self._next = self._next, None
            self._begin(again)
        elif message.exercise != session.lesson.id and found.result is not None:
            word = "passed" if found.result.verdict is Status.PASSED else "is checked: not all criteria are met yet"
            self._stage.say(f"{message.exercise.upper()} {word}.")

    def leave(self) -> None:
        """End it for good."""
        self._next = None
        if self.running is not None:
            self.running.cancel()

    def _tell(self, found: Findings) -> None:
        self._stage.session.findings[found.exercise] = found
        self._show(found)
