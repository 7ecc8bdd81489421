"""The learner's running node, as a criterion that is a function sees it: it asks, and what is missing fails it."""

from __future__ import annotations

import re
from collections.abc import Mapping
from contextlib import AsyncExitStack
from types import SimpleNamespace
from typing import Any, NoReturn

from tutor.exercise.bad_values import BadValues
from tutor.exercise.defaults import DeclaringRun, Defaults
from tutor.exercise.goal_run import action_missing, pursue, unanswered, wait_for_server
from tutor.exercise.node_parameters import ANSWER_S, DumpSilentNode, find_parameter
from tutor.exercise.nouns import Action, Parameter, Program, Service, Topic, Value, agrees, show
from tutor.exercise.receives import wait_for_subscription
from tutor.exercise.rejects import Rejects
from tutor.exercise.seen_run import SPIN_S, look
from tutor.exercise.serves import service_missing
from tutor.exercise.watched_start import text_in
from tutor.judge.bench import Bench, Run
from tutor.judge.peers import Publisher
from tutor.judge.rates import TOLERANCE, describe
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import Sample, SetAnswer
from tutor.judge.verdict import Verdict, failed
from tutor.judge.waiting_for_nodes import (
    IDLE_S,
    MESSAGE_GAP_S,
    RESENT_S,
    START_S,
    measure_steady_rate,
    patience_s,
    wait_for_message,
    wait_until_seen,
)
from tutor.judge.wording import describe_no_answer, output_tail
from tutor.ros_model import Parameter as Reported

GOAL_S = 10.0
"""How long a goal may take."""

SHOW_S = 3.0
"""How long a node may take to log what it has received."""

MAX_EVIDENCE = 6


class Unmet(Exception):
    """The criterion is not met; `verdict` says what was seen instead."""

    def __init__(self, verdict: Verdict) -> None:
        super().__init__(verdict.observed)
        self.verdict = verdict


class Fields(SimpleNamespace):
    """The fields of a response or a message, by name; nested messages have fields, too.

    `at`: when the response came, or the message was sent, in seconds since the epoch; `took_s`: of a response, the
    seconds from the request on.
    """

    def __init__(self, values: Mapping[str, Any], *, at: float, took_s: float = 0.0) -> None:
        nested = {name: Fields(v, at=at) if isinstance(v, Mapping) else v for name, v in values.items()}
        super().__init__(**{"at": at, "took_s": took_s, **nested})


class Node:
    """The learner's running node. Each method waits for evidence, and fails the criterion with a symptom if none comes.

    `seen`: what was asked and answered so far, a line each.
    """

    def __init__(
        self, bench: Bench, run: Run, program: Program, expected: str, watch: tuple[Topic, ...], ours: AsyncExitStack
    ) -> None:
        """`ours`: closes our endpoints."""
        self._bench, self._run, self._program, self._expected, self._watch = bench, run, program, expected, watch
        self._ours = ours
        self._publishers: dict[Topic, Publisher] = {}
        self._last: Service | Topic | Action | None = None
        self.seen: list[str] = []

    def expect(self, actual: object, wanted: object, do: str, says: str = "") -> None:
        """Fail unless what was answered or published last is as wanted.

        `do`: the next step, in one sentence; `says`: what is wrong, if the two values do not say it.
        """
        if agrees(actual, wanted):
            return
        symptom = Symptom.WRONG_VALUES
        about: dict[str, Any] = {}
        if isinstance(self._last, Service):
            symptom, about = Symptom.WRONG_ANSWER, {"service": self._last.name, "type": self._last.type}
        elif isinstance(self._last, Action):
            symptom, about = Symptom.WRONG_GOAL, {"action": self._last.name}
        elif self._last is not None:
            about = {"topic": self._last.name, "type": self._last.type}
        says = says or f"it is {show(actual)}, not {show(wanted)}"
        observed = self.seen[-1] if self.seen else f"{show(actual)}, not {show(wanted)}"
        self._fail(observed, symptom.seen(self._run.trace(), says=says, do=do, **about))

    async def call(self, service: Service, **request: Any) -> Fields:
        """Call a service as `ros2 service call` does, and return its response."""
        run, name, self._last = self._run, service.name, service
        asked = " ".join([name, *(f"{field}={show(value)}" for field, value in request.items())])
        self._bench.report_progress(0.5, f"calling {asked}")

        def is_there() -> bool:
            return any(server.name == name and server.type == service.type for server in run.graph.servers)

        def limit_s() -> float:
            return patience_s(((server.name, server.type) for server in run.graph.servers), name, service.type)

        if not await wait_until_seen(run, is_there, settle_s=limit_s):
            self._fail(f"{name} is not there", service_missing((service,), run.trace(), (service,)))
        answer = await run.call(name, service.type, request, limit_s=ANSWER_S)
        if answer.response is None:
            says, do = f"{name} does not answer", f"Let the callback of {name} return its response."
            await self._fail_unanswered(asked, answer.took_s, service=name, type=service.type, says=says, do=do)
        self.seen.append(f"{asked}: {dict(answer.response)}")
        return Fields(answer.response, at=answer.answered_at, took_s=answer.took_s)

    async def publish(self, topic: Topic, **fields: Any) -> Fields:
        """Publish a message on the node's topic, once a subscription of it is there, and return the message.

        `fields`: the message's fields; a nested message is a dict.
        """
        if topic not in self._publishers:
            publisher = await self._ours.enter_async_context(self._run.publisher(topic.name, topic.type))
            if not await wait_for_subscription(self._run, topic, publisher):
                seen = await look(self._run, does_nothing=True)
                about = {"topic": topic.name, "type": topic.type, "ours": publisher.endpoint}
                self._fail(f"no subscription on {topic.name}", seen.symptom(Symptom.NOTHING_RECEIVED, **about))
            self._publishers[topic] = publisher
        sent = self._publishers[topic].publish(fields)
        self.seen.append(f"{topic.name} got {fields}")
        return Fields(sent.message, at=sent.source_time)

    async def logs(self, text: str | re.Pattern[str], after: Fields | None = None, within_s: float = SHOW_S) -> str:
        """Fail unless the node logs a text, or a pattern, after a response or a message; return the log message."""
        run, since = self._run, after.at if after is not None else 0.0

        def found() -> str:
            return next((str(log) for log in run.logs if log.stamp >= since and text_in(log.text, text)), "")

        if not await wait_until_seen(run, lambda: bool(found()), promised=lambda: True, message_gap_s=within_s):
            seen = await look(run, does_nothing=not run.logs)
            self._fail(f"{text!r} is not logged", seen.symptom(Symptom.NOT_LOGGED, what=f"{text!r}"))
        self.seen.append(found())
        return found()

    async def send_goal(self, action: Action, *, cancel_after: int | None = None, **goal: Any) -> Fields:
        """Send a goal to an action server, and return how it ended.

        The `outcome` is "succeeded", "aborted", "canceled" or "rejected"; there is also the `result`, and `feedback`,
        the list of its messages. `cancel_after`: ask to cancel the goal after so many of them.
        """
        run, self._last = self._run, action
        self._bench.report_progress(0.5, f"sending a goal to {action.name}")
        async with run.goal_client(action.name, action.type) as client:
            if not await wait_for_server(run, action, client):
                seen = await look(run, does_nothing=True)
                self._fail(f"{action.name} has no action server", action_missing(action, seen))
            await pursue(run, client, goal, cancel_after, GOAL_S)
            answer = client.seen
        outcome = "rejected" if answer.accepted is False else answer.outcome
        if not outcome:
            seen = await look(run, does_nothing=not answer.accepted)
            self._fail(*unanswered(action, seen, answer, GOAL_S))
        self.seen.append(f"{action.name} {goal}: {outcome}, {dict(answer.result or {})}")
        now, feedback = run.now(), [Fields(sample.message, at=sample.source_time) for sample in answer.feedback]
        return Fields({"outcome": outcome, "result": answer.result or {}, "feedback": feedback}, at=now)

    async def next(self, topic: Topic, after: Fields, *, skip: int = 1) -> Fields:
        """Return a message that was published after a response or another message.

        By default, not the very next one, which may have been on its way: `skip` says how many to pass over, if more
        come. The topic must be in the criterion's `watch`.
        """
        run, self._last = self._run, self._watched(topic)
        self._bench.report_progress(0.5, f"waiting for the next message on {topic.name}")

        def later() -> list[Sample]:
            return [sample for sample in run.samples_on(topic.name) if sample.source_time > after.at]

        await run.until(lambda: len(later()) > skip, MESSAGE_GAP_S, idle_s=IDLE_S)
        if not later():
            await self._fail_silent(topic, some=bool(run.samples_on(topic.name)))
        return self._taken(topic, later()[: skip + 1][-1])

    async def first(self, topic: Topic) -> Fields:
        """Return the first message on a topic, which must be in the criterion's `watch`."""
        self._last = self._watched(topic)
        self._bench.report_progress(0.1, f"waiting for a message on {topic.name}")
        if not await wait_for_message(self._run, topic.name, topic.type):
            await self._fail_silent(topic, some=False)
        return self._taken(topic, self._run.samples_on(topic.name)[0])

    async def rate(self, topic: Topic, hz: float) -> Fields:
        """Fail unless the topic has this rate, within the tolerance; return its first message."""
        run, first = self._run, await self.first(topic)
        self._bench.report_progress(0.3, f"measuring the rate of {topic.name}")
        rate, messages = await measure_steady_rate(run, topic.name, hz, since=first.at)
        self.seen.append(f"{topic.name} at {describe(rate, messages)}")
        if rate is None or not rate.agrees_with(hz):
            wrong = Symptom.WRONG_RATE.seen(
                run.trace(),
                topic=topic.name,
                type=topic.type,
                wanted_hz=hz,
                rate=rate,
                inverted=rate is None or rate.agrees_with(1 / hz),
            )
            self._fail(f"{self.seen[-1]}, not {hz:g} Hz ±{TOLERANCE:.0%}", wrong)
        return first

    async def parameter(self, parameter: Parameter) -> Reported:
        """Fail unless the node declares this parameter, with its type and default; return what it reports."""
        self._require(Defaults("", (parameter,)).judge(await self._declared()))
        return await self._read(parameter)

    async def set(self, parameter: Parameter, value: Value) -> SetAnswer:
        """Set a parameter as `ros2 param set` does; fail unless the node accepts it."""
        answer = await self._set(parameter, value)
        if not answer.successful:
            refused = Symptom.REFUSED.seen(self._run.trace(), parameter=parameter.name, value=value, answer=answer)
            self._fail(f'{parameter.name} set to {show(value)}: rejected, "{answer.reason}"', refused)
        return answer

    async def rejects(self, parameter: Parameter, *bad: Value) -> None:
        """Fail unless the node rejects these values with a reason, and its value stays."""
        form = Rejects("", parameter, bad)
        for value in bad:
            before = (await self._read(parameter)).value
            answer = await self._set(parameter, value)
            after = (await self._read(parameter)).value
            seen = BadValues(self._run.trace(), before=before, rejected=((answer, after),))
            if not (verdict := form.judge_so_far(seen)).passed:
                raise Unmet(verdict)

    async def _set(self, parameter: Parameter, value: Value) -> SetAnswer:
        name = parameter.name
        self._bench.report_progress(0.5, f"setting {name} to {show(value)}")
        reported = await self._read(parameter)
        answer = await self._run.set_parameters(reported.node, {name: value}, limit_s=ANSWER_S)
        if not answer.answered:
            await self._fail_unanswered(f"setting {name} to {show(value)}", answer.took_s, parameter=name)
        self.seen.append(f"{name} set to {show(value)}: {'accepted' if answer.successful else answer.reason}")
        return answer

    async def _read(self, parameter: Parameter) -> Reported:
        declared = await self._declared()
        found = find_parameter(declared.parameters or (), parameter)
        if found is None:
            self._require(Defaults("", (parameter,)).judge(declared))
        assert found is not None
        return found

    async def _declared(self) -> DeclaringRun:
        run = self._run
        await run.until(lambda: bool(run.graph.parameter_nodes), START_S, idle_s=RESENT_S)
        declared = await run.parameters(ANSWER_S) if run.graph.parameter_nodes else None
        trace = run.trace()
        silent = declared is None and trace.exit is None and bool(trace.graph.nodes)
        stuck = await self._bench.facts(DumpSilentNode(self._program)) if silent else ()
        return DeclaringRun(trace, declared, None, stuck)

    async def _fail_unanswered(self, asked: str, took_s: float, **about: Any) -> NoReturn:
        """Fail since a request got no answer; find out whether the node answers any, and where it is now."""
        run = self._run
        answers = bool(self.seen) or await run.parameters(SPIN_S) is not None
        trace = run.trace()
        stuck = await run.dump_stacks() if trace.exit is None else ()
        silent = Symptom.NO_ANSWER.seen(trace, stuck=stuck, answers=answers, **about)
        self._fail(f"{asked}: {describe_no_answer(trace, took_s, ANSWER_S)}", silent)

    def _watched(self, topic: Topic) -> Topic:
        if topic not in self._watch:
            raise ValueError(f"the criterion does not watch {topic.name}: add the topic to its `watch`")
        return topic

    def _taken(self, topic: Topic, sample: Sample) -> Fields:
        self.seen.append(f"{topic.name}: {dict(sample.message)}")
        return Fields(sample.message, at=sample.source_time)

    async def _fail_silent(self, topic: Topic, *, some: bool) -> NoReturn:
        seen = await look(self._run, does_nothing=not some)
        silent = seen.symptom(Symptom.NO_MESSAGES, topic=topic.name, type=topic.type, some=some)
        self._fail(f"{'no more messages' if some else 'no message'} on {topic.name}", silent)

    def _require(self, verdict: Verdict) -> None:
        if not verdict.passed:
            raise Unmet(verdict)
        self.seen.append(verdict.observed)

    def _fail(self, observed: str, why: Observation) -> NoReturn:
        evidence = (*self.seen, *output_tail(self._run.trace()))[-MAX_EVIDENCE:]
        raise Unmet(failed(self._expected, observed, why, evidence))
