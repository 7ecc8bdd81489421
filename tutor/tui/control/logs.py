"""What the learner does to the log: filter, pause, clear, and go where an error points."""

from __future__ import annotations

from tutor.tui import commands, messages
from tutor.tui.control.host import HostScreen
from tutor.tui.widgets.log_pane import LogPane


class Logs:
    """Acts on the log page; asked for from another page, it turns to it."""

    def __init__(self, host: HostScreen, pane: LogPane) -> None:
        self._host, self._pane = host, pane

        def filled() -> bool:
            return pane.has_class("-filled") and (host.page == "log" or pane.has_focus_within)

        host.register(commands.LEVEL, pane.next_level, filled)
        host.register(commands.FILTER, pane.filter, filled)
        host.register(commands.PAUSE, pane.pause, filled)
        host.register(commands.CLEAR, pane.clear, filled)
        host.register(commands.GO_TO_ERROR, self.go_to_error, lambda: pane.has_class("-filled"))

    def go_to_error(self) -> None:
        """Put the cursor where the last traceback points in the learner's own code."""
        place = self._pane.error_place
        if place is None:
            self._host.say("No error in the log points into your code.")
        else:
            self._host.post_message(messages.GoToLine(*place))
