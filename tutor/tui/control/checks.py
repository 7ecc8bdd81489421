"""The check of one exercise: started, watched, cancelled, restarted on each save."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from tutor.content import Lesson
from tutor.invocation import command
from tutor.judge.events import ExerciseJudged
from tutor.judge.verdict import Status
from tutor.tui import messages
from tutor.tui.check_process import CheckProcess
from tutor.tui.control.files import Files
from tutor.tui.control.preferences import Preferences
from tutor.tui.control.records import Records
from tutor.tui.findings import Findings
from tutor.tui.screens.host import CommandHandler, HostScreen

CRASHED = (
    "This is a fault of ros-tutor or of the machine, not of your code. Check again; if it stays, run: "
    f"{command('doctor')}"
)


class Checks:
    """At most one check runs; `show` is told the findings each time they change."""

    def __init__(
        self,
        host: HostScreen,
        files: Files,
        records: Records,
        preferences: Preferences,
        show: Callable[[Findings], object],
    ) -> None:
        self._host, self._files, self._records, self._preferences, self._show = host, files, records, preferences, show
        self.running: CheckProcess | None = None
        self._checked: dict[str, dict[Path, str]] = {}
        """What each exercise's files held when they were last checked."""
        self._next: Lesson | None = None
        """What is to be checked when the running check has been cancelled."""
        self.command_handlers = {
            "check": CommandHandler(self.check, lambda: self.running is None),
            "cancel": CommandHandler(self.cancel, lambda: self.running is not None),
            "watch": CommandHandler(self.watch),
        }

    def check(self) -> None:
        """Save and check the lesson that is shown."""
        if not self._files.needed_for("check"):
            self._begin(self._host.session.lesson)
            if self._host.has_class("-folded"):
                self._host.show_page("criteria")

    def cancel(self) -> None:
        """Stop the running check; its processes are ended."""
        self._next = None
        self._stop("cancelling: your node is being ended")

    def watch(self) -> None:
        """Switch checking on save."""
        on = not self._host.session.state.check_on_save
        self._preferences.update(check_on_save=on)
        self._host.say("Each save now begins a check." if on else "A save no longer begins a check.")
        self._host.refresh_bindings()

    def saved(self, message: messages.FileSaved) -> None:
        """A file was saved: check again, where that is wanted."""
        session = self._host.session
        if (
            not session.state.check_on_save
            or message.path not in session.paths
            or session.app_services.missing(session.lesson)
        ):
            return
        if self.running is None:
            self._begin(session.lesson)
        else:
            self._next = session.lesson
            self._stop("started again: your file has changed")

    def edited(self) -> None:
        """A file holds something else now: verdicts on what it held before are marked, until that is back."""
        session = self._host.session
        found = session.findings[session.lesson.id]
        checked, held = self._checked.get(session.lesson.id, {}), self._files.texts(session.lesson)
        outdated = any(held.get(path, text) != text for path, text in checked.items())
        if outdated != found.outdated:
            self._tell(replace(found, outdated=outdated))

    def _begin(self, lesson: Lesson) -> None:
        app_services = self._host.session.app_services
        self.running = CheckProcess(
            lesson.id, app_services.check_command(lesson), app_services.workspace.root, self._host.post_message
        )
        self._tell(self._host.session.findings[lesson.id].begun())
        self._host.refresh_bindings()
        self._host.work(self._run, lesson, self.running, group="check")

    async def _run(self, lesson: Lesson, checking: CheckProcess) -> None:
        await self._files.save_all()
        self._checked[lesson.id] = self._files.texts(lesson)
        await checking.run()

    def _stop(self, note: str) -> None:
        if self.running is not None and not self.running.cancelled:
            self.running.cancel()
            self._tell(self._host.session.findings[self.running.exercise].stopped(note))

    def event(self, message: messages.CheckEvent) -> None:
        """The running check has found something."""
        if self.running is None or self.running.cancelled:
            return
        self._tell(self._host.session.findings[self.running.exercise].after(message.event))
        if isinstance(message.event, ExerciseJudged):
            self._records.add(message.event.result)

    def over(self, message: messages.CheckOver) -> None:
        """The check's process is gone."""
        self.running = None
        session = self._host.session
        found = session.findings[message.exercise]
        if message.cancelled:
            found = found.stopped("cancelled")
        elif message.fault:
            found = found.broken(message.fault, CRASHED, message.evidence)
        elif found.checking:
            found = found.stopped()
        self._tell(found)
        self._host.refresh_bindings()
        if self._next is not None:
            again, self._next = self._next, None
            self._begin(again)
        elif message.exercise != session.lesson.id and found.result is not None:
            word = "passed" if found.result.verdict is Status.PASSED else "is checked: not all criteria are met yet"
            self._host.say(f"{message.exercise.upper()} {word}.")

    def leave(self) -> None:
        """End it for good."""
        self._next = None
        if self.running is not None:
            self.running.cancel()

    def _tell(self, found: Findings) -> None:
        self._host.session.findings[found.exercise] = found
        self._show(found)
