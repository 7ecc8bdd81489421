"""A form: a service answers with what the service that it asks has replied."""

from __future__ import annotations

from dataclasses import dataclass

from tutor.exercise.asking import (
    Asking,
    AskingCall,
    AskingRun,
    BusyWatch,
    DumpWhileAsking,
    answers_with,
    gave_up,
    is_right,
    open_desk,
    wait_for_both,
)
from tutor.exercise.form import Exercise, Form
from tutor.exercise.node_parameters import DumpSilentNode
from tutor.exercise.nouns import Program, agrees
from tutor.exercise.service_calls import ANSWER_S, EXIT_LIMIT_S, SPIN_S, STUCK_CALL_S, describe_request
from tutor.judge.bench import Bench
from tutor.judge.check import Criterion
from tutor.judge.ending import repeat_chance_failures
from tutor.judge.stuck_nodes import ask_unless_stuck
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import Ending
from tutor.judge.tracebacks import Frame
from tutor.judge.verdict import Verdict, failed, passed, undecided
from tutor.judge.wording import describe_no_answer, output_tail

ROUNDS = 2
"""How often each request is made: an answer that is kept from the call before shows."""


@dataclass(frozen=True)
class AskedInTurn(AskingRun):
    """Calls one after the other, up to the first without a right answer; the run ends with Ctrl+C."""

    ending: Ending | None = None


GIVE_UPS = 3
"""A node that gives up so many calls in a row, though each was replied to at once, does so on any machine."""


@dataclass(frozen=True)
class AskInTurn:
    """Start without parameters beside our server, call the node several times, and press Ctrl+C.

    We reply at once, but to the last call after `hold_s` seconds.
    """

    program: Program
    asking: Asking
    hold_s: float = 0.0

    async def __call__(self, bench: Bench) -> AskedInTurn:
        return await repeat_chance_failures(self._run)(bench)

    async def _run(self, bench: Bench) -> AskedInTurn:
        asking, program = self.asking, self.program
        silent, stuck = DumpSilentNode(program), tuple[Frame, ...]()
        async with bench.start(program.file, expected_s=1.5 + self.hold_s) as run, open_desk(run, asking) as desk:
            bench.report_progress(0.1, f"waiting for {asking.service.name}")
            offered, calls = await wait_for_both(run, program, asking), list[AskingCall]()
            graph, is_stuck, answers, watch = run.graph, False, True, BusyWatch(run)
            if offered:
                parameters, is_stuck = await ask_unless_stuck(run, SPIN_S, lambda: bench.facts(silent))
                answers = parameters is not None or not graph.parameter_nodes
                bench.report_progress(0.3, f"calling {asking.service.name}, and replying on {asking.asks.name}")
                calls.append(await desk.reach(STUCK_CALL_S if is_stuck else ANSWER_S))
            for given in asking.requests * ROUNDS if calls and calls[0].exchanges else ():
                if not is_right(asking, calls[-1]):
                    break
                calls.append(await desk.call(given))
            if self.hold_s and len(calls) > len(asking.requests) and is_right(asking, calls[-1]):
                bench.report_progress(0.6, f"holding back the reply on {asking.asks.name}")
                calls.append(await desk.call_and_hold(asking.requests[0], self.hold_s))
            slowed = watch.is_to_blame(*calls)
            while slowed and gave_up(asking, calls[-1]) and len(calls) < GIVE_UPS:
                calls.append(await desk.call(asking.requests[len(calls) % 2]))
            if len(calls) >= GIVE_UPS and all(gave_up(asking, call) for call in calls[-GIVE_UPS:]):
                slowed = False
            unanswered = bool(calls) and calls[-1].answer.response is None
            if unanswered and run.exit is None and not run.graph.nodes:
                await run.wait_for_exit(EXIT_LIMIT_S)  # it is on its way out
            trace = run.trace()
            bench.report_progress(0.8, "pressing Ctrl+C")
            ending = await run.interrupt()
        if unanswered and trace.exit is None:
            stuck = await bench.facts(silent if is_stuck else DumpWhileAsking(program, asking, "replies"))
        return AskedInTurn(trace, answers, stuck, slowed, offered=offered, calls=tuple(calls), ending=ending)


@dataclass(frozen=True)
class AnswersByAsking(Form):
    """A service of the node answers with what another service, which the check serves, has replied to it.

    It is called several times, one call after the other; see `Asking`. `hold_s`: for how long the reply to the last
    call is held back, in seconds; take a time after which nobody gives up yet.
    """

    asking: Asking
    hold_s: float = 1.5

    def criterion(self, exercise: Exercise) -> Criterion:
        return self.judged(self.judge, self.ended_start(exercise))

    def ended_start(self, exercise: Exercise) -> AskInTurn:
        return AskInTurn(exercise.program, self.asking, self.hold_s)

    def judge(self, seen: AskedInTurn) -> Verdict:
        """Judge all calls."""
        asking = self.asking
        expected = f"{asking.service.name} answers each call with what {asking.asks.name} has replied to it"
        tail = output_tail(seen.trace)
        if not seen.offered:
            return failed(expected, f"missing: {asking.service.name}", not_offered(asking, seen), tail)
        lines = [describe_call(asking, call) for call in seen.calls]
        for call in seen.calls:
            if call.answer.response is None:
                observed = no_answer_in_words(asking, seen, call)
                return failed(expected, observed, no_answer(asking, seen, call), (*lines[:-1], *tail))
            if not is_right(asking, call):
                if seen.slowed and gave_up(asking, call) and not call.ended_early:
                    return undecided(f"to wait for the answer of {asking.service.name}")
                observed, why = what_is_wrong(asking, seen, call)
                return failed(expected, observed, why, (*lines, *tail))
        return passed(expected, f"{len(seen.calls)} calls, each with its own reply", lines)


def describe_call(asking: Asking, call: AskingCall) -> str:
    """A call in one line: what was asked on both sides, and what came back."""
    asked = describe_request(asking.service, call.answer.request)
    on = "; ".join(f"asked with {_shown(e.asked)}, we replied {_shown(e.reply)}" for e in call.exchanges[:2])
    return f"{asking.service.name} {asked}: {on or 'nothing was asked'}; answered {_shown(call.answer.response)}"


def _shown(fields: object) -> str:
    return str(dict(fields)) if isinstance(fields, dict) else "nothing" if fields is None else str(fields)


def not_offered(asking: Asking, seen: AskingRun, *, alone: bool = False) -> Observation:
    """The node's service is not there. `alone`: neither is our server."""
    name = asking.service.name
    return seen.symptom(
        Symptom.SERVICE_MISSING,
        service=name,
        type=asking.service.type,
        services=(name,) if alone else (name, asking.asks.name),
        says=f"{name} is not there",
        do="Create the service where the node is set up, under its own name and with its own callback.",
    )


def no_answer_in_words(asking: Asking, seen: AskingRun, call: AskingCall) -> str:
    """What was observed of a call without an answer: how far it got."""
    got = describe_no_answer(seen.trace, call.answer.took_s, ANSWER_S)
    if call.replies:
        return f"{asking.asks.name} was asked, and has replied; {asking.service.name}: {got}"
    if call.exchanges:
        return f"{asking.asks.name} was asked, and has not replied; {asking.service.name}: {got}"
    return f"{asking.asks.name} was not asked; {asking.service.name}: {got}"


def no_answer(asking: Asking, seen: AskingRun, call: AskingCall, *, at_once: int = 1) -> Observation:
    """A call got no answer. `at_once`: how many calls there were at the same time."""
    name = asking.service.name
    says, do = f"{name} does not answer, and does not ask", f"Follow the callback of {name} to where it stays."
    if call.replies:
        says = f"{asking.asks.name} has replied, and {name} does not answer all the same"
        do = "Look at what takes in the reply while the callback waits for it: the thread, and the callback group."
    elif call.exchanges:
        says = f"{asking.asks.name} does not reply, and {name} waits for it without a limit"
        do = "Give up after some time, and answer that there is no reply."
    return seen.symptom(
        Symptom.NO_ANSWER,
        service=name,
        type=asking.service.type,
        services=(name, asking.asks.name),
        asks=asking.asks.name,
        asked=bool(call.exchanges),
        replied=bool(call.replies),
        at_once=at_once,
        says=says,
        do=do,
    )


def what_is_wrong(
    asking: Asking, seen: AskingRun, call: AskingCall, *, beside: bool = False, shared: str = ""
) -> tuple[str, Observation]:
    """What was observed of a call with a wrong answer, and the symptom.

    `beside`: there was another call at the same time. `shared`: what it was answered with, if that is the other's.
    """
    name, answer, own = asking.service.name, call.answer, asking.passed_on(call.answer.request)
    assert answer.response is not None
    got, asked = dict(answer.response), [e for e in call.exchanges if agrees(e.asked, own)]
    refused = bool(asking.refusal) and answers_with(answer, asking.refusal)
    given_up = gave_up(asking, call) and not call.ended_early
    if not call.exchanges:
        observed = f"answered {got}, without asking {asking.asks.name}"
        says = f"{name} answers, and nobody has asked {asking.asks.name}"
        do = "Send the request with the client in the service's callback, and answer with what comes back."
        if refused:
            says = f"{name} refuses, though {asking.asks.name} is there"
            do = "Look at what the callback takes for a sign that nobody is there."
        if refused and beside:
            says = f"{name} refuses one of two calls made at once"
            do = "Let each call ask for itself, or wait for its turn, and pass on what it is told."
    elif not asked:
        observed = f"{asking.asks.name} was asked with {_shown(call.exchanges[0].asked)}, not {own}"
        says = f"{name} got {_shown(answer.request)}, and asks {asking.asks.name} for something else"
        do = "Fill the fields of the request that you send from those of the request that you got."
    elif refused and call.ended_early:
        observed = f"answered {got} after {answer.took_s:.1f} s; {asking.asks.name} takes {call.held_s:g} s to reply"
        says = f"{name} gives up before {asking.asks.name} has replied"
        do = "Wait for as long as a reply may take."
    elif given_up:
        observed = f"answered {got} after {answer.took_s:.1f} s; {asking.asks.name} had replied at once"
        says = f"{name} gives up, though {asking.asks.name} has replied"
        do = "Look at what takes in the reply while the callback waits for it: the thread, and the callback group."
    else:
        reply = next((e.reply for e in asked if e.reply is not None), {})
        observed = f"answered {got}; it was told {dict(asking.right_answer(reply))}"
        says = f"the answer of {name} is not what {asking.asks.name} has replied to this call"
        do = "Follow the reply through the callback to the fields of the response."
    return observed, seen.symptom(
        Symptom.WRONG_ANSWER,
        service=name,
        type=asking.service.type,
        asks=asking.asks.name,
        asked=bool(call.exchanges),
        answer=answer,
        given_up=given_up,
        shared=shared,
        says=says,
        do=do,
    )
