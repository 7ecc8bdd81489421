"""The self-assessment checklist: what the learner can do by now, in their own judgement."""

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

TWO_COLUMNS = 110
"""From this width on the cards are in two columns."""


class ChecklistScreen(Screen[None]):
    """Four cards of items. `tick` keeps a tick, `export` asks where to write the checklist."""

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
        """Two columns where there is room."""
        self.set_class(event.size.width >= TWO_COLUMNS, "-two")
        self.set_class(event.size.height < 30, "-low")
        self.set_class(event.size.height >= 44, "-tall")

    @property
    def cards(self) -> list[GroupCard]:
        """The cards, in order."""
        return list(self.query(GroupCard))

    @property
    def rows(self) -> list[ItemRow]:
        """Every item, in order."""
        return [row for card in self.cards for row in card.rows]

    def show(self, assessment: Assessment) -> None:
        """Show how it stands now: a check has passed, or another window has ticked something."""
        self._assessment = assessment
        if self.is_mounted:  # else it is shown when it is
            self._show()

    def _show(self) -> None:
        for card, group in zip(self.cards, self._assessment.groups, strict=True):
            card.show(group)
        self._count()

    @on(ItemRow.Toggled)
    def _toggled(self, event: ItemRow.Toggled) -> None:
        for card in self.cards:
            card.count()
        self._count()
        self._tick(event.item, event.ticked)

    def _count(self) -> None:
        rows = self.rows
        ticked, total = sum(row.ticked for row in rows), len(rows)
        shown = sum(bool(row.item.evidence) for row in rows)
        self.query_one("#checklist-head", Static).update(
            Content.assemble(
                ("Self-assessment  ", "bold $primary"),
                bar(ticked, total),
                (f"  {ticked} of {total} ticked", "bold"),
                (f" · {shown} shown by your checks", "$quiet"),
            ),
            layout=False,
        )
        self._welcome_on(ticked == total > 0)

    def _welcome_on(self, ready: bool) -> None:
        """Anyone who has ticked everything sees what comes next."""
        found, banner = self._assessment, self.query_one("#checklist-ready", Static)
        banner.display = ready and bool(found.ready_text)
        if banner.display:
            banner.border_title = Content(found.ready_title)
            banner.update(Content.assemble(("✓ ", "bold $good"), found.ready_text, "\n", (_rest(found), "$quiet")))
            if (row := self.focused) is not None:  # the banner takes room from below
                self.call_after_refresh(row.scroll_visible, animate=False)

    # --- moving ---

    def action_go(self, by: int) -> None:
        """To the item this many further down (or up), and no further than the last."""
        rows = self.rows
        at = next((n for n, row in enumerate(rows) if row.has_focus), 0)
        rows[max(0, min(len(rows) - 1, at + by))].focus()

    def action_across(self) -> None:
        """To the card beside this one, where there are two columns."""
        cards = self.cards
        at = next((n for n, card in enumerate(cards) if card.has_focus_within), 0)
        if not self.has_class("-two") or at ^ 1 >= len(cards):
            return
        place = next((n for n, row in enumerate(cards[at].rows) if row.has_focus), 0)
        beside = cards[at ^ 1].rows
        beside[min(place, len(beside) - 1)].focus()

    # --- actions ---

    def action_export(self) -> None:
        """Ask for format and file, and write it."""
        self._export()

    def action_theme(self) -> None:
        """Dark to light and back."""
        self._theme()

    def action_close(self) -> None:
        """Back to the lessons."""
        self.dismiss(None)


def _rest(assessment: Assessment) -> str:
    """How the exercises stand, for anyone who has ticked everything."""
    left = len(assessment.exercises) - assessment.passed
    if not left:
        return f"All {len(assessment.exercises)} exercises are passed, too."
    some = "One exercise is" if left == 1 else f"{left} exercises are"
    return f"{some} not passed yet: good practice before you go on."
