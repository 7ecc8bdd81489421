"""Two one-line widgets: tabs, and the actions that go now with their keys. Both by key and by mouse."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import ClassVar

from textual import events
from textual.binding import Binding, BindingType
from textual.content import Content
from textual.message import Message
from textual.reactive import reactive
from textual.widget import Widget

_BETWEEN_TABS = 1
_BETWEEN_ACTIONS = 3


class TabStrip(Widget, can_focus=True):
    """Tabs in one line. A label may change at any time: it carries counts."""

    DEFAULT_CSS = """
    TabStrip { height: 1; width: 1fr; background: $panel; color: $quiet; padding: 0 1; text-wrap: nowrap; }
    TabStrip:focus { text-style: underline; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("left", "step(-1)", "Previous tab", show=False),
        Binding("right", "step(1)", "Next tab", show=False),
    ]
    active = reactive("", repaint=False)
    """Repainted by the handler of `Turned`, with the page: a strip that is drawn first makes the page wait a frame."""
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
        """Tell it."""
        self.post_message(self.Turned(name))

    def action_step(self, by: int) -> None:
        """To the next one, or the one before."""
        names = list(self.labels)
        self.active = names[(names.index(self.active) + by) % len(names)]

    def on_click(self, event: events.Click) -> None:
        """To the one under the pointer."""
        if (name := _at(event, zip(self.labels, self._parts(), strict=True), _BETWEEN_TABS)) is not None:
            self.active = name

    def render(self) -> Content:
        """All labels; the active one stands out by more than its colour, and in the others the letter that is a key."""
        return Content(" " * _BETWEEN_TABS).join(self._parts())

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
"""A key as it is read, what it does, and the action's name on the panel around."""


class ActionBar(Widget):
    """What can be done now: keys to read, words to click."""

    DEFAULT_CSS = """
    ActionBar { height: 1; width: 1fr; color: $quiet; padding: 0 1; background: $surface; text-wrap: nowrap; }
    """
    actions: reactive[Sequence[Action]] = reactive(())

    def __init__(self, actions: Iterable[Action] = (), id: str | None = None) -> None:
        super().__init__(id=id)
        self.set_reactive(ActionBar.actions, tuple(actions))

    async def on_click(self, event: events.Click) -> None:
        """Do the one under the pointer, on the panel around."""
        parts = zip((action for _, _, action in self.actions), self._parts(), strict=True)
        if (action := _at(event, parts, _BETWEEN_ACTIONS)) is not None and isinstance(self.parent, Widget):
            await self.parent.run_action(action)

    def render(self) -> Content:
        """Key and word of each."""
        joined = Content(" " * _BETWEEN_ACTIONS).join(self._parts())
        return joined.truncate(self.content_size.width, ellipsis=True)

    def _parts(self) -> list[Content]:
        return [Content.assemble((key, "bold $accent"), f" {label}") for key, label, _ in self.actions]


def _at(event: events.Click, parts: Iterable[tuple[str, Content]], between: int) -> str | None:
    """The name of the part that was clicked, where they stand in one line."""
    offset = event.get_content_offset(event.widget) if event.widget is not None else None
    if offset is None:
        return None
    start = 0
    for name, part in parts:
        if start <= offset.x < start + part.cell_length:
            return name
        start += part.cell_length + between
    return None
