"""The items of the checklist in cards, one for each subject."""

from __future__ import annotations

from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal, Vertical
from textual.content import Content
from textual.message import Message
from textual.widgets import Static

from tutor.report.assessment import GroupStanding, ItemStanding
from tutor.report.saying import near_day, say_evidence, say_sources

MOST = 2
"""So many exercises are named as evidence, or as what could give it."""

_BAR = 12


def bar(ticked: int, total: int, width: int = _BAR) -> Content:
    """How much is ticked, as a bar; the numbers belong beside it."""
    full = round(width * ticked / max(1, total))
    return Content.assemble(("━" * full, "$good"), ("━" * (width - full), "$line"))


def about(item: ItemStanding) -> str:
    """What the checks have shown of an item; else what would show it."""
    if said := say_evidence(item.evidence, near_day, most=MOST):
        return f"✓ {' · '.join(said)}"
    if sources := say_sources(item.sources[:MOST]):
        more = ["others"] if len(item.sources) > MOST else []
        return f"○ not yet shown by {' or '.join([*sources, *more])}"
    return "○ no check shows this: you are the judge"


class ItemRow(Horizontal, can_focus=True):
    """One item: its box, its text, and below it what the checks have shown."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("space,enter", "tick", "Tick", key_display="Space"),
        Binding("up,k", "screen.go(-1)", show=False),
        Binding("down,j", "screen.go(1)", show=False),
        Binding("left,right", "screen.across", show=False),
        Binding("home", "screen.go(-1000)", show=False),
        Binding("end", "screen.go(1000)", show=False),
    ]

    DEFAULT_CSS = """
    ItemRow {
        height: auto;
        padding: 0 1 0 0;
        border-left: blank;
        &:hover { background: $panel; }
        &:focus {
            background: $block-cursor-background;
            border-left: outer $primary;
            & > .item-box, & .item-text { color: $block-cursor-foreground; text-style: bold; }
        }
        & > .item-box { width: 4; height: 1; }
        & > Vertical { height: auto; width: 1fr; }
        & .item-text, & .item-about { height: auto; }
        & .item-about { color: $quiet; }
        &.-shown .item-about { color: $good; }
        &.-ticked > .item-box { color: $good; text-style: bold; }
        &:focus .item-about { color: $block-cursor-foreground; }
    }
    """

    class Toggled(Message):
        """The learner has ticked or unticked an item."""

        def __init__(self, item: str, ticked: bool) -> None:
            super().__init__()
            self.item, self.ticked = item, ticked

    def __init__(self, item: ItemStanding) -> None:
        super().__init__(id=f"item-{item.id}")
        self.item = item
        self.ticked = item.ticked
        self._box = Static(markup=False, classes="item-box")
        self._about = Static(markup=False, classes="item-about")

    def compose(self) -> ComposeResult:
        yield self._box
        with Vertical():
            yield Static(self.item.text, markup=False, classes="item-text")
            yield self._about

    def on_mount(self) -> None:
        self.show(self.item)

    def show(self, item: ItemStanding) -> None:
        """Show how it stands now."""
        self.item = item
        self._about.update(about(item))
        self.set_class(bool(item.evidence), "-shown")
        self._tick(item.ticked)

    def action_tick(self) -> None:
        """Tick it, or take the tick away."""
        self._tick(not self.ticked)
        self.post_message(self.Toggled(self.item.id, self.ticked))

    def on_click(self) -> None:
        """A click does the same."""
        self.focus()
        self.action_tick()

    def _tick(self, ticked: bool) -> None:
        self.ticked = ticked
        self.set_class(ticked, "-ticked")
        self._box.update("[✓]" if ticked else "[ ]")


class GroupCard(Vertical):
    """The items of one subject, with how many are ticked."""

    DEFAULT_CSS = """
    GroupCard {
        height: auto;
        background: $surface;
        border: round $border-blurred;
        border-title-color: $foreground;
        border-title-style: bold;
        border-subtitle-color: $quiet;
        &:focus-within { border: round $border; border-title-color: $primary; }
        &.-done { border-subtitle-color: $good; }
    }
    """

    def __init__(self, group: GroupStanding) -> None:
        super().__init__(*(ItemRow(item) for item in group.items), id=f"group-{group.id}")
        self.group = group
        self.border_title = group.title

    @property
    def rows(self) -> list[ItemRow]:
        """The rows, in order."""
        return list(self.query(ItemRow))

    def on_mount(self) -> None:
        self.count()

    def show(self, group: GroupStanding) -> None:
        """Show how the items stand now."""
        for row, item in zip(self.rows, group.items, strict=True):
            row.show(item)
        self.count()

    def count(self) -> None:
        """Show how many are ticked."""
        rows = self.rows
        ticked = sum(row.ticked for row in rows)
        full, rest = "━" * 2 * ticked, "━" * 2 * (len(rows) - ticked)
        mark = "✓ " if ticked == len(rows) else ""
        self.border_subtitle = f"[$good]{full}[/][$line]{rest}[/] {mark}{ticked} of {len(rows)}"
        self.set_class(ticked == len(rows), "-done")
