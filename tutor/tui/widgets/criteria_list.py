"""The rows of the criteria: progress of a running check, or verdicts; and the list of them."""

from __future__ import annotations

from textual.content import Content
from textual.geometry import Size
from textual.widgets import ListItem

from tutor.judge.verdict import Status
from tutor.report.plain import describe_waiting
from tutor.session.findings import Finding
from tutor.tui import wording
from tutor.tui.widgets.row_list import RowList


class CriterionRow(ListItem):
    """One criterion on one line: idle, being checked (a progress bar and the current step), or judged."""

    def __init__(self, finding: Finding, name_width: int) -> None:
        super().__init__()
        self.finding = finding
        self._name_width = name_width
        self._outdated = False

    def get_content_width(self, container: Size, viewport: Size) -> int:
        """Return the width of the mark and the name, which is what it takes beside a diagnosis."""
        return len("✓ ") + self._name_width + len(" ")

    def show(self, finding: Finding, *, outdated: bool) -> None:
        """Show this finding; a verdict on an earlier version of the code (`outdated`) is dimmed."""
        if (finding, outdated) != (self.finding, self._outdated):
            self.finding, self._outdated = finding, outdated
            self.refresh()

    def render(self) -> Content:
        """One line, fitted to the width."""
        found, width = self.finding, self.content_size.width
        name = Content.assemble(found.id, (" bonus", "$quiet") if found.bonus else "")
        name = name.pad_right(max(0, self._name_width - name.cell_length))
        progress, text, colour = Content(""), found.text, "$quiet"
        if found.verdict is not None:
            mark, status_colour = wording.MARKS[found.verdict.status], wording.STATUS_COLOURS[found.verdict.status]
            if self._outdated:
                status_colour, name = "$quiet", name.stylize("$quiet")
            head = Content.assemble((f"{mark} ", f"bold {status_colour}"), name, " ")
        elif found.checking:
            head = Content.assemble(("◐ ", "$busy"), name, " ")
            bar_cells = 14 if width > 50 else 8
            narrow = width - head.cell_length < bar_cells + _PERCENT or (found.so_far and width <= 100)
            progress = _bar(found.fraction, 0 if narrow else bar_cells)
            room = width - head.cell_length - progress.cell_length - 2
            text = describe_waiting(found.doing, found.so_far, room) or "waiting"
            colour = "$busy" if found.doing or found.so_far else "$quiet"
        else:
            head = Content.assemble((f"{wording.MARKS[Status.PASSED] if found.before else '○'} ", "$quiet"), name, " ")
        gap = "  " if progress else ""
        room = width - head.cell_length - progress.cell_length - len(gap)
        if room < 12:  # too short a piece of a sentence says nothing
            gap, text = "", ""
        text = text if found.so_far else wording.shorten_to(text, room)
        return Content.assemble(head, progress, gap, (text, colour)).truncate(width, ellipsis=True)


_PERCENT = len(" 100%")


def _bar(fraction: float, width: int) -> Content:
    filled = round(max(0.0, min(1.0, fraction)) * width)
    return Content.assemble(("━" * filled, "$busy"), ("━" * (width - filled), "$line"), f" {fraction:4.0%}")


class CriteriaList(RowList):
    """The rows of the criteria. Once the learner has `moved` the selection, it stays where they have put it."""

    def __init__(self, id: str) -> None:
        super().__init__(id=id, initial_index=None)
        self.moved = False
        """Whether the learner has selected a criterion of the lesson."""

    def action_cursor_down(self) -> None:
        """Select the next row."""
        self.moved = True
        super().action_cursor_down()

    def action_cursor_up(self) -> None:
        """Select the previous row."""
        self.moved = True
        super().action_cursor_up()

    def action_first(self) -> None:
        """Select the first row."""
        self.moved = True
        super().action_first()

    def action_last(self) -> None:
        """Select the last row."""
        self.moved = True
        super().action_last()

    def action_select_cursor(self) -> None:
        """Show the selected row's diagnosis."""
        self.moved = True
        super().action_select_cursor()

    def _on_list_item__child_clicked(self, event: ListItem._ChildClicked) -> None:
        self.moved = True  # Textual then calls ListView's own handler, which selects the row
