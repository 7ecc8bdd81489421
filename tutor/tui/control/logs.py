"""Commands on the log: filter, pause, clear, and go to the line an error points to."""

from __future__ import annotations

from tutor.tui import commands, messages
from tutor.tui.control.host import HostScreen
from tutor.tui.widgets.log_pane import LogPane


class Logs:
    """Acts on the log page while it is shown or focused; go_to_error works from any page."""

    def __init__(self, host: HostScreen, pane: LogPane) -> None:
        self._host, self._pane = host, pane

        def usable() -> bool:
            return pane.has_class("-filled") and (host.page == "log" or pane.has_focus_within)

        host.register(commands.LEVEL, pane.next_level, usable)
        host.register(commands.FILTER, pane.filter, usable)
        host.register(commands.PAUSE, pane.pause, usable)
        host.register(commands.CLEAR, pane.clear, usable)
        host.register(commands.GO_TO_ERROR, self.go_to_error, lambda: pane.has_class("-filled"))

    def go_to_error(self) -> None:
        """Put the cursor on the line of the learner's code that the last traceback names."""
        location = self._pane.error_location
        if location is None:
            self._host.say("No error in the log points into your code.")
        else:
            self._host.post_message(messages.GoToLine(*location))
