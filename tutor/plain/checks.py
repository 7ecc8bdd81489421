"""The check command, reported while it runs, and the diagnosis of its criteria."""

from __future__ import annotations

from functools import partial

from tutor.errors import CommandRefused, EngineError, StorageError
from tutor.judge.events import CheckStarted, CriterionJudged, Event, Progress
from tutor.judge.result import CriterionResult, ExerciseResult
from tutor.judge.verdict import Status
from tutor.judge.wording import counted
from tutor.plain import speech
from tutor.plain.conversation import Conversation, DialogCommand
from tutor.report.plain import one_line
from tutor.session.explaining import CHECKS_IN_A_ROW, find_mistakes
from tutor.workspace import ExerciseProgress, find_submission


class Checks:
    """Checks the lesson's files, and remembers the latest result of each lesson."""

    def __init__(self, conversation: Conversation) -> None:
        self._conversation = conversation
        self._results: dict[str, ExerciseResult] = {}
        self._announced: set[str] = set()
        self._first_cause_said = False
        self.commands = (
            DialogCommand(
                "check", "check your node by what it does; check first ends at the first failure", self.check
            ),
            DialogCommand("why", "read the diagnosis of a criterion again, with the evidence", self.why, "CRITERION"),
            DialogCommand(
                "explain",
                "read about the mistake that a check has found, with an example",
                self.explain,
                "[CRITERION]",
                aliases=("x",),
            ),
        )

    async def check(self, words: list[str]) -> None:
        """Run the check, and say the verdict of each criterion."""
        if words not in ([], ["first"]):
            raise CommandRefused("Say check, or check first, which ends at the first failure.")
        session, lesson = self._conversation.session, self._conversation.lesson
        submission = find_submission(lesson, None, session.workspace)
        from tutor import engine  # late import: only a check needs ROS

        self._announced.clear()
        self._first_cause_said = False
        try:
            run_check = partial(engine.run_check, first=True) if words else engine.run_check
            report = await run_check([submission], session.course, only=None, on_event=self._on_event)
        except EngineError as error:
            raise CommandRefused(
                f"The check could not be run, which is no fault of your code: {error}. {error.hint}"
            ) from error
        for result in report.exercises:
            self._results[result.id] = result
            self._report_result(result)
            try:
                self._offer_explanation(result, session.record(result).of(result.id))
            except StorageError as error:
                self._conversation.say(f"This check is not in your progress: {error}")

    def _on_event(self, event: Event) -> None:
        match event:
            case CheckStarted():
                count = counted(len(event.criteria), "criterion").replace("criterions", "criteria")
                self._conversation.say(f"Checking {event.exercise}, {count}. This takes a few seconds.")
            case Progress() if event.doing and event.doing not in self._announced:  # one run can serve many criteria
                self._announced.add(event.doing)
                self._conversation.say(f"{event.doing[0].upper()}{event.doing[1:]}.")
            case Progress() if event.so_far and event.so_far not in self._announced:
                self._announced.add(event.so_far)
                self._conversation.say(f"So far: {one_line(event.so_far)}.")
            case CriterionJudged():
                self._conversation.say(speech.headline(event.result))
                self._say_first_cause(event.result)

    def _say_first_cause(self, result: CriterionResult) -> None:
        """Say why the first required criterion failed at once; the others follow at the end."""
        if self._first_cause_said or result.bonus or result.verdict.status is not Status.FAILED:
            return
        self._first_cause_said = True
        self._conversation.say(f"Why: {one_line(result.verdict.cause, 1000)}".replace("`", ""))

    def _report_result(self, result: ExerciseResult) -> None:
        self._conversation.say(speech.outcome(result))
        unmet = [criterion for criterion in result.criteria if not criterion.verdict.passed]
        for criterion in unmet:
            for line in speech.diagnosis(criterion):
                self._conversation.say(line)
        for line in speech.remarks(result):
            self._conversation.say(line)
        if unmet or result.remarks:
            named = [criterion.id for criterion in unmet if criterion.verdict.mistake]
            more = ["explain reads about the mistake, with an example"] if named or result.remarks else []
            more = [f"why {unmet[0].id} reads the evidence", *more, "hint the next hint"] if unmet else more
            self._conversation.say(f"{', '.join(more)}.")
        if unmet:
            return
        lesson, lessons = self._conversation.lesson, self._conversation.session.lessons
        following = next(iter(lessons[lessons.index(lesson) + 1 :]), None)
        if following is None:
            praise, goes_on = "Well done: this was the last lesson.", ""
        elif following.beyond and not lesson.beyond:
            praise, goes_on = "Well done: this was the last lesson of the course.", "next goes beyond it, "
        else:
            praise, goes_on = "Well done.", "next goes to the next lesson, "
        goes = "" if goes_on else " goes"
        self._conversation.say(f"{praise} {goes_on}checklist{goes} to what you can do by now.")

    def _offer_explanation(self, result: ExerciseResult, progress: ExerciseProgress) -> None:
        """Name the command that explains a mistake, at the last of several checks in a row that failed by it."""
        mistake = next(iter(result.mistakes), "")
        if mistake and (count := progress.in_a_row(mistake)) == CHECKS_IN_A_ROW:
            self._conversation.say(f"Your last {count} checks failed for this same reason: explain reads about it.")

    async def explain(self, words: list[str]) -> None:
        """Read the page of the mistake of a criterion, or of the first that failed; of the remarks after a pass.

        The name of a mistake does instead of a criterion's id.
        """
        session, lesson = self._conversation.session, self._conversation.lesson
        result = self._results.get(lesson.id)
        mistakes = {} if result is None else {c.id: c.verdict.mistake for c in result.criteria if c.verdict.mistake}
        remarked = () if result is None else tuple(remark.mistake for remark in result.remarks)
        if words:
            wanted = ["-".join(words).lower()]
            wanted = [mistakes.get(wanted[0], wanted[0])]
        else:
            wanted = [*(() if result is None else result.mistakes[:1]), *remarked] or [*mistakes.values()][:1]
        if not wanted:
            raise CommandRefused("There is no mistake to explain: check names one if a criterion fails.")
        try:
            found = find_mistakes(wanted, session.course, lesson)
        except EngineError as error:
            raise CommandRefused(f"{error}. {error.hint}") from error
        if not found:
            known = f" Those of the last check are of {speech.listed(mistakes)}." if mistakes else ""
            raise CommandRefused(f"There is no mistake {wanted[0]}.{known}")
        for mistake in found:
            for line in speech.page(mistake):
                self._conversation.say(line)

    async def why(self, words: list[str]) -> None:
        """Say the diagnosis and evidence of one criterion of the last check."""
        result = self._results.get(self._conversation.lesson.id)
        if result is None:
            raise CommandRefused("There is no check of this lesson yet: say check.")
        for criterion in result.criteria:
            if words and criterion.id == words[0].lower():
                for line in (*speech.diagnosis(criterion), *speech.evidence(criterion)):
                    self._conversation.say(line)
                return
        ids = speech.listed(criterion.id for criterion in result.criteria)
        raise CommandRefused(f"Which criterion? They are {ids}.")
