"""Other views of the code page: the skeleton, the solution, and diffs against them."""

from __future__ import annotations

from collections.abc import Sequence
from enum import StrEnum
from functools import partial

from tutor.errors import StorageError
from tutor.tui import commands, wording
from tutor.tui.control.files import Files
from tutor.tui.control.host import HostScreen
from tutor.tui.control.records import Records
from tutor.tui.widgets.code_pane import CodePane
from tutor.tui.widgets.line_view import Piece, Row


class View(StrEnum):
    """The read-only views of the code page."""

    SKELETON = "skeleton"
    CHANGES = "changes"
    SOLUTION = "solution"
    AGAINST = "against"


class Views:
    """Shows one view at a time; requesting it again goes back to the learner's own file."""

    def __init__(self, host: HostScreen, pane: CodePane, files: Files, records: Records) -> None:
        self._host, self._pane, self._files, self._records = host, pane, files, records
        self._revealed: set[str] = set()
        """Ids of the exercises whose solution the learner has asked for."""
        host.register(commands.SKELETON, partial(self.show, View.SKELETON))
        host.register(commands.CHANGES, partial(self.show, View.CHANGES))
        host.register(commands.SOLUTION, partial(self.show, View.SOLUTION))
        host.register(commands.AGAINST, partial(self.show, View.AGAINST))

    def show(self, view: View) -> None:
        """Show a view; those with the solution only once the exercise is passed, or after asking for confirmation."""
        if self._host.page == "code" and self._pane.view == view:
            self._pane.show_own()
            return
        lesson = self._host.model.lesson
        passed = self._host.model.progress.of(lesson.id).is_passed
        if view in (View.SKELETON, View.CHANGES) or passed or lesson.id in self._revealed:
            self._show(view)
            return

        def reveal() -> None:
            self._revealed.add(lesson.id)
            self._show(view)

        text = "The exercise teaches most when you find the way yourself.\n\nShow our solution all the same?"
        self._host.ask(f"Solution of {wording.label(lesson)}", text, "Show it", reveal)

    def _show(self, view: View) -> None:
        if view in (View.SOLUTION, View.AGAINST):
            self._records.note_solution()
        self._host.start_worker(self._load_and_show, view, group="view", exclusive=True)

    async def _load_and_show(self, view: View) -> None:
        from tutor.tui.widgets.diffing import column_width, count_changes, diff_rows, side_by_side_rows

        model = self._host.model
        file, path = model.file, model.path
        given = model.session.handed_over
        read = given.skeleton if view in (View.SKELETON, View.CHANGES) else given.solution
        try:
            other = read(model.lesson, file)
        except StorageError as error:
            self._host.show_error(f"The file cannot be read: {error}")
            return
        await self._files.refresh(path)
        self._host.show_page("code")
        if view in (View.SKELETON, View.SOLUTION):
            self._pane.show_read_only(
                view, f"{'Our solution' if view is View.SOLUTION else 'The skeleton'}, read-only", other
            )
            return
        if not self._pane.has_editor(path):
            self._host.show_error(f"{file.name} is not in your workspace yet: there is nothing to compare.")
            return
        mine = self._pane.text(path)
        against = view is View.AGAINST
        rows, margins = diff_rows(mine, other) if against else diff_rows(other, mine)
        added, removed = count_changes(rows)
        title = (
            f"From yours to our solution: {removed} lines of yours (-), {added} of ours (+)"
            if against
            else f"Your changes to the skeleton: {added} lines added (+), {removed} removed (-)"
        )
        if not rows:
            title = f"No difference: your file is {'our solution' if against else 'still the skeleton'}"

        def make(width: int) -> tuple[Sequence[Row], Sequence[Piece]]:
            column = column_width(width) if against and rows else 0
            if not column:
                return rows, margins
            return side_by_side_rows(("yours", mine), ("ours", other), column), ()

        self._pane.show_made(view, title, make)
