"""Drives an app under Textual's pilot as a person does: what they press, and what they see."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar

import pytest
from textual.app import App
from textual.pilot import Pilot
from textual.screen import Screen
from textual.widgets import TextArea

from tests.waiting import wait_for


class Person[A: App[Any]]:
    """Uses an app by keyboard and mouse."""

    limit_s: ClassVar[float] = 15.0
    """Default time limit of every wait."""

    def __init__(self, app: A, pilot: Pilot[int]) -> None:
        self.app, self.pilot = app, pilot

    async def press(self, *keys: str) -> None:
        await self.pilot.press(*keys)

    async def sees(self, *texts: str) -> None:
        """Wait until every text is on the screen, each within one line."""

        def all_seen() -> bool:
            screen = self.screen()
            return all(text in screen for text in texts)

        await self.until(all_seen, texts)

    async def sees_no(self, text: str) -> None:
        """Wait until the text is not on the screen, and the screen has been laid out."""
        await self.until(lambda: bool(screen := self.screen()) and text not in screen, f"no {text}")

    async def until(self, condition: Callable[[], bool], what: object = "", *, limit_s: float | None = None) -> None:
        if not await wait_for(condition, self.limit_s if limit_s is None else limit_s):
            pytest.fail("\n".join([f"not seen: {what}", self.screen(), *self.background()]))

    def background(self) -> list[str]:
        """Further lines for the message of a failed wait, as logs that are not on the screen."""
        return []

    def screen(self) -> str:
        """The screen as text: the top screen, drawn over those below it. Empty while it is not laid out."""
        width, height = self.app.size
        screen: Screen[object] = self.app.screen
        if screen._compositor.size != (width, height):  # just opened, or just resized: not laid out yet
            return ""
        # A widget that has just been mounted or removed has no styles, and the app does not draw it then.
        drawn = screen._compositor.visible_widgets
        if not all(widget._component_styles for widget in drawn if isinstance(widget, TextArea)):
            return ""
        lines = screen._compositor.render_strips()
        assert len(lines) == height
        too_long = [line.text for line in lines if line.cell_length > width]
        assert not too_long, too_long
        return "\n".join(line.text for line in lines)
