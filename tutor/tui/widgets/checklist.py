"""The items of the checklist, in one card per subject."""

from __future__ import annotations

from typing import ClassVar

from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.content import Content
from textual.geometry import Size
from textual.message import Message
from textual.widget import Widget

from tutor.report.assessment import AssessedGroup, AssessedItem
from tutor.report.phrases import describe_evidence, describe_sources, near_day

_MAX_EXERCISES = 2
"""At most this many exercises are named as evidence, or as possible sources of it."""

_BAR_CELLS = 12


def bar(ticked: int, total: int, width: int = _BAR_CELLS) -> Content:
    """Return a bar of the ticked share; the caller puts the numbers beside it."""
    filled = round(width * ticked / max(1, total))
    return Content.assemble(("━" * filled, "$good"), ("━" * (width - filled), "$line"))


def _evidence_lines(item: AssessedItem) -> list[tuple[str, str]]:
    """Return (text, colour) of what checks show of an item now, and showed before; else which exercises could."""
    now = describe_evidence([piece for piece in item.evidence if piece.holds], near_day, max_items=_MAX_EXERCISES)
    before = describe_evidence(
        [piece for piece in item.evidence if not piece.holds], near_day, max_items=_MAX_EXERCISES
    )
    lines = [(f"✓ {' · '.join(now)}", "$good")] if now else []
    lines += [(f"○ {' · '.join(before)}", "$quiet")] if before else []
    if lines:
        return lines
    if sources := describe_sources(item.sources[:_MAX_EXERCISES]):
        more = ["others"] if len(item.sources) > _MAX_EXERCISES else []
        return [(f"○ not yet shown by {' or '.join([*sources, *more])}", "$quiet")]
    return [("○ no check shows this: you are the judge", "$quiet")]


class ItemRow(Widget, can_focus=True):
    """One item: a check box and the text, with the evidence from checks below."""

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
        &:focus { background: $block-cursor-background; border-left: outer $primary; }
    }
    """

    class Toggled(Message):
        """The learner has ticked or unticked an item."""

        def __init__(self, item: str, ticked: bool) -> None:
            super().__init__()
            self.item, self.ticked = item, ticked

    def __init__(self, item: AssessedItem) -> None:
        super().__init__(id=f"item-{item.id}")
        self.item = item
        self.ticked = item.ticked

    def show(self, item: AssessedItem) -> None:
        """Show the item's current state."""
        if item != self.item or item.ticked != self.ticked:
            evidence_changed = _evidence_lines(item) != _evidence_lines(self.item)
            self.item, self.ticked = item, item.ticked
            self.refresh(layout=evidence_changed)

    def render(self) -> Content:
        """The box, with the wrapped text and evidence to its right."""
        width = self.content_size.width
        return Content("\n").join(self._lines(width)) if width else Content()

    def get_content_height(self, container: Size, viewport: Size, width: int) -> int:
        """The number of lines after wrapping."""
        return len(self._lines(width))

    def _lines(self, width: int) -> list[Content]:
        box = Content.styled("[✓] ", "bold $good") if self.ticked else Content("[ ] ")
        room = max(1, width - box.cell_length)
        focused = "$block-cursor-foreground" if self.has_focus else ""
        text = Content.styled(self.item.text, f"bold {focused}" if focused else "").wrap(room)
        shown = [
            line
            for evidence, colour in _evidence_lines(self.item)
            for line in Content.styled(evidence, focused or colour).wrap(room)
        ]
        indent = Content(" " * box.cell_length)
        return [Content.assemble(indent if n else box, line) for n, line in enumerate([*text, *shown])]

    def on_focus(self) -> None:
        """Repaint in the colours of the focus."""
        self.refresh()

    def on_blur(self) -> None:
        """Repaint in the usual colours."""
        self.refresh()

    def action_tick(self) -> None:
        """Tick or untick the item."""
        self.ticked = not self.ticked
        self.refresh()
        self.post_message(self.Toggled(self.item.id, self.ticked))

    def on_click(self) -> None:
        """Tick or untick the item."""
        self.action_tick()


class GroupCard(Vertical):
    """The items of one subject, with the number of ticked ones."""

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

    def __init__(self, group: AssessedGroup) -> None:
        super().__init__(*(ItemRow(item) for item in group.items), id=f"group-{group.id}")
        self.group = group
        self.border_title = Content(group.title)

    @property
    def rows(self) -> list[ItemRow]:
        """All rows, in order."""
        return list(self.query(ItemRow))

    def on_mount(self) -> None:
        self.count()

    def show(self, group: AssessedGroup) -> None:
        """Show the current state of the items."""
        for row, item in zip(self.rows, group.items, strict=True):
            row.show(item)
        self.count()

    def count(self) -> None:
        """Show how many items are ticked."""
        rows = self.rows
        ticked = sum(row.ticked for row in rows)
        filled, rest = "━" * 2 * ticked, "━" * 2 * (len(rows) - ticked)
        mark = "✓ " if ticked == len(rows) else ""
        self.border_subtitle = f"[$good]{filled}[/][$line]{rest}[/] {mark}{ticked} of {len(rows)}"
        self.set_class(ticked == len(rows), "-done")
