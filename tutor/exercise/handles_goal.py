"""Forms: an action server handles a goal, from its acceptance to its result, and tells meanwhile how far it is."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from tutor.exercise.form import Exercise, Form
from tutor.exercise.goal_run import (
    CANCELED_S,
    STEPS,
    Fields,
    Goal,
    GoalRun,
    OfGoal,
    Outcome,
    SendGoal,
    action_missing,
    describe_goal,
    drawn,
    has_more,
    of_goal,
    outcome_of,
    unanswered,
)
from tutor.exercise.nouns import Action, agrees
from tutor.exercise.seen_run import Seen
from tutor.judge.check import Criterion
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import GoalAnswer
from tutor.judge.verdict import Verdict, failed, passed
from tutor.judge.wording import counted, output_tail

_IN_RESULT = "Look at what the callback puts into the result before it returns it."


@dataclass(frozen=True)
class HandlesGoal(Form):
    """An action server handles a goal as it should: it accepts it, sends feedback, and ends it with a result.

    `goal`: its fields and their values, or a function that draws them at random. `ends`: "succeeded", "aborted",
    "rejected", or "canceled", where we ask for that once it is accepted and the feedback is there, and not before
    `cancel_after_s`. `feedback`: how many messages of it must come at least. `result`: those of its fields that matter,
    with their values, or a function that makes them from the goal. `partial`: of a list in the result, the beginning
    must be there, and not all. `within_s`: how long the goal may take, in seconds; once canceled, it is 3 s at most.
    `then`: another goal, which is sent to the same server once this one is over, and must succeed with its own result.

        HandlesGoal("counts", FIBONACCI, {"order": 5}, feedback=1, result={"sequence": [0, 1, 1, 2, 3, 5]})
        HandlesGoal("stops", FIBONACCI, {"order": 50}, ends="canceled", feedback=2)
        HandlesGoal("refuses", FIBONACCI, {"order": -1}, ends="rejected", then={"order": 0})
    """

    action: Action
    goal: Goal = field(hash=False)
    ends: Outcome = "succeeded"
    feedback: int = 0
    result: OfGoal | None = field(default=None, hash=False)
    within_s: float = 10.0
    cancel_after_s: float = 0.0
    partial: bool = False
    then: Fields | None = field(default=None, hash=False)

    def __post_init__(self) -> None:
        if self.ends not in STEPS:
            raise ValueError(f"{self.id}: {self.ends!r} is no end of a goal: take one of {', '.join(STEPS)}")

    def criterion(self, exercise: Exercise) -> Criterion:
        return self.judged(self.judge, self.scenario(exercise))

    def scenario(self, exercise: Exercise) -> SendGoal:
        """The goal that is sent; the same one is judged by a `SendsFeedback` of this form."""
        judged = exercise.first(SendsFeedback, lambda form: form.of.id == self.id) is not None
        canceled, within_s = self.ends == "canceled", 0.0 if self.ends == "rejected" else self.within_s
        program, after_s = exercise.program, self.cancel_after_s
        return SendGoal(program, self.action, self.goal, self.feedback, canceled, within_s, after_s, judged, self.then)

    def judge(self, found: GoalRun) -> Verdict:
        """Judge what became of the goal."""
        action, answer, goal = self.action, found.answer, found.goal or drawn(self.goal)
        result = None if self.result is None or self.ends == "rejected" else of_goal(self.result, goal)
        parts = [f"{describe_goal(action, goal)} is {self.ends}"]
        parts += [f"after {counted(self.feedback, 'feedback message')}"] if self.feedback else []
        parts += [f"with {'the beginning of ' if self.partial else ''}{_short(result)}"] if result else []
        expected = " ".join(parts)
        if self.then is not None:
            expected += f"; then {describe_goal(action, self.then)} succeeds"
        tail = output_tail(found.trace)
        if answer is None:
            return failed(expected, f"{action.name} has no action server", action_missing(action, found), tail)
        trail = [str(dict(feedback.message)) for feedback in answer.feedback[:3]]
        observed, why = self._what_is_wrong(found, answer, result)
        if why is None:
            then, why = self._what_is_wrong_then(found)
            observed = then if why is not None else "; ".join(filter(None, (observed, then)))
        if why is not None:
            return failed(expected, observed, why, [*trail, *tail])
        return passed(expected, observed, trail)

    def _what_is_wrong(self, seen: Seen, answer: GoalAnswer, result: Fields | None) -> tuple[str, Observation | None]:
        """What was observed, and the failure, if it is one."""

        def wrong(observed: str, do: str) -> tuple[str, Observation]:
            return observed, wrong_goal(self.action, seen, answer, observed, do, self.ends)

        outcome = outcome_of(answer)
        if self.ends == "canceled" and answer.cancel_accepted is False and not outcome:
            do = "Give the action server a cancel_callback that returns CancelResponse.ACCEPT."
            return wrong("it is accepted, and our request to cancel it is not", do)
        if self.ends == "canceled" and answer.accepted and not outcome:
            if answer.cancel_accepted:
                return wrong(f"it still runs {CANCELED_S:g} s after it accepted to be canceled", STEPS["canceled"])
            return wrong("it runs, and our request to cancel it gets no answer", _LET_IN)
        if answer.accepted is None or (not outcome and self.ends != "rejected"):
            return unanswered(self.action, seen, answer, self.within_s)
        if outcome != self.ends:
            ended = "it is accepted" if self.ends == "rejected" else f"it is {outcome}"
            if self.ends == "canceled" and answer.accepted and not answer.cancel_accepted:
                do = "Let the goal take its time, and let the node take in requests meanwhile."
                return wrong(f"{ended}, not canceled: it ended before our request was taken in", do)
            accept = "Let the goal_callback return GoalResponse.ACCEPT for it."
            return wrong(f"{ended}, not {self.ends}", accept if outcome == "rejected" else STEPS[self.ends])
        if len(answer.feedback) < self.feedback:
            do = "Call publish_feedback() on the goal handle while the goal runs."
            return wrong(f"{self.ends} with {counted(len(answer.feedback), 'feedback message')}", do)
        got = answer.result or {}
        if result is not None and not (begins(got, result) if self.partial else agrees(got, result)):
            return wrong(f"{self.ends} with {_short(got)}, not {_short(result)}", _IN_RESULT)
        return f"{self.ends}, {counted(len(answer.feedback), 'feedback message')}, {_short(got)}", None

    def _what_is_wrong_then(self, found: GoalRun) -> tuple[str, Observation | None]:
        """What was observed of the goal that is sent afterwards, and the failure, if it is one."""
        if self.then is None:
            return "", None
        action, answer = self.action, found.next_answer or GoalAnswer()
        goal, outcome = describe_goal(action, self.then), outcome_of(answer)
        before = f"once another goal is {self.ends}"

        def wrong(says: str, do: str, shared: str = "") -> tuple[str, Observation]:
            return says, wrong_goal(action, found, answer, says, do, "succeeded", shared=shared)

        if answer.accepted is None or not outcome:
            observed, why = unanswered(action, found, answer, self.within_s)
            return f"{observed}, {before}", why
        if outcome == "rejected":
            do = "Let the goal_callback return GoalResponse.ACCEPT for this one."
            return wrong(f"{goal} is rejected, {before}", do)
        if outcome != "succeeded":
            do = "See what the node still remembers of the goal before: each goal begins afresh."
            return wrong(f"{goal} is {outcome}, {before}", do)
        got, result = answer.result or {}, {} if self.result is None else of_goal(self.result, self.then)
        if not agrees(got, result):
            says = f"{goal} ends with {_short(got)}, not {_short(result)}, {before}"
            shared = "a goal that came after another one" if self._has_earlier(found, got, result) else ""
            return wrong(says, f"{_IN_RESULT} Each goal begins afresh.", shared)
        return f"then {goal} succeeds", None

    def _has_earlier(self, found: GoalRun, got: Fields, result: Fields) -> bool:
        """Whether a result has more than its own, and all of it belongs to the goal before."""
        earlier = {} if self.result is None else of_goal(self.result, found.goal or drawn(self.goal))
        both = {
            name: [*value, *earlier.get(name, ())] for name, value in result.items() if isinstance(value, list | tuple)
        }
        return has_more(got, result) and not has_more(got, both)


_LET_IN = "Let the node take in requests while the goal runs: see what runs its execute callback meanwhile."


@dataclass(frozen=True)
class SendsFeedback(Form):
    """The goal of another criterion gets feedback step by step, while it runs.

    `of`: that criterion. `steps`: the feedback messages in their order, or a function that makes them from the goal.
    Each one that comes must be one of them, and none may come after a later one; `may_miss` says how many need not
    come, as the first or the last one. `over_s`: from the first to the last one, at least so many seconds must pass.

        SendsFeedback("feedback", counts, lambda goal: [{"sequence": [0, 1][:n]} for n in (1, 2)], over_s=0.3)
    """

    of: HandlesGoal
    steps: Callable[[Fields], Sequence[Fields]] | Sequence[Fields] = field(hash=False)
    may_miss: int = 0
    over_s: float = 0.0

    def criterion(self, exercise: Exercise) -> Criterion:
        return self.judged(self.judge, self.of.scenario(exercise))

    def judge(self, found: GoalRun) -> Verdict:
        """Judge the feedback, however the goal ended."""
        action, goal = self.of.action, found.goal or drawn(self.of.goal)
        steps = self.steps(goal) if callable(self.steps) else self.steps
        least = max(1, len(steps) - self.may_miss)
        expected = f"{describe_goal(action, goal)} gets at least {counted(least, 'feedback message')}, step by step"
        if found.answer is None:
            return failed(expected, f"{action.name} has no action server", action_missing(action, found))
        feedback = found.answer.feedback
        trail = [str(dict(sample.message)) for sample in feedback[:8]]

        def wrong(observed: str, do: str) -> Verdict:
            why = wrong_goal(action, found, found.answer, observed, do, "feedback")
            return failed(expected, observed, why, [*trail, *output_tail(found.trace, 3)])

        reached, different = 0, 0
        for sample in feedback:
            at = next((n for n, step in enumerate(steps, 1) if n >= reached and agrees(sample.message, step)), 0)
            if not at:
                says = f"feedback {_short(sample.message)}"
                if fit := next((s for s in steps if sizes(s) == sizes(sample.message)), None):
                    says += f", not {_short(fit)}"
                return wrong(says, "Look at what is in the feedback when it is sent.")
            different += at > reached
            reached = at
        if different < least:
            says = f"{counted(different, 'feedback message')}{' that differ' if different > 1 else ''}"
            return wrong(says, "Publish feedback after each step, not only once.")
        took_s = feedback[-1].source_time - feedback[0].source_time
        if took_s < self.over_s:
            says = f"all feedback within {took_s:.2f} s, not spread over at least {self.over_s:g} s"
            return wrong(says, "Publish feedback as soon as a step is done, and let time pass until the next one.")
        return passed(expected, f"{len(feedback)} messages in {took_s:.1f} s", trail)


def wrong_goal(
    action: Action, seen: Seen, answer: GoalAnswer | None, says: str, do: str, wanted: str, *, shared: str = ""
) -> Observation:
    """A goal that does not go as it should. `wanted`: how it should have ended, or "feedback".

    `shared`: which goal it is, if its result has what belongs to another one.
    """
    about: Mapping[str, Any] = {"action": action.name, "wanted": wanted, "answer": answer, "shared": shared}
    found = outcome_of(answer) if answer is not None else ""
    return seen.symptom(Symptom.WRONG_GOAL, says=says, do=do, found=found, **about)


def sizes(fields: Fields) -> Mapping[str, int]:
    """How long each list is."""
    return {name: len(value) for name, value in fields.items() if isinstance(value, list | tuple)}


def begins(value: Fields, whole: Fields) -> bool:
    """Whether each list of `whole` has begun in `value`, and is not complete; other fields must agree."""

    def has_begun(got: Any, wanted: Any) -> bool:
        if not isinstance(wanted, list | tuple):
            return agrees(got, wanted)
        return isinstance(got, list | tuple) and 0 < len(got) < len(wanted) and agrees(got, wanted[: len(got)])

    return all(name in value and has_begun(value[name], wanted) for name, wanted in whole.items())


def _short(fields: Fields) -> str:
    """Fields for use in a sentence: long lists are cut in the middle."""

    def cut(value: Any) -> str:
        if not isinstance(value, list | tuple) or len(value) <= 8:
            return repr(value)
        return f"[{', '.join(map(repr, value[:4]))}, … {value[-1]!r}]"

    return f"{{{', '.join(f'{name!r}: {cut(value)}' for name, value in fields.items())}}}"
