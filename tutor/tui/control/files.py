"""Reads, saves and watches the learner's files; if editor and disk differ, neither version is ever lost."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from pathlib import Path

from textual.timer import Timer

from tutor.content import Lesson
from tutor.errors import StorageError
from tutor.tui import commands, messages
from tutor.tui.control.host import HostScreen
from tutor.tui.file_watching import watch_files
from tutor.tui.widgets.code_pane import CodePane
from tutor.workspace import back_up_file, digest_of_file, digest_of_text, overwrite_file, read_source

AUTOSAVE_DELAY_S = 0.6
"""Edits are written to disk this many seconds after the first unsaved keystroke."""


class Files:
    """Keeps the editors and the disk in sync. Every read and every write happens under one lock."""

    def __init__(self, host: HostScreen, pane: CodePane) -> None:
        self._host, self._pane = host, pane
        self._disk: dict[Path, str] = {}
        """The text of each file on disk, as last read or written by the app."""
        self._digests: dict[Path, str] = {}
        """The digest of each file on disk, likewise; empty if it is not there."""
        self._lock = asyncio.Lock()
        self._autosave: Timer | None = None
        self._closed = False
        host.register(commands.SAVE, self.save)

    # --- which file ---

    def show(self, index: int) -> None:
        """Show one of the lesson's files, and watch all of them on disk."""
        model = self._host.model
        model.file_index = index
        self._pane.show_names(model.paths, index)
        self.watch()

    def watch(self) -> None:
        """Watch the lesson's files on disk; the first look reads them."""

        def on_change(path: Path) -> None:
            self._host.post_message(messages.FileTouched(path))

        self._host.start_worker(watch_files, self._host.model.paths, on_change, group="file", exclusive=True)

    def is_on_disk(self, path: Path) -> bool:
        """Whether a file was on disk when it was last read or written."""
        return path in self._disk

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
