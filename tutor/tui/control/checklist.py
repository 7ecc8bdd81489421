"""Opens, ticks and exports the checklist. Ticks are saved at once, in the order they were made."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from tutor.errors import StorageError
from tutor.session.paths import short_path
from tutor.tui import commands
from tutor.tui.control.host import HostScreen
from tutor.tui.control.records import Records

if TYPE_CHECKING:
    from tutor.tui.dialogs.checklist import ChecklistScreen


class ChecklistController:
    """Keeps the open checklist up to date; its modules are imported when it is first opened."""

    def __init__(self, host: HostScreen, records: Records) -> None:
        self._host, self._records = host, records
        self._screen: ChecklistScreen | None = None
        self._pending_ticks = 0
        """Number of ticks still being saved: progress read meanwhile may lack them, and is not shown."""
        host.register(commands.CHECKLIST, self.open, self._has_checklist)
        host.register(commands.EXPORT, self.export, self._has_checklist)

    def _has_checklist(self) -> bool:
        return bool(self._host.model.session.course.checklist.groups)

    def open(self) -> None:
        """Show the checklist; ticks made in another window appear once the progress has been re-read."""
        from tutor.report.assessment import assess
        from tutor.tui.dialogs.checklist import ChecklistScreen

        if self._screen is not None:
            return
        model = self._host.model
        self._screen = ChecklistScreen(
            assess(model.session.course, model.progress, model.versions),
            tick=self._tick,
            export=self.export,
            theme=self._switch_theme,
        )
        self._host.app.push_screen(self._screen, self._closed)
        self._records.read()

    def _closed(self, answer: None) -> None:
        self._screen = None

    def show(self) -> None:
        """Show changed progress or files, unless ticks are still being saved."""
        from tutor.report.assessment import assess

        if self._screen is not None and not self._pending_ticks:
            model = self._host.model
            self._screen.show(assess(model.session.course, model.progress, model.versions))

    def _switch_theme(self) -> None:
        self._host.do(commands.THEME)

    # --- ticks ---

    def _tick(self, item: str, ticked: bool) -> None:
        self._pending_ticks += 1
        self._host.start_worker(self._save_tick, item, ticked, group="progress")

    async def _save_tick(self, item: str, ticked: bool) -> None:
        try:
            await self._records.change(self._host.model.session.tick, item, ticked)
        finally:
            self._pending_ticks -= 1

    # --- export ---

    def export(self) -> None:
        """Ask for format and file, then export."""
        self._ask("markdown", None)

    def _ask(self, format: str, file: Path | None) -> None:
        from tutor.tui.dialogs.export import ExportScreen

        def answered(answer: tuple[str, Path] | None) -> None:
            if answer is not None:
                self._host.start_worker(self._write, *answer, group="progress")

        self._host.app.push_screen(ExportScreen(self._host.model.session.workspace.root, format, file), answered)

    async def _write(self, format: str, path: Path, replace: bool = False) -> None:
        name = short_path(path)
        try:
            written = await self._records.run_in_order(self._host.model.session.export, format, path, replace)
        except StorageError as error:
            self._host.show_error(f"Your checklist could not be written: {error}")
            return
        if written:
            self._host.say(f"Your checklist is in {name}")
            return

        from tutor.tui.dialogs.simple import ConfirmScreen

        def answered(yes: bool | None) -> None:
            if yes:
                self._host.start_worker(self._write, format, path, True, group="progress")
            else:
                self._ask(format, path)

        question = ConfirmScreen(
            "Replace the file?", f"{name} already exists.\n\nReplace its contents?", "Replace", "Keep it"
        )
        self._host.app.push_screen(question, answered)
