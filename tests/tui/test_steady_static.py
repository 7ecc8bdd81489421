"""A text that is given again what it says already."""

from __future__ import annotations

import pytest
from textual.app import App, ComposeResult
from textual.content import Content
from textual.visual import VisualType

from tutor.tui.widgets.steady_static import SteadyStatic


class Counted(SteadyStatic):
    """Counts how often it asks to be painted again."""

    asked = 0

    def refresh(self, *args: object, **keys: object) -> Counted:
        """Count it."""
        self.asked += 1
        return self


class OneText(App[None]):
    """An app with one text."""

    def compose(self) -> ComposeResult:
        yield Counted(Content.styled("running", "bold"))


@pytest.mark.parametrize(
    ("shown", "given", "painted"),
    [
        (Content.styled("a", "bold"), Content.styled("a", "bold"), False),
        (Content.styled("a", "bold"), Content.styled("a", "italic"), True),
        (Content.styled("a", "bold"), Content.styled("b", "bold"), True),
        ("a", "a", False),
        ("a", "b", True),
        ("a", Content("a"), True),
    ],
)
async def test_only_what_differs_is_painted(shown: VisualType, given: VisualType, painted: bool) -> None:
    app = OneText()
    async with app.run_test():
        text = app.query_one(Counted)
        text.update(shown)
        before = text.asked
        text.update(given)
        assert (text.asked > before) is painted
        assert text.content == given
