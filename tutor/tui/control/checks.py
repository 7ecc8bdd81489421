"""The check of one exercise: started, watched, cancelled, restarted on each save."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from tutor import invocation
from tutor.content import Lesson
from tutor.judge.events import Event, ExerciseJudged
from tutor.judge.verdict import Status
from tutor.session.check_process import CheckEnded, CheckProcess
from tutor.session.findings import Findings
from tutor.tui import commands, messages
from tutor.tui.control.files import Files
from tutor.tui.control.host import HostScreen
from tutor.tui.control.preferences import Preferences
from tutor.tui.control.records import Records

CRASHED = (
    "This is a fault of ros-tutor or of the machine, not of your code. Check again; if it stays, run: "
    f"{invocation.command('doctor')}"
)


class Checks:
    """At most one check runs; `show` is called with the findings each time they change."""

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
        host.register(commands.CHECK, self.check, lambda: self.running is None)
        host.register(commands.CANCEL, self.cancel, lambda: self.running is not None)
        host.register(commands.WATCH, self.watch)
        host.register(commands.FIRST_FAILURE, self.end_at_first_failure)

    def check(self) -> None:
        """Save and check the lesson that is shown."""
        if not self._files.needed_for("check"):
            self._begin(self._host.model.lesson)
            if self._host.has_class("-folded"):
                self._host.show_page("criteria")

    def cancel(self) -> None:
        """Stop the running check; its processes are ended."""
        self._next = None
        self._stop("cancelling: your node is being ended")

    def watch(self) -> None:
        """Switch checking on save."""
        on = not self._host.model.state.check_on_save
        self._preferences.update(check_on_save=on)
        self._host.say("Each save now begins a check." if on else "A save no longer begins a check.")
        self._host.refresh_bindings()

    def end_at_first_failure(self) -> None:
        """Switch whether checks end at their first failure."""
        on = not self._host.model.state.first_failure
        self._preferences.update(first_failure=on)
        self._host.say("A check now ends at its first failure." if on else "A check now judges every criterion.")

    def saved(self, message: messages.FileSaved) -> None:
        """A file was saved: check again, where that is wanted."""
        model = self._host.model
        if not model.state.check_on_save or message.path not in model.paths or model.session.missing(model.lesson):
            return
        if self.running is None:
            self._begin(model.lesson)
        else:
            self._next = model.lesson
            self._stop("started again: your file has changed")

    def edited(self) -> None:
        """A file holds something else now: verdicts on what it held before are marked, until that is back."""
        model = self._host.model
        found = model.findings[model.lesson.id]
        checked, held = self._checked.get(model.lesson.id, {}), self._files.texts(model.lesson)
        outdated = any(held.get(path, text) != text for path, text in checked.items())
        if outdated != found.outdated:
            self._tell(replace(found, outdated=outdated))

    def _begin(self, lesson: Lesson) -> None:
        model = self._host.model
        command = model.session.check_command(lesson, first=model.state.first_failure)
        self.running = CheckProcess(lesson.id, command, model.session.workspace.root, self._post)
        self._tell(model.findings[lesson.id].begun())
        self._host.refresh_bindings()
        self._host.work(self._run, lesson, self.running, group="check")

    def _post(self, event: Event | CheckEnded) -> None:
        if isinstance(event, CheckEnded):
            self._host.post_message(messages.CheckOver(event))
        else:
            self._host.post_message(messages.CheckEvent(event))

    async def _run(self, lesson: Lesson, checking: CheckProcess) -> None:
        await self._files.save_all()
        self._checked[lesson.id] = self._files.texts(lesson)
        await checking.run()

    def _stop(self, note: str) -> None:
        if self.running is not None and not self.running.cancelled:
            self.running.cancel()
            self._tell(self._host.model.findings[self.running.exercise].stopped(note))

    def event(self, event: Event) -> None:
        """The running check has found something."""
        if self.running is None or self.running.cancelled:
            return
        self._tell(self._host.model.findings[self.running.exercise].after(event))
        if isinstance(event, ExerciseJudged):
            self._records.add(event.result)

    def over(self, ended: CheckEnded) -> None:
        """The check's process is gone."""
        self.running = None
        model = self._host.model
        found = model.findings[ended.exercise]
        if ended.cancelled:
            found = found.stopped("cancelled")
        elif ended.fault:
            found = found.broken(ended.fault, CRASHED, ended.evidence)
        elif found.checking:
            found = found.stopped()
        self._tell(found)
        self._host.refresh_bindings()
        if self._next is not None:
            again, self._next = self._next, None
            self._begin(again)
        elif ended.exercise != model.lesson.id and found.result is not None:
            word = "passed" if found.result.verdict is Status.PASSED else "is checked: not all criteria are met yet"
            self._host.say(f"{ended.exercise.upper()} {word}.")

    def leave(self) -> None:
        """End it for good."""
        self._next = None
        if self.running is not None:
            self.running.cancel()

    def _tell(self, found: Findings) -> None:
        self._host.model.findings[found.exercise] = found
        self._show(found)
