"""The checklist: opened, ticked, exported. Ticks are kept at once, in the order they were made."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from tutor.tui import words
from tutor.tui.control.records import Records
from tutor.tui.screens.stage import Deed, Stage
from tutor.workspace import Progress, StorageError

if TYPE_CHECKING:
    from tutor.tui.screens.checklist import ChecklistScreen


class ChecklistDesk:
    """Keeps the open checklist up to date; what it needs is imported when it is opened first."""

    def __init__(self, stage: Stage, records: Records) -> None:
        self._stage, self._records = stage, records
        self._screen: ChecklistScreen | None = None
        self._keeping = 0
        """Ticks on their way to the disk: progress that was read before them is no news."""
        self.deeds = {"checklist": Deed(self.open, self._any), "export": Deed(self.export, self._any)}

    def _any(self) -> bool:
        return bool(self._stage.session.desk.course.checklist.groups)

    def open(self) -> None:
        """Show the checklist; what another window has ticked follows in a moment."""
        from tutor.report.assessment import assess
        from tutor.tui.screens.checklist import ChecklistScreen

        if self._screen is not None:
            return
        session = self._stage.session
        self._screen = ChecklistScreen(
            assess(session.desk.course, session.progress), tick=self._tick, export=self.export, theme=self._theme
        )
        self._stage.app.push_screen(self._screen, self._closed)
        self._records.read()

    def _closed(self, answer: None) -> None:
        self._screen = None

    def show(self, progress: Progress) -> None:
        """The progress has changed."""
        from tutor.report.assessment import assess

        if self._screen is not None and not self._keeping:
            self._screen.show(assess(self._stage.session.desk.course, progress))

    def _theme(self) -> None:
        self._stage.work(self._stage.run_action, "do('theme')", group="theme")

    # --- ticks ---

    def _tick(self, item: str, ticked: bool) -> None:
        self._keeping += 1
        self._stage.work(self._keep, item, ticked, group="progress")

    async def _keep(self, item: str, ticked: bool) -> None:
        try:
            await self._records.change(self._stage.session.desk.tick, item, ticked)
        finally:
            self._keeping -= 1

    # --- export ---

    def export(self) -> None:
        """Ask for format and file."""
        self._ask("markdown", None)

    def _ask(self, format: str, file: Path | None) -> None:
        from tutor.tui.screens.export import ExportScreen

        def answered(answer: tuple[str, Path] | None) -> None:
            if answer is not None:
                self._stage.work(self._write, *answer, group="progress")

        self._stage.app.push_screen(ExportScreen(self._stage.session.desk.workspace.root, format, file), answered)

    async def _write(self, format: str, path: Path, replace: bool = False) -> None:
        name = words.short(path)
        try:
            done = await self._records.in_turn(self._stage.session.desk.export, format, path, replace)
        except StorageError as error:
            self._stage.trouble(f"Your checklist is not written: {error}")
            return
        if done:
            self._stage.say(f"Your checklist is in {name}")
            return

        from tutor.tui.screens.confirm import ConfirmScreen

        def answered(yes: bool | None) -> None:
            if yes:
                self._stage.work(self._write, format, path, True, group="progress")
            else:
                self._ask(format, path)

        question = ConfirmScreen(
            "Replace the file?", f"{name} is there already.\n\nReplace what is in it?", "Replace", "Keep it"
        )
        self._stage.app.push_screen(question, answered)
