"""Runs, stops and restarts the learner's nodes, and our partner nodes, independently of each other."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from pathlib import Path

from tutor.content import Lesson, LessonFile, Partner
from tutor.session.node import Node
from tutor.session.node_command import NodeCommand
from tutor.tui import commands, messages
from tutor.tui.control.files import Files
from tutor.tui.control.host import HostScreen
from tutor.tui.control.preferences import Preferences
from tutor.tui.control.skeletons import Skeletons
from tutor.workspace import RunOptions


class Nodes:
    """One node for each file of a lesson, and the partner node that goes with them.

    Only the nodes of one lesson run at a time: those of two lessons would interfere on the same topics.
    """

    def __init__(self, host: HostScreen, files: Files, skeletons: Skeletons, preferences: Preferences) -> None:
        self._host, self._files, self._skeletons, self._preferences = host, files, skeletons, preferences
        self.by_path: dict[Path, Node] = {}
        """The latest node of each file, running or not; partner nodes by their `Partner.key`."""
        self._chosen: tuple[Path, Path] | None = None
        """The node whose log the learner chose, and the file shown at that time."""
        self.latest: Path | None = None
        """The file (or partner) that was run last."""
        self._locks: dict[Path, asyncio.Lock] = {}
        """Held while a node runs, so that the next run of the same file waits for its end."""
        self._requests: dict[Path, int] = {}
        """Number of the latest request to run each file; earlier ones still waiting are dropped."""
        host.register(commands.RUN, self.run, lambda: not self._nodes_to_stop)
        host.register(commands.STOP, self.stop, lambda: bool(self._nodes_to_stop))
        host.register(commands.RESTART, self.restart, lambda: self._is_alive(host.model.program_path))
        host.register(commands.PARTNER, self.partner, lambda: self._partner is not None)
        host.register(commands.OTHER_FILE, self.other_file, lambda: len(host.model.lesson.files) > 1)
        host.register(commands.OPTIONS, self.options)
        host.register(commands.RESTART_ON_SAVE, self.switch_restart)

    @property
    def running(self) -> list[Node]:
        """The nodes whose process is alive."""
        return [node for node in self.by_path.values() if node.state.alive]

    @property
    def shown(self) -> Path | None:
        """The node whose log to show: the one chosen, else that of the file shown, else the latest."""
        path = self._host.model.path
        if self._chosen is not None and self._chosen[1] == path and self._chosen[0] in self.listed:
            return self._chosen[0]
        return path if path in self.by_path else self.latest

    @property
    def listed(self) -> list[Path]:
        """The nodes whose logs can be chosen: those of the lesson, and any others that are running."""
        own = self._paths_of(self._host.model.lesson)
        return [path for path, node in self.by_path.items() if path in own or node.state.alive]

    def choose(self, path: Path) -> None:
        """Show the log of this node."""
        self._chosen = (path, self._host.model.path)
        self._post_changed(path)

    def stop_key(self, path: Path) -> str:
        """Return the key that stops this node."""
        model = self._host.model
        if path == model.program_path or path not in self._paths_of(model.lesson):
            return commands.STOP.keys[0]
        return commands.OTHER_FILE.keys[0] if path in model.paths else commands.PARTNER.keys[0]

    def _post_changed(self, path: Path, *, restarted: bool = False) -> None:
        state = self.by_path[path].state
        self._host.post_message(messages.NodeChanged(path, state, restarted=restarted))

    def _paths_of(self, lesson: Lesson) -> set[Path]:
        """Return the keys in `by_path` of a lesson's nodes, its partners included."""
        files = {self._host.model.session.path(file) for file in lesson.files}
        return files | {partner.key for partner in lesson.live.partners}

    @property
    def _partner(self) -> Partner | None:
        model = self._host.model
        return model.lesson.live.partner_of(model.file.name)

    def _is_alive(self, path: Path) -> bool:
        return path in self.by_path and self.by_path[path].state.alive

    @property
    def _nodes_to_stop(self) -> list[Node]:
        """What Stop acts on: the node of the file shown or, if this lesson has run none, those of another lesson."""
        model = self._host.model
        if self._is_alive(model.program_path):
            return [self.by_path[model.program_path]]
        if any(path in self.by_path for path in model.paths):
            return []
        own = self._paths_of(model.lesson)
        return [node for path, node in self.by_path.items() if node.state.alive and path not in own]

    # --- run and stop ---

    def run(self) -> None:
        """Run the file shown, or the lesson's first one if that is no program."""
        model = self._host.model
        if self._skeletons.offer_start_if_missing("run"):
            return
        if not model.program_path.exists():
            self._host.show_error(f"{model.program.name} is not in your workspace yet.")
            return
        self._start(model.lesson, model.program)

    def stop(self) -> None:
        """Stop the node, as Ctrl+C would."""
        for node in self._nodes_to_stop:
            node.stop()

    async def end_all_of(self, lesson: Lesson) -> None:
        """Stop a lesson's nodes, our partner nodes included, and wait until they have ended."""
        own = self._paths_of(lesson)
        running = [node for path, node in self.by_path.items() if node.state.alive and path in own]
        for node in running:
            node.stop()
        for node in running:
            await node.over.wait()

    def other_file(self) -> None:
        """Run the lesson's other file beside the one shown, or stop it."""
        model = self._host.model
        files = model.lesson.files
        file = files[(model.file_index + 1) % len(files)]
        path = model.session.path(file)
        if self._is_alive(path):
            self.by_path[path].stop()
        elif not path.exists():
            self._host.show_error(f"{file.name} is not in your workspace yet.")
        else:
            self._start(model.lesson, file)

    def partner(self) -> None:
        """Run our partner node for the file shown, or stop it."""
        model, partner = self._host.model, self._partner
        if partner is None:
            return
        key = partner.key
        if self._is_alive(key):
            self.by_path[key].stop()
            return
        own = [path for path in model.paths if partner.file and path.name == partner.file.name and self._is_alive(path)]
        if own:
            self._host.show_error(f"Your {own[0].name} is already running, and does what ours would: j stops it.")
            return
        session = model.session
        self._request_run(model.lesson, key, lambda: session.partner_command(partner))

    def restart(self) -> None:
        """Stop the node of the file shown, and run it again."""
        self._start(self._host.model.lesson, self._host.model.program)

    def saved(self, message: messages.FileSaved) -> None:
        """Handle a saved file: restart its lesson's running nodes, if restarting on save is on."""
        model = self._host.model
        if not model.state.restart_on_save or message.path not in model.paths:
            return
        for file in model.lesson.files:
            if self._is_alive(model.session.path(file)):
                self._start(model.lesson, file, automatic=message.outside)

    def switch_restart(self) -> None:
        """Toggle restarting on save."""
        on = not self._host.model.state.restart_on_save
        self._preferences.update(restart_on_save=on)
        self._host.say("Each save now restarts your node." if on else "A save no longer restarts your node.")
        self._host.refresh_bindings()

    def _start(self, lesson: Lesson, file: LessonFile, *, automatic: bool = False) -> None:
        session = self._host.model.session

        def command() -> NodeCommand:
            return session.node_command(file, self._host.model.state.run_of(lesson.id))

        self._request_run(lesson, session.path(file), command, automatic=automatic)

    def _request_run(
        self, lesson: Lesson, path: Path, command: Callable[[], NodeCommand], *, automatic: bool = False
    ) -> None:
        self._requests[path] = self._requests.get(path, 0) + 1
        if not automatic:  # at once: once it has started, the learner may be elsewhere already
            self._host.show_page("log")
        self._host.start_worker(self._run, lesson, path, command, self._requests[path], automatic, group="node")

    async def _run(
        self, lesson: Lesson, path: Path, make_command: Callable[[], NodeCommand], request: int, automatic: bool
    ) -> None:
        own = self._paths_of(lesson)
        others = [node for other, node in self.by_path.items() if node.state.alive and other not in own]
        for node in others:
            node.stop()
        if self._is_alive(path):
            self.by_path[path].stop()
        await self._files.save_all()
        async with self._locks.setdefault(path, asyncio.Lock()):
            for node in others:
                await node.over.wait()
            if self._requests[path] != request:
                return  # requested again meanwhile: the last request wins
            from tutor.errors import CommandError

            try:
                command = await asyncio.to_thread(make_command)
            except CommandError as error:
                self._host.show_error(f"The node cannot be started: {error}")
                return
            except OSError as error:
                self._host.show_error(f"The node cannot be started: {error.strerror or error}")
                return
            node = Node(command, lambda state: self._host.post_message(messages.NodeChanged(path, state)))
            self.by_path[path], self.latest = node, path
            if not automatic:
                self._chosen = (path, self._host.model.path)
            self._post_changed(path, restarted=automatic)
            await node.run()

    # --- options ---

    def options(self) -> None:
        """Ask for parameters and remaps, and run if asked to."""
        from tutor.tui.dialogs.run_options import RunOptionsScreen

        model = self._host.model
        lesson, file = model.lesson, model.program

        def answered(answer: tuple[RunOptions, bool] | None) -> None:
            if answer is None:
                return
            options, run = answer
            self._preferences.replace(model.state.with_run(lesson.id, options))
            if run and model.lesson is lesson:
                (self.restart if self._is_alive(model.program_path) else self.run)()

        self._host.app.push_screen(
            RunOptionsScreen(file, model.run_options, lambda options: model.session.command_line(file, options)),
            answered,
        )

    def shut_down(self) -> None:
        """Stop all nodes, and drop the requests that are still waiting."""
        for path in self._requests:
            self._requests[path] += 1
        for node in self.by_path.values():
            node.stop()
