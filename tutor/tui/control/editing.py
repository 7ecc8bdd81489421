"""Ways into the code: the editor, a line or a match in it, the other file, and the learner's own editor."""

from __future__ import annotations

import signal
from pathlib import Path

from tutor.tui import commands, messages
from tutor.tui.control.files import Files
from tutor.tui.control.host import HostScreen
from tutor.tui.control.skeletons import Skeletons
from tutor.tui.widgets.code_pane import CodePane


class Editing:
    """Moves the focus and the cursor in the learner's files."""

    def __init__(self, host: HostScreen, pane: CodePane, files: Files, skeletons: Skeletons) -> None:
        self._host, self._pane, self._files, self._skeletons = host, pane, files, skeletons

        def is_on_disk() -> bool:
            return files.is_on_disk(host.model.path)

        host.register(commands.EDIT, self.edit)
        host.register(commands.FIND, self.find, is_on_disk)
        host.register(commands.FIND_NEXT, lambda: self.find(again=True), is_on_disk)
        host.register(commands.OWN_EDITOR, self.open_outside)
        host.register(commands.NEXT_FILE, self.next_file, lambda: len(host.model.lesson.files) > 1)

    def next_file(self) -> None:
        """Show the lesson's other file."""
        model = self._host.model
        self._files.show((model.file_index + 1) % len(model.lesson.files))
        self._host.show_page("code")
        self._pane.release()

    def go_to(self, message: messages.GoToLine) -> None:
        """Open the file of the message, and put the cursor on its line."""
        paths = self._host.model.paths
        if message.path in paths:
            self._files.show(paths.index(message.path))
            self._host.show_page("code")
            self._host.start_worker(self._go_to, message, group="show-line", exclusive=True)

    async def _go_to(self, message: messages.GoToLine) -> None:
        await self._files.refresh(message.path)
        self._pane.go_to(message.path, message.line)

    def edit(self, text: str = "") -> None:
        """Focus the editor, and type this text there."""
        if self._skeletons.offer_start_if_missing("edit"):
            return
        path = self._host.model.path
        if self._pane.has_editor(path):
            self._focus_editor(text)
        else:  # requested before the file has been read
            self._host.start_worker(self._focus_editor_when_read, path, text, group="show-line", exclusive=True)

    def find(self, *, again: bool = False) -> None:
        """Open the search in the file shown, or (`again`) find the next match."""
        if self._host.page != "code":
            self._host.show_page("code")
        self._pane.find(again=again)

    async def _focus_editor_when_read(self, path: Path, text: str) -> None:
        await self._files.refresh(path)
        if path == self._host.model.path:
            self._focus_editor(text)

    def _focus_editor(self, text: str) -> None:
        self._pane.edit()
        self._host.show_page("code")
        self._pane.focus_content(typing=True)
        if text and (editor := self._pane.editor) is not None:
            editor.insert(text)

    async def open_outside(self) -> None:
        """Hand the terminal to the learner's own editor."""
        from tutor.tui.outside_editor import edit_outside

        if self._skeletons.offer_start_if_missing("edit"):
            return
        await self._files.save_all()
        model = self._host.model
        # Ctrl+C in the editor reaches us, too. A no-op handler, unlike SIG_IGN, is not inherited by the editor.
        before = signal.signal(signal.SIGINT, lambda *_: None)
        try:
            problem = await edit_outside(self._host.app, model.path)
        finally:
            signal.signal(signal.SIGINT, before)
        if problem:
            self._host.show_error(problem)
        self._host.show_page("code")
        self._pane.release()
        self._host.refresh(layout=True)
