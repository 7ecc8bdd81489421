"""Forms about the learner's services: they are there and answer a call, and the answers are right."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from tutor.exercise.form import Exercise, Form
from tutor.exercise.nouns import Service
from tutor.exercise.service_calls import (
    CallEach,
    MakeCalls,
    Question,
    Server,
    ServiceCalls,
    describe_answers,
    describe_request,
    right_result,
)
from tutor.judge.check import Criterion
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import CallAnswer, Trace
from tutor.judge.verdict import Status, Verdict, failed, passed, skipped
from tutor.judge.wording import describe_no_answer, output_tail


def names_of(services: Sequence[Service]) -> str:
    """The names of services, for use in a sentence."""
    *most, last = (service.name for service in services)
    return f"{', '.join(most)} and {last}" if most else last


def ended_by_a_call(exercise: Exercise) -> Verdict:
    """Skip a criterion since a call has ended the server; the criterion that makes most calls shows why."""
    answers = exercise.first(Answers)
    shows = f": `{answers.id}` shows why" if answers is not None else ""
    return skipped(f"not judged, because a call has ended the server{shows}")


@dataclass(frozen=True)
class Serves(Form):
    """Services with these names and types are there, and answer a call as `ros2 service call` makes it.

    `call_with`: the values of the request's fields, easy ones that suit all of them. A server that a call ends is
    reported by the criterion `Answers`, if the exercise has one.
    """

    services: tuple[Service, ...]
    call_with: tuple[Any, ...]

    def criterion(self, exercise: Exercise) -> Criterion:
        return self.judged(lambda seen: self.judge(seen, exercise), self.ended_start(exercise))

    def ended_start(self, exercise: Exercise) -> CallEach:
        return CallEach(Server(exercise.program, self.services), self.call_with)

    def judge(self, seen: ServiceCalls, exercise: Exercise) -> Verdict:
        """Judge one call of each service."""
        types = ", ".join(dict.fromkeys(service.type for service in self.services))
        expected = f"{names_of(self.services)} with type {types}, answering a call"
        unanswered = next((answer for answer in seen.answers if answer.response is None), None)
        missing = Server(exercise.program, self.services).missing(seen.trace.graph.servers)
        if missing := missing or ([] if unanswered else never_called(self.services, seen)):
            observed = f"missing: {', '.join(service.name for service in missing)}"
            return failed(
                expected, observed, service_missing(self.services, seen.trace, missing), output_tail(seen.trace)
            )
        if seen.ended_by_a_call:
            return ended_by_a_call(exercise)
        if unanswered is not None:
            name = unanswered.service
            observed = f"{name}: {_silence(seen, unanswered)}"
            says = f"{name} is there, and does not answer a call"
            do = f"Find where the callback of {name} stays, or another one that keeps it from being called."
            silent = _silent(seen, next(service for service in self.services if service.name == name), says, do)
            return failed(expected, observed, silent, output_tail(seen.trace))
        return passed(expected, "all answer", describe_answers(self.services, seen.answers))


def never_called(services: Sequence[Service], seen: ServiceCalls) -> list[Service]:
    """The services that were not up yet when it was their turn, though they may be in the graph by now."""
    return [service for service in services if not seen.of(service.name)]


def service_missing(services: Sequence[Service], trace: Trace, missing: Sequence[Service]) -> Observation:
    """Some of the services are not there."""
    return Symptom.SERVICE_MISSING.seen(
        trace,
        service=missing[0].name,
        type=missing[0].type,
        services=tuple(service.name for service in services),
        says=f"{', '.join(service.name for service in missing)} {'is' if len(missing) == 1 else 'are'} not there",
        do="Create each service where the node is set up, under its own name and with its own callback.",
    )


@dataclass(frozen=True)
class Answers(Form):
    """The answers are right: what each service `computes`.

    `questions`: returns the calls to make, in their order, each a service and the values of its request's fields; draw
    them at random, so that no answer can be written down.
    """

    services: tuple[Service, ...]
    questions: Callable[[], Sequence[Question]]

    def criterion(self, exercise: Exercise) -> Criterion:
        serves = exercise.first(Serves)

        def judge(seen: ServiceCalls, simple: ServiceCalls | None) -> Verdict:
            if serves and simple and serves.judge(simple, exercise).status is Status.FAILED:
                return skipped(f"not judged, because `{serves.id}` did not pass")
            return self.judge(seen)

        scenario = MakeCalls(Server(exercise.program, self.services), self.questions)
        return self.judged(judge, scenario, exercise.scenario_of(serves))

    def judge(self, seen: ServiceCalls) -> Verdict:
        """Judge all calls."""
        by_name = {service.name: service for service in self.services}
        for answer in seen.answers:
            service = by_name[answer.service]
            right = right_result(service, answer.request)
            asked = f"{answer.service}: {describe_request(service, answer.request)} = {right}"
            if answer.response is None:
                return failed(asked, _silence(seen, answer), _no_answer(seen, answer, service), output_tail(seen.trace))
            if right is not None and (got := answer.response[service.response]) != right:
                evidence = describe_answers(self.services, seen.of(answer.service), "answered")
                return failed(asked, f"{got}", self._wrong_result(seen, answer, service, right), evidence)
        expected = "right results"
        if late := never_called(self.services, seen):
            observed = f"missing: {', '.join(service.name for service in late)}"
            return failed(expected, observed, service_missing(self.services, seen.trace, late))
        return passed(expected, f"{len(seen.answers)} calls", describe_answers(self.services, seen.answers)[:8])

    def _wrong_result(self, seen: ServiceCalls, answer: CallAnswer, service: Service, right: Any) -> Observation:
        assert answer.response is not None
        got, name = answer.response[service.response], service.name
        request = " and ".join(str(answer.request[field]) for field in service.request)
        return wrong_answer(
            self.services,
            seen.trace,
            service,
            answer,
            seen.answers,
            says=f"to {request}, {name} answers {got} instead of {right}",
            do=f"Follow {request} through the callback of {name} to where they become {got}.",
        )


def wrong_answer(
    services: Sequence[Service],
    trace: Trace,
    service: Service,
    answer: CallAnswer,
    calls: Sequence[CallAnswer],
    *,
    says: str,
    do: str,
) -> Observation:
    """A wrong answer; `services`: whose results it may be instead."""
    return Symptom.WRONG_ANSWER.seen(
        trace,
        service=service.name,
        type=service.type,
        answer=answer,
        wanted=right_result(service, answer.request),
        calls=tuple(calls),
        field=service.response,
        operations={service.name: service.computes for service in services if service.computes is not None},
        says=says,
        do=do,
    )


def _no_answer(seen: ServiceCalls, answer: CallAnswer, service: Service) -> Observation:
    name = answer.service
    says = f"{name} answers other calls, but not this one"
    do = f"Let the callback of {name} return its response, whatever the request is."
    return _silent(seen, service, says, do)


def _silent(seen: ServiceCalls, service: Service, says: str, do: str) -> Observation:
    """A service did not answer, of which this is said if it is still there."""
    if service.name in seen.gone:
        says = f"{service.name} was there, and no longer is, though the program still runs"
        do = "Find what takes the service away: the node has to keep it for as long as it runs."
    return Symptom.NO_ANSWER.seen(
        seen.trace, stuck=seen.stuck, answers=seen.spins, service=service.name, type=service.type, says=says, do=do
    )


def _silence(seen: ServiceCalls, answer: CallAnswer) -> str:
    """Say that a call got no answer, and whether the service was there."""
    silence = describe_no_answer(seen.trace, answer.took_s)
    return f"{silence}: the service is gone" if answer.service in seen.gone else silence
