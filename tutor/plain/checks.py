"""The check, reported as it goes."""

from __future__ import annotations

from functools import partial

from tutor.errors import CommandRefused, EngineError, StorageError
from tutor.judge.events import CheckStarted, CriterionJudged, Event, Progress
from tutor.judge.result import CriterionResult, ExerciseResult
from tutor.judge.verdict import Status
from tutor.plain import speech
from tutor.plain.conversation import Conversation, DialogCommand
from tutor.report.plain import one_line
from tutor.workspace import find_submission


class Checks:
    """Judges the lesson's files, and remembers what was found."""

    def __init__(self, conversation: Conversation) -> None:
        self._conversation = conversation
        self._found: dict[str, ExerciseResult] = {}
        self._said: set[str] = set()
        self._failed = False
        self.commands = (
            DialogCommand(
                "check", "check your node by what it does; check first ends at the first failure", self.check
            ),
            DialogCommand("why", "read the diagnosis of a criterion again, with the evidence", self.why, "CRITERION"),
        )

    async def check(self, words: list[str]) -> None:
        """Judge, and say what each criterion came to."""
        if words not in ([], ["first"]):
            raise CommandRefused("Say check, or check first, which ends at the first failure.")
        session, lesson = self._conversation.session, self._conversation.lesson
        submission = find_submission(lesson, None, session.workspace)
        from tutor import engine  # late: nothing but a check needs ROS

        self._said.clear()
        self._failed = False
        try:
            run_check = partial(engine.run_check, first=True) if words else engine.run_check
            report = await run_check([submission], session.course, only=None, on_event=self._tell)
        except EngineError as error:
            raise CommandRefused(
                f"The check could not be made, which is no fault of your code: {error}. {error.hint}"
            ) from error
        for result in report.exercises:
            self._found[result.id] = result
            self._sum_up(result)
            try:
                session.record(result)
            except StorageError as error:
                self._conversation.say(f"This check is not in your progress: {error}")

    def _tell(self, event: Event) -> None:
        match event:
            case CheckStarted():
                count = speech.counted(len(event.criteria), "criterion").replace("criterions", "criteria")
                self._conversation.say(f"Checking {event.exercise}, {count}. This takes some seconds.")
            case Progress() if event.doing and event.doing not in self._said:  # one run serves many criteria
                self._said.add(event.doing)
                self._conversation.say(f"{event.doing[0].upper()}{event.doing[1:]}.")
            case Progress() if event.so_far and event.so_far not in self._said:
                self._said.add(event.so_far)
                self._conversation.say(f"So far: {one_line(event.so_far)}.")
            case CriterionJudged():
                self._conversation.say(speech.headline(event.result))
                self._say_first_cause(event.result)

    def _say_first_cause(self, result: CriterionResult) -> None:
        """Why the first required criterion failed, as soon as that is final; of the others, it is said at the end."""
        if self._failed or result.bonus or result.verdict.status is not Status.FAILED:
            return
        self._failed = True
        self._conversation.say(f"Cause: {one_line(result.verdict.cause, 1000)}".replace("`", ""))

    def _sum_up(self, result: ExerciseResult) -> None:
        self._conversation.say(speech.outcome(result))
        missed = [criterion for criterion in result.criteria if not criterion.verdict.passed]
        for criterion in missed:
            for line in speech.diagnosis(criterion):
                self._conversation.say(line)
        if missed:
            self._conversation.say(f"why {missed[0].id} reads the evidence, hint the next hint.")
        elif self._conversation.lesson is not self._conversation.session.lessons[-1]:
            self._conversation.say("Well done. next goes to the next lesson, checklist to what you can do by now.")
        else:
            self._conversation.say("Well done: this was the last lesson. checklist goes to what you can do by now.")

    async def why(self, words: list[str]) -> None:
        """One criterion of the last check."""
        result = self._found.get(self._conversation.lesson.id)
        if result is None:
            raise CommandRefused("There is no check of this lesson yet: say check.")
        for criterion in result.criteria:
            if words and criterion.id == words[0].lower():
                for line in (*speech.diagnosis(criterion), *speech.evidence(criterion)):
                    self._conversation.say(line)
                return
        known = speech.listed(criterion.id for criterion in result.criteria)
        raise CommandRefused(f"Which criterion? They are {known}.")
