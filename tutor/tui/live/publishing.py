"""What the learner publishes by hand: a line for each topic below the tabs of the live page."""

from __future__ import annotations

from tutor.tui.live import formatting
from tutor.tui.live.state import LiveState
from tutor.tui.widgets.steady_static import SteadyStatic


class Publishing(SteadyStatic):
    """Says on which topics the learner publishes, and who receives it; hidden while there is nothing to say."""

    DEFAULT_CSS = """
    Publishing { height: auto; max-height: 3; color: $busy; padding: 0 1; display: none; &.-filled { display: block; } }
    """

    def __init__(self, state: LiveState, id: str) -> None:
        super().__init__(id=id, markup=False)
        self._state = state

    @property
    def active(self) -> list[str]:
        """The topics on which messages are being published at a rate."""
        return [held.topic for held in self._state.published.values() if held.rate_hz and not held.over]

    def show(self) -> None:
        """Show what is published now."""
        text = "\n".join(formatting.publishing(held) for held in self._state.published.values())
        self.set_class(bool(text), "-filled")
        self.update(text)
