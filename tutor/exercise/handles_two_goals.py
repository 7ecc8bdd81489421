"""A form: what an action server does with a second goal while the first one runs."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial

from tutor.exercise.form import Exercise, Form
from tutor.exercise.goal_run import (
    CANCELED_S,
    Fields,
    Goal,
    OfGoal,
    Outcome,
    action_missing,
    describe_goal,
    drawn,
    has_more,
    is_over,
    of_goal,
    outcome_of,
    send,
    wait_for_server,
)
from tutor.exercise.nouns import Action, Program, agrees
from tutor.exercise.seen_run import Seen, look
from tutor.judge.bench import Bench
from tutor.judge.check import Criterion
from tutor.judge.symptom import Symptom
from tutor.judge.trace import GoalAnswer
from tutor.judge.verdict import Verdict, failed, passed
from tutor.judge.waiting_for_nodes import RESENT_S
from tutor.judge.wording import output_tail

ALONE_S = 0.6
"""How long the first goal runs before the second one comes."""

_STEPS = {
    "aborted": "Let the goal that runs see that there is a newer one; then call abort() on its handle, and return.",
    "succeeded": "Let each goal go its own way to the end: keep what belongs to one goal in local variables.",
    "rejected": "Let the goal_callback look at whether a goal is running, and return GoalResponse.REJECT.",
    "canceled": "Let the goal that runs find out that it is to be canceled; then call canceled() on its handle.",
}


@dataclass(frozen=True)
class TwoGoals(Seen):
    """What became of two goals. `of_goals`: of the first and the second; empty if there was no action server."""

    of_goals: tuple[GoalAnswer, ...] = ()
    goals: tuple[Fields, ...] = ()


@dataclass(frozen=True)
class SendTwoGoals:
    """Start without parameters, send a goal, and a second one while the first runs.

    `within_s`: how long the first may take once the second is answered, and the second after that, in seconds.
    """

    program: Program
    action: Action
    goals: tuple[Goal, Goal] = field(hash=False)
    within_s: tuple[float, float]

    async def __call__(self, bench: Bench) -> TwoGoals:
        action, (first, second) = self.action, map(drawn, self.goals)
        async with (
            bench.start(self.program.file, expected_s=3.0) as run,
            run.goal_client(action.name, action.type) as one,
            run.goal_client(action.name, action.type) as other,
        ):
            bench.report_progress(0.1, f"waiting for the action server of {action.name}")
            if not (await wait_for_server(run, action, one) and await wait_for_server(run, action, other)):
                return (await look(run, does_nothing=True)).having(TwoGoals)
            bench.report_progress(0.3, f"sending two goals to {action.name}, one after the other")
            if await send(run, one, first):
                await run.until(lambda: is_over(one), ALONE_S)
                await send(run, other, second)
                if other.seen.accepted is not None:
                    for client, limit_s in zip((one, other), self.within_s, strict=True):
                        if not await run.until(partial(is_over, client), limit_s, idle_s=RESENT_S):
                            break
            answers = (one.seen, other.seen)
            unheard = any(answer.accepted is None for answer in answers)
            return (await look(run, does_nothing=unheard)).having(TwoGoals, of_goals=answers, goals=(first, second))


@dataclass(frozen=True)
class HandlesTwoGoals(Form):
    """A second goal comes while the first one runs, and both end as they should.

    `goals`: the first one, which takes long, and the second one; each with its fields and their values, or a function
    that draws them at random. `ends`: how each must end; ("aborted", "succeeded") is a server where a new goal replaces
    the one that runs, ("succeeded", "succeeded") one that serves both, ("succeeded", "rejected") one that is busy.
    `result`: of each goal that must succeed, those of its fields that matter, or a function that makes them from the
    goal. `within_s`: how long each may take, in seconds: the first from the second one on, and the second from
    the end of the first on. A first goal that must be aborted or canceled has 3 s at most.

        HandlesTwoGoals("newer", COUNT, ({"order": 50}, {"order": 3}), ("aborted", "succeeded"))
    """

    action: Action
    goals: tuple[Goal, Goal] = field(hash=False)
    ends: tuple[Outcome, Outcome] = ("aborted", "succeeded")
    result: OfGoal | None = field(default=None, hash=False)
    within_s: float = 6.0

    def criterion(self, exercise: Exercise) -> Criterion:
        return self.judged(self.judge, SendTwoGoals(exercise.program, self.action, self.goals, self.limits_s))

    @property
    def limits_s(self) -> tuple[float, float]:
        """How long the first goal and the second one may take, in seconds."""
        soon = self.ends[0] in ("aborted", "canceled")
        return min(CANCELED_S, self.within_s) if soon else self.within_s, self.within_s

    def judge(self, found: TwoGoals) -> Verdict:
        """Judge what became of both goals."""
        action, goals = self.action, found.goals or tuple(map(drawn, self.goals))
        first, second = (describe_goal(action, goal) for goal in goals)
        expected = f"{first} runs, and then comes {second}: the first is {self.ends[0]}, the second {self.ends[1]}"
        tail = output_tail(found.trace)
        if not found.of_goals:
            return failed(expected, f"{action.name} has no action server", action_missing(action, found), tail)
        answered = found.of_goals[1].accepted is not None
        waited = [f" after {limit_s:g} s" if answered else "" for limit_s in self.limits_s]
        if not outcome_of(found.of_goals[0]):
            waited[1] = ""  # It was not waited for.
        ended = [_describe(answer, after) for answer, after in zip(found.of_goals, waited, strict=True)]
        observed = f"the first {ended[0]}, the second {ended[1]}"
        # Of a goal that is not taken in, or waits for its turn, the other one is the reason.
        unheard = found.of_goals[0].accepted and found.of_goals[1].accepted is None
        for which in (1, 0) if unheard else (0, 1):
            name, answer, wanted = ("first", "second")[which], found.of_goals[which], self.ends[which]
            says, do, shared = f"the {name} goal {ended[which]}, instead of being {wanted}", _STEPS[wanted], False
            if which == 1 and wanted == "succeeded" and self.ends[0] != "succeeded":
                do = "Let only the goal before see that there is a newer one: this one goes on to its end."
            if outcome_of(answer) == wanted:
                result = None if self.result is None else of_goal(self.result, goals[which])
                if wanted != "succeeded" or result is None or agrees(answer.result or {}, result):
                    continue
                says = f"the {name} goal ends with {dict(answer.result or {})}, not {dict(result)}"
                do = "Keep what belongs to one goal in local variables of its callback, since two may be in it at once."
                shared = has_more(answer.result or {}, result)
            elif which == 1 and answer.accepted is None:
                says, do = "the second goal gets no answer while the first one runs", _LET_IN
            about = {"action": action.name, "wanted": wanted, "found": outcome_of(answer), "answer": answer}
            why = found.symptom(Symptom.WRONG_GOAL, says=says, do=do, shared=shared, **about)
            return failed(expected, observed, why, tail)
        return passed(expected, observed)


def _describe(answer: GoalAnswer, waited: str) -> str:
    if answer.accepted is None:
        return "gets no answer"
    return f"is {outcome}" if (outcome := outcome_of(answer)) else f"still runs{waited}"


_LET_IN = "Let the node take in requests while a goal runs: see what runs its execute callback meanwhile."
