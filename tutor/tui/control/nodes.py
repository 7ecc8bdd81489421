"""The learner's nodes: run, stopped, run anew, each file by itself."""

from __future__ import annotations

import asyncio
from pathlib import Path

from tutor.content import Lesson, LessonFile
from tutor.tui import messages
from tutor.tui.control.files import Files
from tutor.tui.control.remember import Memory
from tutor.tui.node import Node
from tutor.tui.screens.stage import Deed, Stage
from tutor.workspace import RunOptions


class Nodes:
    """One node for each file, and only those of one lesson: two lessons' nodes would talk into each other's topics."""

    def __init__(self, stage: Stage, files: Files, memory: Memory) -> None:
        self._stage, self._files, self._memory = stage, files, memory
        self.known: dict[Path, Node] = {}
        """The latest node of each file, whether it still runs or not."""
        self.latest: Path | None = None
        """The file that was run last."""
        self._turns: dict[Path, asyncio.Lock] = {}
        self._wanted: dict[Path, int] = {}
        self.deeds = {
            "run": Deed(self.run, lambda: not self._stoppable),
            "stop": Deed(self.stop, lambda: bool(self._stoppable)),
            "restart": Deed(self.restart, lambda: self._alive(stage.session.path)),
            "options": Deed(self.options),
            "restart_on_save": Deed(self.switch_restart),
        }

    @property
    def running(self) -> list[Node]:
        """Those that have a process."""
        return [node for node in self.known.values() if node.state.alive]

    @property
    def shown(self) -> Path | None:
        """The file whose log is to be shown: the one that is looked at, else the one that was run last."""
        path = self._stage.session.path
        return path if path in self.known else self.latest

    def _alive(self, path: Path) -> bool:
        return path in self.known and self.known[path].state.alive

    @property
    def _stoppable(self) -> list[Node]:
        """What Stop stops: the node of the file that is shown; where another lesson is read, what runs."""
        session = self._stage.session
        if self._alive(session.path):
            return [self.known[session.path]]
        return [] if any(path in self.known for path in session.paths) else self.running

    # --- run and stop ---

    def run(self) -> None:
        """Run the file that is shown."""
        session = self._stage.session
        if self._files.needed_for("run"):
            return
        if not session.path.exists():
            self._stage.trouble(f"{session.file.name} is not in your workspace yet.")
            return
        self._start(session.lesson, session.file)

    def stop(self) -> None:
        """Press Ctrl+C."""
        for node in self._stoppable:
            node.stop()

    def restart(self) -> None:
        """Stop the node of the file that is shown, and run it anew."""
        self._start(self._stage.session.lesson, self._stage.session.file)

    def saved(self, message: messages.FileSaved) -> None:
        """A file was saved: run its lesson's nodes anew, where that is wanted."""
        session = self._stage.session
        if not session.state.restart_on_save or message.path not in session.paths:
            return
        for file in session.lesson.files:
            if self._alive(session.desk.path(file)):
                self._start(session.lesson, file, unasked=message.outside)

    def switch_restart(self) -> None:
        """Switch restarting on save."""
        on = not self._stage.session.state.restart_on_save
        self._memory.note(restart_on_save=on)
        self._stage.say("Each save now restarts your node." if on else "A save no longer restarts your node.")
        self._stage.refresh_bindings()

    def _start(self, lesson: Lesson, file: LessonFile, *, unasked: bool = False) -> None:
        path = self._stage.session.desk.path(file)
        self._wanted[path] = self._wanted.get(path, 0) + 1
        self._stage.work(self._run, lesson, file, path, self._wanted[path], unasked, group="node")

    async def _run(self, lesson: Lesson, file: LessonFile, path: Path, number: int, unasked: bool) -> None:
        session = self._stage.session
        others = [node for other, node in self.known.items() if node.state.alive and other not in session.paths]
        for node in others:
            node.stop()
        if self._alive(path):
            self.known[path].stop()
        await self._files.save_all()
        async with self._turns.setdefault(path, asyncio.Lock()):
            for node in others:
                await node.over.wait()
            if self._wanted[path] != number:
                return  # asked again meanwhile: the last one counts
            from tutor.sandbox.ros2.errors import CommandError

            try:
                options = session.state.run_of(lesson.id)
                command = await asyncio.to_thread(session.desk.node_command, file, options)
            except CommandError as error:
                self._stage.trouble(f"The node cannot be started: {error}")
                return
            except OSError as error:
                self._stage.trouble(f"The node cannot be started: {error.strerror or error}")
                return
            node = Node(command, lambda state: self._stage.post_message(messages.NodeChanged(path, state)))
            self.known[path], self.latest = node, path
            self._stage.post_message(messages.NodeChanged(path, node.state, first=True, unasked=unasked))
            await node.run()

    # --- how it is run ---

    def options(self) -> None:
        """Ask for parameters and remaps."""
        from tutor.tui.screens.run_options import RunOptionsScreen

        session = self._stage.session
        lesson, file = session.lesson, session.file

        def answered(answer: tuple[RunOptions, bool] | None) -> None:
            if answer is None:
                return
            options, run = answer
            self._memory.put(session.state.with_run(lesson.id, options))
            if run and session.lesson is lesson:
                (self.restart if self._alive(session.path) else self.run)()

        self._stage.app.push_screen(
            RunOptionsScreen(file, session.run_options, lambda options: session.desk.command_line(file, options)),
            answered,
        )

    def leave(self) -> None:
        """End all of them."""
        for path in self._wanted:
            self._wanted[path] += 1
        for node in self.known.values():
            node.stop()
