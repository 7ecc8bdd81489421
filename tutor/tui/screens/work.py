"""What the learner has done to their files and node: start, edit, run, check, hint, solution."""

from __future__ import annotations

import asyncio
import shlex
import signal
from collections.abc import Callable
from typing import Any

from textual import on
from textual.app import SuspendNotSupported
from textual.screen import Screen
from textual.widgets import Tabs

from tutor.content import Lesson
from tutor.judge.events import ExerciseJudged
from tutor.judge.result import ExerciseResult
from tutor.judge.verdict import Status
from tutor.tui import messages, words
from tutor.tui.checking import Checking
from tutor.tui.desk import Desk, domain_id
from tutor.tui.findings import Findings
from tutor.tui.node import Node
from tutor.tui.screens.confirm import ConfirmScreen
from tutor.tui.screens.hint import HintScreen
from tutor.tui.screens.solution import SolutionScreen
from tutor.tui.widgets.criteria import CriteriaPanel
from tutor.tui.widgets.log_pane import LogPane
from tutor.tui.widgets.status_bar import StatusBar
from tutor.workspace import Progress, StorageError, WorkspaceError

CRASHED = (
    "This is a fault of ros-tutor or of the machine, not of your code. Check again; if it stays, run: ros-tutor doctor"
)


class Work(Screen[None]):
    """The actions on one lesson. Workers tell what happens by messages; the handlers show it."""

    desk: Desk
    lesson: Lesson
    findings: dict[str, Findings]
    progress: Progress
    file_index: int
    checking: Checking | None = None
    node: Node | None = None

    def show_page(self, name: str) -> None:
        """Turn to a page."""
        raise NotImplementedError

    # --- which actions make sense now ---

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """Hide what makes no sense now: one key is Run or Stop, Check or Cancel."""
        running = self.node is not None and self.node.state.alive
        possible = {
            "run_node": not running,
            "stop_node": running,
            "check": self.checking is None,
            "cancel_check": self.checking is not None,
            "next_file": len(self.lesson.files) > 1,
        }
        return possible.get(action, True)

    def can(self, action: str) -> bool:
        """Whether an action makes sense now."""
        return self.check_action(action, ()) is True

    # --- the files ---

    def action_start_exercise(self) -> None:
        self.run_worker(self._start(self.lesson), group="start", exclusive=True)

    async def _start(self, lesson: Lesson) -> None:
        try:
            placed = await asyncio.to_thread(self.desk.start, lesson)
        except (WorkspaceError, StorageError) as error:
            self.post_message(messages.Trouble(str(error)))
            return
        self.post_message(messages.Started(lesson.id, tuple(path.name for path in placed.written)))
        await self._read_progress()

    @on(messages.Started)
    def _started(self, message: messages.Started) -> None:
        if message.exercise != self.lesson.id:
            return
        self.show_page("code")
        if message.written:
            self.notify(f"{' and '.join(message.written)} is in your workspace: press e to edit, then c to check.")
        else:
            self.notify("Your files are there already; nothing was changed.")

    def _needs_files(self, then: str) -> bool:
        """Whether files are missing; then the start is offered."""
        if not (missing := self.desk.missing(self.lesson)):
            return False
        names = " and ".join(missing)
        text = f"{names} is not in your workspace yet, so there is nothing to {then}.\n\nPut the skeleton there?"
        self._ask(f"Start {words.label(self.lesson)}", text, "Start", self.action_start_exercise)
        return True

    def _ask(self, title: str, text: str, yes: str, do: Callable[[], object]) -> None:
        def answered(answer: bool | None) -> None:
            if answer:
                do()

        self.app.push_screen(ConfirmScreen(title, text, yes), answered)

    async def action_edit(self) -> None:
        if self._needs_files("edit"):
            return
        path = self.desk.path(self.lesson.files[self.file_index])
        command = [*shlex.split(self.desk.editor()), str(path)]
        # Ctrl+C in the editor reaches us too; a handler that does nothing is reset to the default in the editor itself.
        before = signal.signal(signal.SIGINT, lambda *_: None)
        try:
            with self.app.suspend(), self.app.batch_update():
                process = await asyncio.create_subprocess_exec(*command)
                await process.wait()
        except SuspendNotSupported:
            self.post_message(
                messages.Trouble("This terminal cannot be handed to an editor: open the file in another one.")
            )
        except OSError as error:
            self.post_message(
                messages.Trouble(f"{command[0]} cannot be started ({error.strerror}): set EDITOR to yours.")
            )
        finally:
            signal.signal(signal.SIGINT, before)
        self.show_page("code")
        self.refresh(layout=True)

    # --- the node ---

    def action_run_node(self) -> None:
        if self._needs_files("run"):
            return
        self.run_worker(self._run_node(), group="node")

    async def _run_node(self) -> None:
        file = self.lesson.files[self.file_index]
        if not self.desk.path(file).exists():
            self.post_message(messages.Trouble(f"{file.name} is not in your workspace yet."))
            return
        try:
            command = await asyncio.to_thread(self.desk.node_command, file)
        except OSError as error:
            self.post_message(messages.Trouble(f"The node cannot be started: {error.strerror or error}"))
            return
        self.node = Node(command, lambda state: self.post_message(messages.NodeChanged(state)))
        self.post_message(messages.NodeChanged(self.node.state, first=True))
        await self.node.run()

    def action_stop_node(self) -> None:
        if self.node is not None:
            self.node.stop()

    @on(messages.NodeChanged)
    def _node_changed(self, message: messages.NodeChanged) -> None:
        self.query_one(LogPane).show(message.state, domain_id())
        self.query_one(StatusBar).show_node(message.state, domain_id())
        self.refresh_bindings()
        if message.first:
            self.show_page("log")

    # --- the check ---

    def action_check(self) -> None:
        if self._needs_files("check"):
            return
        lesson = self.lesson
        self.checking = Checking(
            lesson.id, self.desk.check_command(lesson), self.desk.workspace.root, self.post_message
        )
        self._show_findings(self.findings[lesson.id].begun())
        self.refresh_bindings()
        if self.has_class("-folded"):
            self.show_page("criteria")
        self.run_worker(self.checking.run(), group="check")

    def action_cancel_check(self) -> None:
        if self.checking is not None and not self.checking.cancelled:
            self.checking.cancel()
            self._show_findings(self.findings[self.checking.exercise].stopped("cancelling: your node is being ended"))

    @on(messages.CheckEvent)
    def _check_event(self, message: messages.CheckEvent) -> None:
        if self.checking is None or self.checking.cancelled:
            return
        self._show_findings(self.findings[self.checking.exercise].after(message.event))
        if isinstance(message.event, ExerciseJudged):
            self.run_worker(self._record(message.event.result), group="progress")

    @on(messages.CheckOver)
    def _check_over(self, message: messages.CheckOver) -> None:
        self.checking = None
        found = self.findings[message.exercise]
        if message.cancelled:
            found = found.stopped("cancelled")
        elif message.fault:
            found = found.broken(message.fault, CRASHED, message.evidence)
        elif found.checking:
            found = found.stopped()
        self._show_findings(found)
        self.refresh_bindings()
        if message.exercise != self.lesson.id and found.result is not None:
            word = "passed" if found.result.verdict is Status.PASSED else "is checked: not all criteria are met yet"
            self.notify(f"{message.exercise.upper()} {word}.")

    def _show_findings(self, found: Findings) -> None:
        self.findings[found.exercise] = found
        if found.exercise == self.lesson.id:
            self.query_one(CriteriaPanel).show_findings(found)
        self.query_one(StatusBar).show_check(found)
        self.query_one(Tabs).query_one("#tab-criteria").set_class(found.checking, "-busy")

    # --- progress ---

    def read_progress(self) -> None:
        """Read it from disk, in the background."""
        self.run_worker(self._read_progress(), group="progress")

    async def _read_progress(self) -> None:
        await self._progress(self.desk.progress)

    async def _record(self, result: ExerciseResult) -> None:
        await self._progress(self.desk.record, result)

    async def _progress(self, change: Callable[..., Progress], *given: Any) -> None:
        try:
            self.post_message(messages.ProgressRead(await asyncio.to_thread(change, *given)))
        except StorageError as error:
            self.post_message(messages.Trouble(f"Your progress is not kept: {error}"))

    # --- help with the exercise ---

    def action_hint(self) -> None:
        self._show_hints(max(1, self.progress.of(self.lesson.id).hints))

    def _show_hints(self, shown: int) -> None:
        lesson = self.lesson
        if shown > self.progress.of(lesson.id).hints:
            self.run_worker(self._progress(self.desk.show_hint, lesson), group="progress")

        def answered(more: bool | None) -> None:
            if more:
                self._show_hints(shown + 1)

        self.app.push_screen(HintScreen(lesson, shown), answered)

    def action_solution(self) -> None:
        text = "The exercise teaches most when you find the way yourself.\n\nShow our solution all the same?"
        self._ask(f"Solution of {words.label(self.lesson)}", text, "Show it", self._show_solution)

    def _show_solution(self) -> None:
        try:
            sources = {file.name: file.solution.read_text("utf-8") for file in self.lesson.files}
        except OSError as error:
            self.post_message(messages.Trouble(f"The solution cannot be read: {error.strerror}"))
            return
        self.app.push_screen(SolutionScreen(self.lesson, sources))

    # --- leaving ---

    @property
    def busy(self) -> bool:
        """Whether a check or a node runs."""
        return self.checking is not None or (self.node is not None and self.node.state.alive)

    async def close_down(self) -> None:
        """End the check and the node, and wait until nothing of them is left."""
        if self.checking is not None:
            self.checking.cancel()
        if self.node is not None:
            self.node.stop()
        busy = [w for w in self.workers if w.group in ("check", "node", "progress")]
        if busy:  # an empty list would mean all of them, and the one that follows the file never ends
            await self.app.workers.wait_for_complete(busy)
