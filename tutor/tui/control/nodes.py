"""The learner's nodes, and ours beside them: run, stopped, run again, each by itself."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from pathlib import Path

from tutor.content import Lesson, LessonFile, Partner
from tutor.session.node import Node, NodeCommand
from tutor.tui import commands, messages
from tutor.tui.control.files import Files
from tutor.tui.control.host import HostScreen
from tutor.tui.control.preferences import Preferences
from tutor.workspace import RunOptions


class Nodes:
    """One node for each file, and our partner node that goes with them.

    Only those of one lesson: two lessons' nodes would talk into each other's topics.
    """

    def __init__(self, host: HostScreen, files: Files, preferences: Preferences) -> None:
        self._host, self._files, self._preferences = host, files, preferences
        self.known: dict[Path, Node] = {}
        """The latest node of each file, whether it still runs or not; our partner by `key_of`."""
        self._chosen: tuple[Path, Path] | None = None
        """The node whose log the learner wants, and the file that was shown when they did."""
        self.latest: Path | None = None
        """The file that was run last."""
        self._turns: dict[Path, asyncio.Lock] = {}
        self._wanted: dict[Path, int] = {}
        host.register(commands.RUN, self.run, lambda: not self._stoppable)
        host.register(commands.STOP, self.stop, lambda: bool(self._stoppable))
        host.register(commands.RESTART, self.restart, lambda: self._alive(host.model.path))
        host.register(commands.PARTNER, self.partner, lambda: self._partner is not None)
        host.register(commands.OTHER_FILE, self.other_file, lambda: len(host.model.lesson.files) > 1)
        host.register(commands.OPTIONS, self.options)
        host.register(commands.RESTART_ON_SAVE, self.switch_restart)

    @property
    def running(self) -> list[Node]:
        """Those that have a process."""
        return [node for node in self.known.values() if node.state.alive]

    @property
    def shown(self) -> Path | None:
        """The node whose log is to be shown: the one chosen, else that of the file that is looked at, else the last."""
        path = self._host.model.path
        if self._chosen is not None and self._chosen[1] == path and self._chosen[0] in self.listed:
            return self._chosen[0]
        return path if path in self.known else self.latest

    @property
    def listed(self) -> list[Path]:
        """The nodes whose logs can be chosen: those of the lesson, and all that run."""
        own = self._own(self._host.model.lesson)
        return [path for path, node in self.known.items() if path in own or node.state.alive]

    def choose(self, path: Path) -> None:
        """Show the log of this node."""
        self._chosen = (path, self._host.model.path)
        self._tell(path)

    def stop_key(self, path: Path) -> str:
        """The key that stops this node."""
        model = self._host.model
        if path == model.path or path not in self._own(model.lesson):
            return commands.STOP.keys[0]
        return commands.OTHER_FILE.keys[0] if path in model.paths else commands.PARTNER.keys[0]

    def _tell(self, path: Path, *, first: bool = False, unasked: bool = False) -> None:
        state = self.known[path].state
        self._host.post_message(messages.NodeChanged(path, state, first=first, unasked=unasked))

    def _own(self, lesson: Lesson) -> set[Path]:
        files = {self._host.model.session.path(file) for file in lesson.files}
        return files | {key_of(partner) for partner in lesson.live.partners}

    @property
    def _partner(self) -> Partner | None:
        model = self._host.model
        return model.lesson.live.partner_of(model.file.name)

    def _alive(self, path: Path) -> bool:
        return path in self.known and self.known[path].state.alive

    @property
    def _stoppable(self) -> list[Node]:
        """What Stop stops: the node of the file that is shown; where another lesson is read, what runs."""
        model = self._host.model
        if self._alive(model.path):
            return [self.known[model.path]]
        if any(path in self.known for path in model.paths):
            return []
        own = self._own(model.lesson)
        return [node for path, node in self.known.items() if node.state.alive and path not in own]

    # --- run and stop ---

    def run(self) -> None:
        """Run the file that is shown."""
        model = self._host.model
        if self._files.needed_for("run"):
            return
        if not model.path.exists():
            self._host.show_error(f"{model.file.name} is not in your workspace yet.")
            return
        self._start(model.lesson, model.file)

    def stop(self) -> None:
        """Press Ctrl+C."""
        for node in self._stoppable:
            node.stop()

    def other_file(self) -> None:
        """Run the lesson's other file beside the one that is shown, or stop it."""
        model = self._host.model
        files = model.lesson.files
        file = files[(model.file_index + 1) % len(files)]
        path = model.session.path(file)
        if self._alive(path):
            self.known[path].stop()
        elif not path.exists():
            self._host.show_error(f"{file.name} is not in your workspace yet.")
        else:
            self._start(model.lesson, file)

    def partner(self) -> None:
        """Start our node that goes with the file that is shown, or stop it."""
        model, partner = self._host.model, self._partner
        if partner is None:
            return
        key = key_of(partner)
        if self._alive(key):
            self.known[key].stop()
            return
        twin = [path for path in model.paths if partner.file and path.name == partner.file.name and self._alive(path)]
        if twin:
            self._host.show_error(f"Your {twin[0].name} runs already, and does what ours would: j stops it.")
            return
        session = model.session
        self._begin(model.lesson, key, lambda: session.partner_command(partner))

    def restart(self) -> None:
        """Stop the node of the file that is shown, and run it again."""
        self._start(self._host.model.lesson, self._host.model.file)

    def saved(self, message: messages.FileSaved) -> None:
        """A file was saved: run its lesson's nodes again, where that is wanted."""
        model = self._host.model
        if not model.state.restart_on_save or message.path not in model.paths:
            return
        for file in model.lesson.files:
            if self._alive(model.session.path(file)):
                self._start(model.lesson, file, unasked=message.outside)

    def switch_restart(self) -> None:
        """Switch restarting on save."""
        on = not self._host.model.state.restart_on_save
        self._preferences.update(restart_on_save=on)
        self._host.say("Each save now restarts your node." if on else "A save no longer restarts your node.")
        self._host.refresh_bindings()

    def _start(self, lesson: Lesson, file: LessonFile, *, unasked: bool = False) -> None:
        session = self._host.model.session

        def command() -> NodeCommand:
            return session.node_command(file, self._host.model.state.run_of(lesson.id))

        self._begin(lesson, session.path(file), command, unasked=unasked)

    def _begin(self, lesson: Lesson, path: Path, command: Callable[[], NodeCommand], *, unasked: bool = False) -> None:
        self._wanted[path] = self._wanted.get(path, 0) + 1
        self._host.work(self._run, lesson, path, command, self._wanted[path], unasked, group="node")

    async def _run(
        self, lesson: Lesson, path: Path, make: Callable[[], NodeCommand], number: int, unasked: bool
    ) -> None:
        own = self._own(lesson)
        others = [node for other, node in self.known.items() if node.state.alive and other not in own]
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
            from tutor.errors import CommandError

            try:
                command = await asyncio.to_thread(make)
            except CommandError as error:
                self._host.show_error(f"The node cannot be started: {error}")
                return
            except OSError as error:
                self._host.show_error(f"The node cannot be started: {error.strerror or error}")
                return
            node = Node(command, lambda state: self._host.post_message(messages.NodeChanged(path, state)))
            self.known[path], self.latest = node, path
            if not unasked:
                self._chosen = (path, self._host.model.path)
            self._tell(path, first=True, unasked=unasked)
            await node.run()

    # --- how it is run ---

    def options(self) -> None:
        """Ask for parameters and remaps."""
        from tutor.tui.dialogs.run_options import RunOptionsScreen

        model = self._host.model
        lesson, file = model.lesson, model.file

        def answered(answer: tuple[RunOptions, bool] | None) -> None:
            if answer is None:
                return
            options, run = answer
            self._preferences.replace(model.state.with_run(lesson.id, options))
            if run and model.lesson is lesson:
                (self.restart if self._alive(model.path) else self.run)()

        self._host.app.push_screen(
            RunOptionsScreen(file, model.run_options, lambda options: model.session.command_line(file, options)),
            answered,
        )

    def leave(self) -> None:
        """End all of them."""
        for path in self._wanted:
            self._wanted[path] += 1
        for node in self.known.values():
            node.stop()


def key_of(partner: Partner) -> Path:
    """What our partner node is known by among the learner's files."""
    return partner.file or Path(*partner.run)
