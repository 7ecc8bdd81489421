"""A form: a bad call of a service gets an answer and a message in the log, and harms no later call."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from tutor.exercise.error_words import SAYS_ERROR
from tutor.exercise.form import Exercise, Form
from tutor.exercise.nouns import Program, Service
from tutor.exercise.serves import ended_by_a_call, wrong_answer
from tutor.exercise.service_calls import Question, Server, describe_request, make_calls, right_result
from tutor.judge.bench import Bench
from tutor.judge.check import Criterion
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import CallAnswer, Level, LogRecord, OutputLine, Trace
from tutor.judge.verdict import Verdict, failed, passed
from tutor.judge.waiting_for_nodes import IDLE_S, wait_until_log_quiet, wait_until_seen
from tutor.judge.wording import describe_no_answer, output_tail, shape

GOOD_CALLS = 3
"""How often to make the good call before the bad one.

Whether the answer of a server gets out that ends in the callback is a race; a MultiThreadedExecutor raises an exception
only when it is woken up by the next call, and may answer that one.
"""

LOG_DELAY_S = 2.0
"""Longest delay between the answer to a call and the log messages about it."""

LOG_QUIET_S = 0.3
"""Silence after which a node counts as done logging about a call: longer than between two of its messages."""

MAX_LOG_WAIT_S = 2.0
"""Longest wait for that silence, for a node that never stops logging."""

DELAYED_EXIT_S = 0.5
"""Time within which a node that does not survive a bad call exits."""

Fields = tuple[Any, ...]
"""The values of a request's fields, in their order."""


@dataclass(frozen=True)
class CallsAroundBad:
    """A good call, the same again, a bad one, and the calls after it.

    `again`: those after the first good one; a server that this has ended does not answer all of them. `ordinary`: what
    was logged before the bad call, `logged`: what was logged from then on. `at_end`: if that reports no error, the
    output during shutdown.
    """

    trace: Trace
    before: CallAnswer | None = None
    again: tuple[CallAnswer, ...] = ()
    bad: CallAnswer | None = None
    after: tuple[CallAnswer, ...] = ()
    ordinary: tuple[LogRecord, ...] = ()
    logged: tuple[LogRecord, ...] = ()
    at_end: tuple[OutputLine, ...] = ()


def find_complaints(
    ordinary: Sequence[LogRecord], logged: Sequence[LogRecord], says: re.Pattern[str] = SAYS_ERROR
) -> list[LogRecord]:
    """Find the messages that report a problem, leaving out those that a good call logs as well."""
    usual = {(log.level, shape(log.text)) for log in ordinary}
    return [
        log
        for log in logged
        if (log.level, shape(log.text)) not in usual and (log.level >= Level.WARN or says.search(log.text))
    ]


@dataclass(frozen=True)
class CallBadly:
    """Make a bad call, watch what the node logs, and go on calling."""

    program: Program
    service: Service
    good: Fields
    bad: Fields
    then: tuple[Fields, ...]
    says: re.Pattern[str]

    async def __call__(self, bench: Bench) -> CallsAroundBad:
        server, service = Server(self.program, (self.service,)), self.service

        def questions(*requests: Fields) -> list[Question]:
            return [(service, given) for given in requests]

        async with bench.start(self.program.file) as run:
            bench.report_progress(0.1, f"waiting for {service.name}")
            if not await wait_until_seen(run, lambda: not server.missing(run.graph.servers)):
                return CallsAroundBad(run.trace())
            before, *again = await make_calls(run, questions(self.good) * GOOD_CALLS)
            if any(answer.response is None for answer in (before, *again)):
                return CallsAroundBad(run.trace(), before, tuple(again))
            await wait_until_log_quiet(run, quiet_s=LOG_QUIET_S, max_s=MAX_LOG_WAIT_S)
            bench.report_progress(0.4, f"calling {service.name} with {self.bad}")
            since = run.now()  # messages about the good calls may still be on their way to us

            def find_logs() -> tuple[tuple[LogRecord, ...], tuple[LogRecord, ...]]:
                earlier = tuple(log for log in run.logs if log.stamp < since)
                return earlier, tuple(log for log in run.logs if log.stamp >= since)

            def complaints() -> list[LogRecord]:
                return find_complaints(*find_logs(), self.says)

            (bad,) = await make_calls(run, questions(self.bad))
            await run.until(lambda: bool(complaints()), LOG_DELAY_S, idle_s=IDLE_S)
            ordinary, logged = find_logs()
            await run.until(lambda: run.exit is not None, DELAYED_EXIT_S)
            bench.report_progress(0.8, f"calling {service.name} again")
            after = await make_calls(run, questions(*self.then))
            trace = run.trace()
            ended = await run.interrupt() if not find_complaints(ordinary, logged, self.says) else None
            at_end = ended.output if ended else ()
            return CallsAroundBad(trace, before, tuple(again), bad, after, ordinary, logged, at_end)


@dataclass(frozen=True)
class SurvivesBadCall(Form):
    """A bad call gets an answer, the node says in its log that it is an error, and the next calls are answered too.

    `good`, `bad`: the values of the request's fields in a good and in the bad call. `then`: the calls after it, where
    any answer is right for which the service `computes` None. `what`: what the bad call is, in words. `says`: matches
    the messages that report an error; those at WARN or above need no certain words.
    """

    service: Service
    good: Fields
    bad: Fields
    then: tuple[Fields, ...]
    what: str = "a bad call"
    says: re.Pattern[str] = SAYS_ERROR

    def criterion(self, exercise: Exercise) -> Criterion:
        scenario = CallBadly(exercise.program, self.service, self.good, self.bad, self.then, self.says)
        return self.judged(lambda seen: self.judge(seen, lambda: ended_by_a_call(exercise)), scenario)

    def judge(self, seen: CallsAroundBad, told_elsewhere: Callable[[], Verdict]) -> Verdict:
        """Judge the calls. `told_elsewhere`: the verdict on a server that a good call has ended."""
        name, bad, trace = self.service.name, self._shown(self.bad), seen.trace
        expected = f"{self.what} gets an answer, the node reports it as an error, and the next calls succeed"
        if seen.bad is None and seen.before is not None and trace.exit is not None:
            return told_elsewhere()
        tail = output_tail(trace)
        if seen.before is None or seen.bad is None:
            why = self._no_answer(trace, f"{name} does not answer", f"Let the callback of {name} return its response.")
            return failed(expected, f"{name} does not answer even {self._shown(self.good)}", why, tail)
        if seen.bad.response is None:
            says, do = f"{name} does not answer {bad}", "Return the response in that case too, and go on."
            observed = f"{bad}: {describe_no_answer(trace, seen.bad.took_s)}"
            return failed(expected, observed, self._no_answer(trace, says, do), tail)
        complaints = find_complaints(seen.ordinary, seen.logged, self.says)
        is_right = self._is_right(seen.before)
        # The last log messages of a node that exits may never reach us: in that case, report the exit instead.
        has_exited = trace.exit is not None and any(answer.response is None for answer in seen.after)
        answered = f"answered {seen.bad.response[self.service.response]}"
        if not complaints and not has_exited:
            observed = f"{answered}, without a word about an error"
            return failed(expected, observed, self._silent(seen, is_right), [str(log) for log in seen.logged])
        for answer in seen.after:
            asked = describe_request(self.service, answer.request)
            if answer.response is None:
                says, do = f"the node no longer answers after {self.what}", "Only log and answer there, and go on."
                return failed(expected, f"after it, {asked} got no answer", self._no_answer(trace, says, do), tail)
            if is_right and not self._is_right(answer):
                observed = f"after it, {asked} was answered {answer.response[self.service.response]}"
                return failed(expected, observed, self._wrong_since(seen, answer))
        return passed(expected, f"{answered}, and {len(seen.after)} calls after it", [str(complaints[0])])

    def _shown(self, given: Fields) -> str:
        return describe_request(self.service, dict(zip(self.service.request, given, strict=True)))

    def _is_right(self, answer: CallAnswer) -> bool:
        right = right_result(self.service, answer.request)
        return right is None or (answer.response is not None and answer.response[self.service.response] == right)

    def _no_answer(self, trace: Trace, says: str, do: str) -> Observation:
        return Symptom.NO_ANSWER.seen(trace, service=self.service.name, type=self.service.type, says=says, do=do)

    def _silent(self, seen: CallsAroundBad, is_right: bool) -> Observation:
        """Nothing that the node logs reports an error."""
        assert seen.before is not None
        assert seen.before.response is not None
        name = self.service.name
        says, do = "nothing that the node logs reports an error", f"Log an error for {self.what}, before you answer."
        if not is_right:
            got = seen.before.response[self.service.response]
            says = f"no error is reported, and {self._shown(self.good)} is answered {got}"
            do = f"Let {name} answer a good call first, then look at what it does with a bad one."
        return Symptom.NOT_LOGGED.seen(
            seen.trace,
            what="the error",
            recognise=self.says.search,
            at_end=seen.at_end,
            ordinary=seen.ordinary,
            logged=seen.logged,
            says=says,
            do=do,
        )

    def _wrong_since(self, seen: CallsAroundBad, answer: CallAnswer) -> Observation:
        assert seen.before is not None
        return wrong_answer(
            (self.service,),
            seen.trace,
            self.service,
            answer,
            (seen.before, *seen.after),
            says=f"the node answers right until {self.what}",
            do=f"Let {self.what} change nothing in the node: only log and answer.",
        )
