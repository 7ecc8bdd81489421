"""Updating a text with what it shows already."""

from __future__ import annotations

import pytest
from textual.app import App, ComposeResult
from textual.content import Content
from textual.visual import VisualType

from tutor.tui.widgets.steady_static import SteadyStatic


class RefreshCounter(SteadyStatic):
    """Counts its requests to be repainted."""

    refreshes = 0

    def refresh(self, *args: object, **keys: object) -> RefreshCounter:
        """Count the request."""
        self.refreshes += 1
        return self


class OneText(App[None]):
    """An app with one text."""

    def compose(self) -> ComposeResult:
        yield RefreshCounter(Content.styled("running", "bold"))


@pytest.mark.parametrize(
    ("shown", "given", "repainted"),
    [
        (Content.styled("a", "bold"), Content.styled("a", "bold"), False),
        (Content.styled("a", "bold"), Content.styled("a", "italic"), True),
        (Content.styled("a", "bold"), Content.styled("b", "bold"), True),
        ("a", "a", False),
        ("a", "b", True),
        ("a", Content("a"), True),
    ],
)
async def test_only_a_different_content_is_repainted(shown: VisualType, given: VisualType, repainted: bool) -> None:
    app = OneText()
    async with app.run_test():
        text = app.query_one(RefreshCounter)
        text.update(shown)
        before = text.refreshes
        text.update(given)
        assert (text.refreshes > before) is repainted
        assert text.content == given
