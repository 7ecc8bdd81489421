"""Two one-line widgets for keyboard and mouse: tabs, and the actions available now with their keys."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import ClassVar

from textual import events
from textual.binding import Binding, BindingType
from textual.content import Content
from textual.message import Message
from textual.reactive import reactive
from textual.widget import Widget

_TAB_GAP = 1
_ACTION_GAP = 3


class TabStrip(Widget, can_focus=True):
    """Tabs on one line. Labels may change at any time, since they can carry counts."""

    DEFAULT_CSS = """
    TabStrip { height: 1; width: 1fr; background: $panel; color: $quiet; padding: 0 1; text-wrap: nowrap; }
    TabStrip:focus { text-style: underline; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("left", "step(-1)", "Previous tab", show=False),
        Binding("right", "step(1)", "Next tab", show=False),
    ]
    active = reactive("", repaint=False)
    """The handler of `Turned` repaints the strip with the page: painting it first would delay the page by a frame."""
    labels: reactive[dict[str, str]] = reactive({})

    class Turned(Message):
        """Another tab is active."""

        def __init__(self, name: str) -> None:
            super().__init__()
            self.tab = name

    def __init__(self, labels: dict[str, str], id: str | None = None) -> None:
        super().__init__(id=id)
        self.set_reactive(TabStrip.labels, labels)
        self.set_reactive(TabStrip.active, next(iter(labels)))

    def watch_active(self, name: str) -> None:
        """Post `Turned`."""
        self.post_message(self.Turned(name))

    def action_step(self, by: int) -> None:
        """Turn to the next tab, or with a negative `by` to the previous one."""
        names = list(self.labels)
        self.active = names[(names.index(self.active) + by) % len(names)]

    def on_click(self, event: events.Click) -> None:
        """Turn to the clicked tab."""
        if (name := _clicked_part(event, zip(self.labels, self._parts(), strict=True), _TAB_GAP)) is not None:
            self.active = name

    def render(self) -> Content:
        """All labels. The active one stands out by more than colour; in the others the key's letter stands out."""
        return Content(" " * _TAB_GAP).join(self._parts())

    def _parts(self) -> list[Content]:
        return [
            Content.styled(f" {label} ", "bold $block-cursor-foreground on $block-cursor-background")
            if name == self.active
            else Content.assemble(
                " ",
                (label[:1], "$accent underline" if label[:1].isalpha() else "$good"),
                (f"{label[1:]} ", "$foreground"),
            )
            for name, label in self.labels.items()
        ]


Action = tuple[str, str, str]
"""A key as displayed, a label, and the name of the action on the parent widget."""


class ActionBar(Widget):
    """The actions available now: keys to press, labels to click."""

    DEFAULT_CSS = """
    ActionBar { height: 1; width: 1fr; color: $quiet; padding: 0 1; background: $surface; text-wrap: nowrap; }
    """
    actions: reactive[Sequence[Action]] = reactive(())

    def __init__(self, actions: Iterable[Action] = (), id: str | None = None) -> None:
        super().__init__(id=id)
        self.set_reactive(ActionBar.actions, tuple(actions))

    async def on_click(self, event: events.Click) -> None:
        """Run the clicked action on the parent widget."""
        parts = zip((action for _, _, action in self.actions), self._parts(), strict=True)
        if (action := _clicked_part(event, parts, _ACTION_GAP)) is not None and isinstance(self.parent, Widget):
            await self.parent.run_action(action)

    def render(self) -> Content:
        """Key and label of each action."""
        joined = Content(" " * _ACTION_GAP).join(self._parts())
        return joined.truncate(self.content_size.width, ellipsis=True)

    def _parts(self) -> list[Content]:
        return [Content.assemble((key, "bold $accent"), f" {label}") for key, label, _ in self.actions]


def _clicked_part(event: events.Click, parts: Iterable[tuple[str, Content]], gap: int) -> str | None:
    """Return the name of the clicked part; the parts are on one line, `between` cells apart."""
    offset = event.get_content_offset(event.widget) if event.widget is not None else None
    if offset is None:
        return None
    start = 0
    for name, part in parts:
        if start <= offset.x < start + part.cell_length:
            return name
        start += part.cell_length + gap
    return None
