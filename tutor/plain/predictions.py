"""Commands on predictions: what will this program do? Then it runs, and its lines are read as they come."""

from __future__ import annotations

from tutor.content import Prediction
from tutor.errors import CommandRefused, NoFreeDomain
from tutor.judge.wording import counted
from tutor.plain import speech
from tutor.plain.conversation import Conversation, DialogCommand
from tutor.report.plain import one_line
from tutor.session.node import NodeState
from tutor.session.predictions import run_prediction, standing


class Predictions:
    """The predictions of the current lesson."""

    def __init__(self, conversation: Conversation) -> None:
        self._conversation = conversation
        self.commands = (
            DialogCommand("predictions", "list what you can predict in this lesson", self.show),
            DialogCommand(
                "predict", "say what a given program will do, then hear what it does", self.predict, "NUMBER"
            ),
        )

    def _predictions(self) -> tuple[Prediction, ...]:
        lesson = self._conversation.lesson
        if not lesson.predictions:
            others = [other.id for other in self._conversation.session.lessons if other.predictions]
            more = f" There is in {speech.listed(others)}." if others else ""
            raise CommandRefused(f"There is nothing to predict in this lesson.{more}")
        return lesson.predictions

    async def show(self, words: list[str]) -> None:
        """Say one line per prediction."""
        answers = self._conversation.session.progress().of(self._conversation.lesson.id).predictions
        for number, prediction in enumerate(self._predictions(), 1):
            self._conversation.say(f"{number}: {prediction.id}, {standing(answers.get(prediction.id))}.")
        self._conversation.say("predict 1 asks the first.")

    async def predict(self, words: list[str]) -> None:
        """Read a program and the options, ask for the answer, run the program, and tell."""
        say, session, lesson = self._conversation.say, self._conversation.session, self._conversation.lesson
        prediction = self._find(words)
        answer = await self._ask(prediction)
        if answer is None:
            say("Not answered, and not run.")
            return
        say(f"{prediction.program.name} runs. It writes:")
        shown = 0

        def read_on(state: NodeState) -> None:
            nonlocal shown
            for line in state.lines[shown:]:
                say(one_line(line.text, 500))
            shown = len(state.lines)

        try:
            outcome = await run_prediction(prediction, read_on)
        except (NoFreeDomain, OSError) as error:
            raise CommandRefused(f"The program cannot be started: {error}") from error
        if outcome.holds is None:
            say(f"Nothing is recorded, as {outcome.problem}. Is the machine very busy? Try again.")
            return
        seen = f"{outcome.holds + 1}, {prediction.options[outcome.holds].says}"
        say(f"{'Right' if answer == outcome.holds else 'Not so'}. What was seen: {seen}.")
        say(" ".join(prediction.because.split()))
        if session.workspace.exists:
            session.predict(lesson, prediction, answer == outcome.holds)
        else:
            say("Without a workspace, your answer is not kept: say start.")

    def _find(self, words: list[str]) -> Prediction:
        predictions = self._predictions()
        if not words:
            raise CommandRefused("Which one? Give its number, as in: predict 1. predictions lists them.")
        named = {prediction.id: prediction for prediction in predictions}
        if words[0].isdecimal() and 1 <= int(words[0]) <= len(predictions):
            return predictions[int(words[0]) - 1]
        if words[0].lower() in named:
            return named[words[0].lower()]
        raise CommandRefused(f"There is no prediction {words[0]}: they go from 1 to {len(predictions)}.")

    async def _ask(self, prediction: Prediction) -> int | None:
        """Return the index of the learner's answer; None if there is none."""
        say, count = self._conversation.say, len(prediction.options)
        lines = speech.code(prediction.program.read_text(encoding="utf-8"))
        say(f"{prediction.program.name}, {counted(len(lines), 'line')} of code:")
        for line in lines:
            say(line)
        say(f"End of {prediction.program.name}.")
        say(" ".join(prediction.asks.split()))
        for number, option in enumerate(prediction.options, 1):
            say(f"{number}: {option.says}.")
        answer = await self._conversation.ask(f"Your answer, 1 to {count}; anything else leaves: ")
        given = (answer or "").strip()
        return int(given) - 1 if given.isdecimal() and 1 <= int(given) <= count else None
