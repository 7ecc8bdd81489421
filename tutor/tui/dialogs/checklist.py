"""The self-assessment checklist, in which learners tick what they can do by now."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import ClassVar

from textual import events, on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import ItemGrid, VerticalScroll
from textual.content import Content
from textual.screen import Screen
from textual.widgets import Static

from tutor.report.assessment import Assessment
from tutor.tui.widgets.checklist import GroupCard, ItemRow, bar
from tutor.tui.widgets.key_footer import KeyFooter

TWO_COLUMNS_MIN_WIDTH = 110
"""Minimum screen width, in columns, for two columns of cards."""


class ChecklistScreen(Screen[None]):
    """Four cards of items. `tick` is called to save a tick, `export` to ask where to write the checklist."""

    CSS_PATH = Path(__file__).with_name("checklist.tcss")
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("x,X", "export", "Export", key_display="x"),
        Binding("t", "theme", "Theme"),
        Binding("escape", "close", "Back", key_display="Esc"),
        Binding("q,6,f12", "close", show=False),
    ]
    AUTO_FOCUS = "ItemRow"

    def __init__(
        self,
        assessment: Assessment,
        *,
        tick: Callable[[str, bool], None],
        export: Callable[[], None],
        theme: Callable[[], None],
    ) -> None:
        super().__init__()
        self._assessment = assessment
        self._tick, self._export, self._theme = tick, export, theme

    def compose(self) -> ComposeResult:
        yield Static(id="checklist-head")
        yield Static(
            "You are the judge: tick what you can do. Below it is what your checks show.",
            id="checklist-lead",
        )
        with VerticalScroll(id="checklist-scroll", can_focus=False), ItemGrid(id="checklist-cards"):
            for group in self._assessment.groups:
                yield GroupCard(group)
        yield Static(id="checklist-ready")
        yield KeyFooter(compact=True)

    def on_mount(self) -> None:
        self._show()

    def on_resize(self, event: events.Resize) -> None:
        """Adapt the layout to the size."""
        self.set_class(event.size.width >= TWO_COLUMNS_MIN_WIDTH, "-two")
        self.set_class(event.size.height < 30, "-low")
        self.set_class(event.size.height >= 44, "-tall")

    @property
    def cards(self) -> list[GroupCard]:
        """All cards, in order."""
        return list(self.query(GroupCard))

    @property
    def rows(self) -> list[ItemRow]:
        """All items, in order."""
        return [row for card in self.cards for row in card.rows]

    def show(self, assessment: Assessment) -> None:
        """Show a new state: a check has passed, or something was ticked in another window."""
        self._assessment = assessment
        if self.is_mounted:  # else on_mount shows it
            self._show()

    def _show(self) -> None:
        for card, group in zip(self.cards, self._assessment.groups, strict=True):
            card.show(group)
        self._show_totals()

    @on(ItemRow.Toggled)
    def _toggled(self, event: ItemRow.Toggled) -> None:
        for card in self.cards:
            card.count()
        self._show_totals()
        self._tick(event.item, event.ticked)

    def _show_totals(self) -> None:
        rows = self.rows
        ticked, total = sum(row.ticked for row in rows), len(rows)
        shown = sum(row.item.shown for row in rows)
        self.query_one("#checklist-head", Static).update(
            Content.assemble(
                ("Self-assessment  ", "bold $primary"),
                bar(ticked, total),
                (f"  {ticked} of {total} ticked", "bold"),
                (f" · {shown} shown by your checks", "$quiet"),
            ),
            layout=False,
        )
        self._show_banner(ticked == total > 0)

    def _show_banner(self, ready: bool) -> None:
        """Show the banner that says what comes next, if everything has been ticked."""
        found, banner = self._assessment, self.query_one("#checklist-ready", Static)
        banner.display = ready and bool(found.ready_text)
        if banner.display:
            banner.border_title = Content(found.ready_title)
            banner.update(
                Content.assemble(
                    ("✓ ", "bold $good"), found.ready_text, "\n", (_describe_exercises_left(found), "$quiet")
                )
            )
            if (row := self.focused) is not None:  # the banner takes up room at the bottom
                self.call_after_refresh(row.scroll_visible, animate=False)

    # --- moving ---

    def action_go(self, by: int) -> None:
        """Move the focus down (or up) by this many items, stopping at the last (or first)."""
        rows = self.rows
        current = next((n for n, row in enumerate(rows) if row.has_focus), 0)
        rows[max(0, min(len(rows) - 1, current + by))].focus()

    def action_across(self) -> None:
        """Move the focus to the card beside this one, if there are two columns."""
        cards = self.cards
        at = next((n for n, card in enumerate(cards) if card.has_focus_within), 0)
        if not self.has_class("-two") or at ^ 1 >= len(cards):
            return
        place = next((n for n, row in enumerate(cards[at].rows) if row.has_focus), 0)
        beside = cards[at ^ 1].rows
        beside[min(place, len(beside) - 1)].focus()

    # --- actions ---

    def action_export(self) -> None:
        """Ask for format and file, and export."""
        self._export()

    def action_theme(self) -> None:
        """Switch between the dark and the light theme."""
        self._theme()

    def action_close(self) -> None:
        """Go back to the lessons."""
        self.dismiss(None)


def _describe_exercises_left(assessment: Assessment) -> str:
    """Say which exercises are left, for a learner who has ticked everything."""
    counts = assessment.counts
    left = counts.total - counts.passed
    if not left:
        return f"All {counts.total} exercises are passed, too."
    some = "One exercise is" if left == 1 else f"{left} exercises are"
    return f"{some} not passed yet: good practice before you go on."
