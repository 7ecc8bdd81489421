"""Asks what a given program will do, runs it, and tells and records what was seen."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tutor.content import Lesson, Prediction
from tutor.errors import NoFreeDomain
from tutor.tui import commands
from tutor.tui.control.host import HostScreen
from tutor.tui.control.records import Records

if TYPE_CHECKING:
    from tutor.session.node import NodeState
    from tutor.tui.dialogs.predict import PredictScreen

_GROUP = "prediction"


class Predictions:
    """Opens the predictions of the lesson; their program is ended when they are closed."""

    def __init__(self, host: HostScreen, records: Records) -> None:
        self._host, self._records = host, records
        host.register(commands.PREDICT, self.open, lambda: bool(host.model.lesson.predictions))

    def open(self) -> None:
        """Show the first prediction that is not right yet."""
        from tutor.tui.dialogs.predict import PredictScreen

        model = self._host.model
        lesson = model.lesson

        def answered(prediction: Prediction, option: int) -> None:
            self._host.start_worker(self._run, screen, lesson, prediction, option, group=_GROUP, exclusive=True)

        def closed(_: None) -> None:
            self._host.workers.cancel_group(self._host, _GROUP)

        screen = PredictScreen(lesson, model.progress.of(lesson.id).predictions, answered)
        self._host.app.push_screen(screen, closed)

    async def _run(self, screen: PredictScreen, lesson: Lesson, prediction: Prediction, option: int) -> None:
        from tutor.session.predictions import Outcome, run_prediction

        def show(state: NodeState) -> None:
            screen.show_output([line.text for line in state.lines])

        try:
            outcome = await run_prediction(prediction, show)
        except (NoFreeDomain, OSError) as error:
            outcome = Outcome(None, f"{prediction.program.name} could not be started: {error}")
        if outcome.holds is not None:
            change = self._host.model.session.predict
            progress = await self._records.change(change, lesson, prediction, option == outcome.holds)
            screen.show_answers(progress.of(lesson.id).predictions)
        screen.show_outcome(outcome)
