"""Forms: an action client sends a goal, shows how it goes, and ends by itself, also when the goal is rejected."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

from tutor.exercise.form import Exercise, Form
from tutor.exercise.goal_client_run import GoalClientRun, RunGoalClient
from tutor.exercise.nouns import Action, Program
from tutor.judge import tracebacks
from tutor.judge.check import Criterion
from tutor.judge.peers import GoalReplies
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import Level, Trace
from tutor.judge.verdict import Verdict, failed, passed
from tutor.judge.wording import output_tail

SHOWN_SHARE = 0.5
"""Of the feedback, at least this share must be shown: rclpy drops what the result has overtaken."""


def rejected() -> GoalReplies:
    """Our server rejects each goal."""
    return GoalReplies(accepts=False)


@dataclass(frozen=True)
class SendsGoal(Form):
    """A client, run without arguments, sends a goal to our action server, shows feedback and result, and exits with 0.

    Our server comes up about a second after it has started, so it has to wait for it. `replies`: returns what our
    server sends; draw it at random, so that the client cannot know it. `shows`: what must be shown of each message of
    feedback (half of them are enough: some may be overtaken by the result) and of the result, in the log or in the
    output: a number or a text that nothing else would show. `within_s`: how long the run may take, in seconds. Where
    the file is missing, the criterion fails, and the check goes on.

        SendsGoal("client", Program("client.py"), COUNT, replies, shows=lambda message: message["sequence"][-1])
    """

    client: Program
    action: Action
    replies: Callable[[], GoalReplies] = field(hash=False)
    shows: Callable[[Any], Any] = field(hash=False)
    within_s: float = 15.0

    def criterion(self, exercise: Exercise) -> Criterion:
        return self.judged(lambda seen: self.judge(seen, exercise), self.scenario)

    @property
    def scenario(self) -> RunGoalClient:
        """The run that is judged."""
        return RunGoalClient(self.client, self.action, self.replies, self.within_s)

    def judge(self, seen: GoalClientRun, exercise: Exercise) -> Verdict:
        """Judge a run of the client."""
        file, name = self.client.file, self.action.name
        expected = (
            f"{file}, run without arguments, waits for the action server of {name}, which comes up a little later, "
            f"sends a goal, shows feedback and result, and ends by itself with 0 within {self.within_s:g} s"
        )
        if seen.trace is None:
            absent = Symptom.CALLS_MISSING.seen(Trace(file), file=file, beside=exercise.started.file)
            return failed(expected, f"there is no {file}", absent)
        accepted = [goal for goal in seen.goals if goal.accepted]
        sent = [f"it sent {dict(goal.goal)}" for goal in seen.goals[:3]]
        evidence = (*sent, *output_tail(seen.trace, 6))
        if (ended := self.not_ended(seen)) is not None:
            return failed(expected, ended[0], ended[1], evidence)
        assert seen.exit is not None
        how = f"ended after {seen.exit.after_s:.1f} s with {seen.exit}"
        if not accepted:
            return failed(expected, f"{how}, and sent no goal", no_goal(seen, self.action), evidence)
        if seen.exit.code != 0:
            why = _seen(seen, Symptom.WRONG_EXIT_CODE, missing="")
            return failed(expected, f"{how}; it sent a goal", why, evidence)
        result = self.shows(seen.replies.result)
        if not accepted[0].ended or not is_shown(seen.trace, result):
            early = "" if accepted[0].ended else " before there was one"
            do = "Ask the goal handle for the result, wait until it is there, and log what is in it."
            says = f"the client ends{early or ' without having shown the result'}"
            why = _seen(seen, Symptom.NOT_TOLD, says=says, do=do, what="the result", missing="result")
            return failed(expected, f"{how}{early}; the result {result} is not shown", why, evidence)
        told = [self.shows(message) for message in seen.replies.feedback]
        shown = [value for value in told if is_shown(seen.trace, value)]
        if len(shown) < SHOWN_SHARE * len(told):
            says = f"of {len(told)} feedback messages, it shows {len(shown)}"
            do = "Give send_goal_async() a feedback_callback, and log there what each message says."
            why = _seen(seen, Symptom.NOT_TOLD, says=says, do=do, what="the feedback", missing="feedback")
            return failed(expected, f"{how}; {says}", why, evidence)
        return passed(expected, f"{how}; {len(shown)} feedback messages and the result shown", evidence)

    def not_ended(self, seen: GoalClientRun) -> tuple[str, Observation] | None:
        """What was observed of a client that still runs; None if it has ended."""
        if seen.exit is not None:
            return None
        state = f"still running after {self.within_s:g} s"
        if seen.watched_s < self.within_s:
            state = f"after {seen.watched_s:.1f} s it still runs, and nothing more comes from it"
        if not seen.goals:
            return f"{state}; it sent no goal", no_goal(seen, self.action)
        told = "has its result" if seen.goals[0].ended else "was rejected" if not seen.goals[0].accepted else "runs"
        do = "Let the program end when the result is there, and also when there is nothing to wait for."
        return f"{state}; its goal {told}", _seen(seen, Symptom.RUNS_ON, says="", do=do, missing="")


@dataclass(frozen=True)
class HandlesRejection(Form):
    """The client of another criterion says that its goal was rejected, and ends by itself, whatever the exit code.

    `of`: that criterion, which should be among those that this one is `after`. A message is what the client logs or
    prints now and not when its goal is accepted; a traceback does not count.

        HandlesRejection("client-rejected", client, after=client)
    """

    of: SendsGoal

    def criterion(self, exercise: Exercise) -> Criterion:
        scenario = replace(self.of.scenario, replies=rejected)
        return self.judged(self.judge, scenario, self.of.scenario)

    def judge(self, seen: GoalClientRun, accepted: GoalClientRun) -> Verdict:
        """Judge a run where our server rejects the goal, beside one where it accepts it."""
        file = self.of.client.file
        expected = f"{file} says that its goal was rejected, and ends by itself within {self.of.within_s:g} s"
        if seen.trace is None or accepted.trace is None:
            return failed(
                expected, f"there is no {file}", Symptom.CALLS_MISSING.seen(Trace(file), file=file, beside="")
            )
        evidence = output_tail(seen.trace, 6)
        if (ended := self.of.not_ended(seen)) is not None:
            return failed(expected, ended[0], ended[1], evidence)
        assert seen.exit is not None
        how = f"ended after {seen.exit.after_s:.1f} s with {seen.exit}"
        if not seen.goals:
            return failed(expected, f"{how}, and sent no goal", no_goal(seen, self.of.action), evidence)
        crashed = bool(tracebacks.find_tracebacks(seen.trace.output))
        if crashed or seen.exit.signal is not None:
            why = _seen(seen, Symptom.WRONG_EXIT_CODE, missing="", rejected=True)
            return failed(expected, f"{how} and a traceback" if crashed else how, why, evidence)
        new = said(seen.trace, seen.goals[0].at) - said(accepted.trace)
        if not new and not _warned(seen.trace, accepted.trace):
            says = "the client's goal is rejected, and it says nothing about that"
            do = "Look at whether the goal was accepted, before you ask for its result, and log an error if not."
            about = {"what": "that the goal was rejected", "rejected": True}
            why = _seen(seen, Symptom.NOT_TOLD, says=says, do=do, missing="", **about)
            return failed(expected, f"{how}, and nothing that it says is about that", why, evidence)
        return passed(expected, how, [*list(new)[:1], *evidence])


def is_shown(trace: Trace, value: Any) -> bool:
    """Whether the log or the output has a value; a number as a whole one, however it is padded or grouped."""
    pattern = re.compile(rf"(?<!\d)(?<!\d\.)0*{re.escape(str(value))}(?!\.?\d)")
    texts = [log.text for log in trace.logs] + [line.text for line in trace.output]
    texts += [re.sub(r"(?<=\d)[,_'](?=\d{3}(?!\d))", "", text) for text in texts]
    return any(pattern.search(text) for text in texts)


def said(trace: Trace, since: float = 0.0) -> set[str]:
    """What a program has said, without numbers and punctuation: lines that differ only in these are the same.

    `since`: from when on; what it prints may be held back in a buffer, and so count later.
    """
    lines = [log.text for log in trace.logs if log.stamp >= since]
    # On the console, a log message has a head with its level, time and logger.
    lines += [re.sub(r"^\[\w+\] \[[\d.]+\] \[[^\]]*\]: ", "", line.text) for line in trace.output if line.at >= since]
    return {shape for line in lines if (shape := "".join(filter(_says_something, line)))}


def _says_something(character: str) -> bool:
    """Whether a character is a letter, or a sign that stands for a word, such as a check mark."""
    return character.isalpha() or unicodedata.category(character) == "So"


def _warned(trace: Trace, ordinary: Trace) -> bool:
    """Whether there are more warnings than usual."""

    def warnings(seen: Trace) -> int:
        return sum(log.level >= Level.WARN for log in seen.logs)

    return warnings(trace) > warnings(ordinary)


def no_goal(seen: GoalClientRun, action: Action) -> Observation:
    """The client has sent no goal."""
    others = [client.name.removesuffix("/_action/send_goal") for client in seen.clients]
    says = f"it sends no goal to {action.name}"
    if others and action.name not in others:
        says = f"its action client is for {', '.join(others)}, not for {action.name}"
    do = "Wait for the action server, with a time limit of some seconds, and then send it a goal."
    if seen.exit is not None and action.name in others:
        says += f", and has ended {seen.exit.after_s:.1f} s after its start"
    return _seen(seen, Symptom.CALLS_MISSING, says=says, do=do, missing=action.name)


def _seen(seen: GoalClientRun, symptom: Symptom, **about: Any) -> Observation:
    assert seen.trace is not None
    trace = replace(seen.trace, graph=replace(seen.trace.graph, clients=seen.clients))
    return symptom.seen(trace, stuck=seen.stuck, goals=seen.goals, calls=len(seen.goals), **about)
