"""What the learner does to the log: filter, pause, clear, and go where an error points."""

from __future__ import annotations

from tutor.tui import messages
from tutor.tui.screens.stage import Deed, Stage
from tutor.tui.widgets.log_pane import LogPane


class Logs:
    """Acts on the log page; asked for from another page, it turns to it."""

    def __init__(self, stage: Stage, pane: LogPane) -> None:
        self._stage, self._pane = stage, pane

        def filled() -> bool:
            return pane.has_class("-filled") and (stage.page == "log" or pane.has_focus_within)

        self.deeds = {
            "level": Deed(pane.next_level, filled),
            "filter": Deed(pane.filter, filled),
            "pause": Deed(pane.pause, filled),
            "clear": Deed(pane.clear, filled),
            "go_to_error": Deed(self.go_to_error, lambda: pane.has_class("-filled")),
        }

    def go_to_error(self) -> None:
        """Put the cursor where the last traceback points in the learner's own code."""
        place = self._pane.error_place
        if place is None:
            self._stage.say("No error in the log points into your code.")
        else:
            self._stage.post_message(messages.GoToLine(*place))
