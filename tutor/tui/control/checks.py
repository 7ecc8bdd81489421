"""Runs the check of one exercise: starts, follows and cancels it, and restarts it on save."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial

from tutor import invocation
from tutor.content import Lesson
from tutor.judge.events import Event, ExerciseJudged
from tutor.judge.verdict import Status
from tutor.session.engine_process import CheckEnded, CheckProcess, EngineStarter
from tutor.session.findings import Findings
from tutor.tui import commands, messages
from tutor.tui.control.files import Files
from tutor.tui.control.host import HostScreen
from tutor.tui.control.preferences import Preferences
from tutor.tui.control.records import Records
from tutor.tui.control.skeletons import Skeletons
from tutor.workspace import Digests, LastCheck, digests_of, has_changed

CRASHED = (
    "This is a fault of ros-tutor or of the machine, not of your code. Check again; if it persists, run: "
    f"{invocation.command('doctor')}"
)


class Checks:
    """Runs at most one check at a time; `show` is called with the findings each time they change."""

    def __init__(
        self,
        host: HostScreen,
        files: Files,
        skeletons: Skeletons,
        records: Records,
        preferences: Preferences,
        show: Callable[[Findings], object],
    ) -> None:
        self._host, self._files, self._skeletons, self._records = host, files, skeletons, records
        self._preferences, self._show = preferences, show
        self.running: CheckProcess | None = None
        self._engines = EngineStarter(host.model.session.engine_command)
        self._judged: dict[str, Digests] = {}
        """The version of each exercise's files that was last judged, by exercise id."""
        self._recheck: Lesson | None = None
        """The lesson to check once the running check, being cancelled, has ended."""
        self._closing = False
        host.register(commands.CHECK, self.check, lambda: self.running is None)
        host.register(commands.CANCEL, self.cancel, lambda: self.running is not None)
        host.register(commands.WATCH, self.watch)
        host.register(commands.FIRST_FAILURE, self.end_at_first_failure)

    def check(self) -> None:
        """Save the files and check the current lesson."""
        if not self._skeletons.offer_start_if_missing("check"):
            self._begin(self._host.model.lesson)
            if self._host.has_class("-folded"):
                self._host.show_page("criteria")

    def cancel(self) -> None:
        """Cancel the running check and stop its processes."""
        self._recheck = None
        self._cancel_running("cancelling: your node is being stopped")

    def watch(self) -> None:
        """Toggle checking on save."""
        on = not self._host.model.state.check_on_save
        self._preferences.update(check_on_save=on)
        self._host.say("Each save now begins a check." if on else "A save no longer begins a check.")
        self._host.refresh_bindings()

    def end_at_first_failure(self) -> None:
        """Toggle whether checks end at their first failure."""
        on = not self._host.model.state.first_failure
        self._preferences.update(first_failure=on)
        self._host.say("A check now ends at its first failure." if on else "A check now judges every criterion.")

    def saved(self, message: messages.FileSaved) -> None:
        """Handle a saved file: check again, if checking on save is on."""
        model = self._host.model
        if not model.state.check_on_save or message.path not in model.paths or model.session.missing(model.lesson):
            self._keep_engine_ready()
            return
        if self.running is None:
            self._begin(model.lesson)
        elif self.running.exercise != model.lesson.id or self._differs(model.lesson) is not False:
            self._recheck = model.lesson
            self._cancel_running("started again: your file has changed")

    def edited(self) -> None:
        """Handle an edit."""
        self._keep_engine_ready()
        self.compare_files()

    def compare_files(self) -> None:
        """Mark the lesson's verdicts as outdated while its files differ from what was judged."""
        model = self._host.model
        found = model.findings[model.lesson.id]
        if (outdated := self._differs(model.lesson)) != found.outdated:
            self._update(replace(found, outdated=outdated))

    def restore(self, last: Mapping[str, LastCheck]) -> None:
        """Show these checks from before the app was started."""
        model = self._host.model
        for exercise, check in last.items():
            if (found := model.findings[exercise].with_kept(check)) is not model.findings[exercise]:
                model.findings[exercise] = found
                self._judged[exercise] = check.result.digests
        self.compare_files()

    def forget(self, lesson: Lesson) -> None:
        """Show no verdicts of a lesson whose files were replaced by others, which none of them is about."""
        if self.running is not None and self.running.exercise == lesson.id:
            self._cancel_running("stopped: your files were replaced")
        self._judged.pop(lesson.id, None)
        self._update(Findings.of(lesson))

    def _differs(self, lesson: Lesson) -> bool | None:
        return has_changed(self._judged.get(lesson.id, {}), self._files.digests(lesson))

    def _begin(self, lesson: Lesson) -> None:
        model = self._host.model
        arguments = model.session.check_arguments(lesson, first=model.state.first_failure)
        start = partial(self._engines.start, arguments, model.session.workspace.root)
        self.running = CheckProcess(lesson.id, start, partial(self._take, lesson.id))
        self._update(model.findings[lesson.id].with_check_started())
        self._host.refresh_bindings()
        self._host.start_worker(self._run, lesson, self.running, group="check")

    async def _run(self, lesson: Lesson, checking: CheckProcess) -> None:
        await self._files.save_all()
        paths = {file.name: self._host.model.session.path(file) for file in lesson.files}
        self._judged[lesson.id] = await asyncio.to_thread(digests_of, paths)
        await self._files.read_again(lesson)  # what is judged is what the editor shows
        self._end(await checking.run())

    def _cancel_running(self, note: str) -> None:
        if self.running is not None and not self.running.cancelled:
            self.running.cancel()
            self._update(self._host.model.findings[self.running.exercise].stopped(note))

    def _take(self, exercise: str, event: Event) -> None:
        """Apply an event of a check to the findings. The worker calls this on the app's own loop."""
        if isinstance(event, ExerciseJudged) and event.result.digests:
            self._judged[event.result.id] = event.result.digests
        self._update(self._host.model.findings[exercise].with_event(event))
        if isinstance(event, ExerciseJudged):
            self.compare_files()
            self._records.record_attempt(event.result)

    def _end(self, ended: CheckEnded) -> None:
        self.running = None
        model = self._host.model
        found = model.findings[ended.exercise]
        if ended.cancelled:
            found = found.stopped("cancelled")
        elif ended.fault:
            found = found.with_fault(ended.fault, CRASHED, ended.evidence)
        elif found.checking:
            found = found.stopped()
        self._update(found)
        self._host.refresh_bindings()
        if self._recheck is not None:
            lesson, self._recheck = self._recheck, None
            self._begin(lesson)
            return
        self._keep_engine_ready()
        if ended.exercise != model.lesson.id and found.result is not None:
            word = "passed" if found.result.verdict is Status.PASSED else "is checked: not all criteria are met yet"
            self._host.say(f"{ended.exercise.upper()} {word}.")

    def shut_down(self) -> None:
        """Cancel the running check, and start none after it."""
        self._closing = True
        self._recheck = None
        self._engines.release()
        if self.running is not None:
            self.running.cancel()

    def _keep_engine_ready(self) -> None:
        """Prepare for the next check, which is near. A server of many apps has no memory to spare for that."""
        host, session = self._host, self._host.model.session
        unneeded = self._engines.keeps_one or self.running is not None or self._closing
        if session.may_keep_engine and not unneeded and not host.app.is_web:
            host.start_worker(self._engines.keep_ready, session.workspace.root, group="check")

    def _update(self, found: Findings) -> None:
        self._host.model.findings[found.exercise] = found
        self._show(found)
