"""What the learner does to the log: filter, pause, clear, and go where an error points."""

from __future__ import annotations

from tutor.tui import messages
from tutor.tui.screens.host import CommandHandler, HostScreen
from tutor.tui.widgets.log_pane import LogPane


class Logs:
    """Acts on the log page; asked for from another page, it turns to it."""

    def __init__(self, host: HostScreen, pane: LogPane) -> None:
        self._host, self._pane = host, pane

        def filled() -> bool:
            return pane.has_class("-filled") and (host.page == "log" or pane.has_focus_within)

        self.command_handlers = {
            "level": CommandHandler(pane.next_level, filled),
            "filter": CommandHandler(pane.filter, filled),
            "pause": CommandHandler(pane.pause, filled),
            "clear": CommandHandler(pane.clear, filled),
            "go_to_error": CommandHandler(self.go_to_error, lambda: pane.has_class("-filled")),
        }

    def go_to_error(self) -> None:
        """Put the cursor where the last traceback points in the learner's own code."""
        place = self._pane.error_place
        if place is None:
            self._host.say("No error in the log points into your code.")
        else:
            self._host.post_message(messages.GoToLine(*place))
