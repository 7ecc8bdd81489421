"""Shows, edits, saves and watches the learner's files; if editor and disk differ, neither version is ever lost."""

from __future__ import annotations

import asyncio
import signal
from collections.abc import Callable, Sequence
from pathlib import Path

from textual.timer import Timer

from tutor.content import Lesson
from tutor.errors import StorageError, WorkspaceError
from tutor.session.paths import short_path
from tutor.tui import commands, messages, wording
from tutor.tui.control.host import HostScreen
from tutor.tui.control.records import Records
from tutor.tui.file_watching import watch_files
from tutor.tui.widgets.code_pane import CodePane
from tutor.workspace import back_up_file, digest_of_file, digest_of_text, overwrite_file, read_source

AUTOSAVE_DELAY_S = 0.6
"""Edits are written to disk this many seconds after the first unsaved keystroke."""


class Files:
    """Keeps the editors and the disk in sync. Every read and every write happens under one lock."""

    def __init__(self, host: HostScreen, pane: CodePane, records: Records) -> None:
        self._host, self._pane, self._records = host, pane, records
        self._disk: dict[Path, str] = {}
        """The text of each file on disk, as last read or written by the app."""
        self._digests: dict[Path, str] = {}
        """The digest of each file on disk, likewise; empty if it is not there."""
        self._lock = asyncio.Lock()
        self._autosave: Timer | None = None
        self._closed = False
        host.register(commands.START, self.start)
        host.register(commands.EDIT, self.edit)
        host.register(commands.SAVE, self.save)
        host.register(commands.FIND, self.find, lambda: host.model.path in self._disk)
        host.register(commands.FIND_NEXT, lambda: self.find(again=True), lambda: host.model.path in self._disk)
        host.register(commands.OWN_EDITOR, self.open_outside)
        host.register(commands.NEXT_FILE, self.next_file, lambda: len(host.model.lesson.files) > 1)
        host.register(commands.RESET, self.reset)

    # --- which file ---

    def show(self, index: int) -> None:
        """Show one of the lesson's files, and watch all of them on disk."""
        model = self._host.model
        model.file_index = index
        self._pane.show_names(model.paths, index)
        self._watch()

    def _watch(self) -> None:
        def on_change(path: Path) -> None:
            self._host.post_message(messages.FileTouched(path))

        self._host.start_worker(watch_files, self._host.model.paths, on_change, group="file", exclusive=True)

    def next_file(self) -> None:
        """Show the lesson's other file."""
        model = self._host.model
        self.show((model.file_index + 1) % len(model.lesson.files))
        self._host.show_page("code")
        self._pane.release()

    def go_to(self, message: messages.GoToLine) -> None:
        """Open the file of the message, and put the cursor on its line."""
        paths = self._host.model.paths
        if message.path in paths:
            self.show(paths.index(message.path))
            self._host.show_page("code")
            self._host.start_worker(self._go_to, message, group="show-line", exclusive=True)

    async def _go_to(self, message: messages.GoToLine) -> None:
        await self.refresh(message.path)
        self._pane.go_to(message.path, message.line)

    # --- the disk has changed ---

    def touched(self, message: messages.FileTouched) -> None:
        """Handle a change on disk: read the file again, once what has changed on the screen is painted.

        At the start, the lesson does not wait for an editor.
        """
        self._host.call_after_refresh(self._host.start_worker, self.refresh, message.path, group="refresh")

    async def refresh(self, path: Path) -> None:
        """Read a file, and reconcile the editor with it."""
        async with self._lock:
            try:
                text = await asyncio.to_thread(read_source, path)
            except StorageError as error:
                self._digests[path] = await asyncio.to_thread(digest_of_file, path)
                if path == self._host.model.path and not self._closed:
                    self._pane.show_missing(path, str(error))
            else:
                if not self._closed:
                    await self._reconcile(path, text)
            self._host.post_message(messages.FileRead(path))

    async def _reconcile(self, path: Path, text: str | None) -> None:
        """Reconcile the editor with `text`, the file on disk (None: there is no file). The lock must be held."""
        known = self._disk.get(path)
        shown = path == self._host.model.path
        self._digests[path] = "" if text is None else digest_of_text(text)
        if text is None:
            if known is not None and self._pane.is_unsaved(path):
                await self._write(path, None)  # removed while being edited: the editor's text wins
                return
            self._disk.pop(path, None)
            if shown:
                self._pane.show_missing(path)
            return
        if text == known and self._pane.has_editor(path):
            self._pane.show_existing(path)  # usually our own save: anything typed since is newer than the disk
            return
        changed = known not in (None, text)
        if known is not None and self._pane.is_unsaved(path):
            if text != self._pane.text(path):
                await self._resolve_conflict(path, text)
                return
            self._pane.mark_saved(path, text)
        elif shown or self._pane.has_editor(path):  # no editor before it is needed
            await self._pane.show_source(path, text, visible=shown)
        self._disk[path] = text
        if changed:
            self._host.say(f"{path.name} was changed outside: this is the new version.")
            self._host.post_message(messages.FileSaved(path, outside=True))
        self._host.refresh_bindings()

    async def _resolve_conflict(self, path: Path, theirs: str) -> None:
        """Let the learner choose, after both sides have changed; both are on disk before they are asked.

        The lock must be held.
        """
        from tutor.tui.dialogs.simple import ConflictScreen

        ours = self._pane.text(path)
        try:
            backup = await asyncio.to_thread(back_up_file, path, ours)
        except StorageError as error:
            self._host.show_error(f"{path.name} was changed outside, and yours cannot be kept beside it: {error}")
            return
        mine = await self._host.app.push_screen_wait(ConflictScreen(path.name, backup.name, ours, theirs))
        if not mine:
            if (typed := self._pane.text(path)) != ours:  # typed while the backup was written, before the dialog opened
                try:
                    backup = await asyncio.to_thread(back_up_file, path, typed)
                except StorageError as error:
                    self._host.show_error(f"Nothing was changed: yours cannot be kept beside it: {error}")
                    return
            self._disk[path] = theirs
            await self._pane.show_source(path, theirs, visible=path == self._host.model.path)
            self._host.say(f"The file's version is shown. Yours is kept as {backup.name}.", warn=True)
            return
        try:
            kept = await asyncio.to_thread(back_up_file, path, theirs)
            backup.unlink(missing_ok=True)
        except (StorageError, OSError) as error:
            self._host.show_error(f"Nothing was written: {error}")
            return
        self._disk[path] = theirs
        await self._write(path, theirs)
        self._host.say(f"Your version is saved. The other one is kept as {kept.name}.", warn=True)

    # --- the learner has changed it ---

    def digests(self, lesson: Lesson) -> dict[str, str]:
        """Return the digests of a lesson's files, unsaved edits included, as far as they have been read."""
        paths = {file.name: self._host.model.session.path(file) for file in lesson.files}
        return {
            name: digest_of_text(self._pane.text(path)) if self._pane.is_unsaved(path) else self._digests[path]
            for name, path in paths.items()
            if path in self._digests
        }

    async def read_again(self, lesson: Lesson) -> None:
        """Read a lesson's files now, without waiting for the next look at the disk."""
        for file in lesson.files:
            await self.refresh(self._host.model.session.path(file))

    def typed(self) -> None:
        """Handle an edit: schedule an autosave."""
        self._pane.refresh_head()
        if self._autosave is None and self._pane.unsaved_files():
            self._autosave = self._host.set_timer(AUTOSAVE_DELAY_S, self._autosave_due)

    def _autosave_due(self) -> None:
        self._autosave = None
        self._host.start_worker(self.save_all, group="save")

    async def save(self) -> None:
        """Save on request, which also triggers what is set to happen on each save."""
        if await self.save_all():
            path = self._host.model.path
            if path in self._disk:
                self._host.post_message(messages.FileSaved(path))
                self._host.say(f"{path.name} is saved.")

    async def save_all(self) -> bool:
        """Save every changed file; return whether everything is saved now."""
        async with self._lock:
            await self._write_changed()
        if not self._closed:
            self._pane.refresh_head()
        return not self._pane.unsaved_files()

    async def _write_changed(self) -> None:
        """Write every changed file; the lock must be held."""
        for path in self._pane.unsaved_files():
            await self._write(path, self._disk.get(path))

    async def _write(self, path: Path, expected: str | None) -> None:
        """Write the editor's text, provided that the file on disk is still `expected`; else reconcile the two."""
        text = self._pane.text(path)
        try:
            saved = await asyncio.to_thread(overwrite_file, path, text, expected)
        except StorageError as error:
            self._host.show_error(f"{path.name} could not be saved: {error}")
            return
        if not saved.done:
            await self._reconcile(path, saved.found)
            return
        self._disk[path] = text
        self._digests[path] = digest_of_text(text)
        self._pane.mark_saved(path, text)
        if saved.backup is not None:
            self._host.say(f"{path.name} was changed outside just now: that is kept as {saved.backup.name}.", warn=True)

    def close(self) -> None:
        """Stop updating the editors, which are about to be removed; everything has been saved."""
        self._closed = True
        if self._autosave is not None:
            self._autosave.stop()

    # --- start, edit, reset ---

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
        """Show the code, now that the skeletons are in the workspace."""
        if message.exercise != self._host.model.lesson.id:
            return
        self._watch()  # from now on: its first look reads the files
        self._host.show_page("code")
        if message.written:
            self._host.say(f"{_listed(message.written)} in your workspace: e to edit, F9 to check.")
        else:
            self._host.say("Your files are there already; nothing was changed.")

    def edit(self, text: str = "") -> None:
        """Focus the editor, and type this text there."""
        if self.offer_start_if_missing("edit"):
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
        await self.refresh(path)
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

        if self.offer_start_if_missing("edit"):
            return
        await self.save_all()
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
            placed = await self.let_change((model.path,), model.session.reset, lesson, file)
        except (WorkspaceError, StorageError) as error:
            self._host.show_error(str(error))
            return
        if placed is not None:
            where = f" Yours is kept as {short_path(placed.backups[0])}." if placed.backups else ""
            self._host.say(f"{file.name} is the skeleton again.{where}", warn=True)

    async def let_change[**P, T](
        self, paths: Sequence[Path], change: Callable[P, T], *args: P.args, **options: P.kwargs
    ) -> T | None:
        """Save everything, let `change` write these files, and show them: they were not changed by somebody else.

        Return None, without a change, if saving failed, which was reported: the editor holds the only copy. Raises
        what `change` raises, and StorageError.
        """
        async with self._lock:  # no read may see the state in between
            await self._write_changed()
            if self._pane.unsaved_files():
                return None
            changed = await asyncio.to_thread(change, *args, **options)
            for path in paths:
                text = await asyncio.to_thread(read_source, path)
                if text is not None:
                    self._disk[path], self._digests[path] = text, digest_of_text(text)
                    shown = path == self._host.model.path
                    if shown or self._pane.has_editor(path):
                        await self._pane.show_source(path, text, visible=shown)
        return changed


def _listed(names: Sequence[str]) -> str:
    """The names of files, with the verb: "a.py is", "a.py and b.py are", "a.py and 6 more files are"."""
    if len(names) > 2:
        return f"{names[0]} and {len(names) - 1} more files are"
    return f"{' and '.join(names)} {'is' if len(names) == 1 else 'are'}"
