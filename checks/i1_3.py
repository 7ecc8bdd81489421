"""I1.3 Calculator Service: four services that calculate, say so when they cannot, and a client that uses them all."""

from __future__ import annotations

import random
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from tutor.judge import causes, ending, tracebacks
from tutor.judge.bench import Bench, Run
from tutor.judge.check import Check, Criterion
from tutor.judge.trace import CallAnswer, Ending, Exit, Level, LogRecord, Served, Service, Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.verdict import Cause, Verdict, failed, passed, skipped
from tutor.judge.waiting import appears

SERVER, CLIENT = "calculator_server.py", "calculator_client.py"
TYPE = "example_interfaces/srv/AddTwoInts"
SIGNS = {"/add": "+", "/subtract": "-", "/multiply": "×", "/divide": "÷"}
EASY = (6, 3)
ANSWER_S = 5.0
CLIENT_S = 15.0
AFTERWARDS_S = 0.5
"""A node that gives up after a division by zero does so within this time."""
STUCK_S = 1.5
"""A call that was not answered once is given this long, then the node is stuck in it."""
LOG_S = 2.0
"""What a node logs about a call may come this much later than its answer."""

SAYS_ERROR = re.compile(
    r"zero|null|cero|zéro|nul\b|noll|nolla|sıfır|zerem|zera|nula|nulla|нол|нул|零|ゼロ|제로|0으로|μηδέν|صفر|אפס|शून्य"
    r"|error|fehler|erreur|errore|erro\b|fout|fel\b|feil|fejl|virhe|błąd|blad|chyba|hiba|hata|ошибк|помилк|錯誤|错误|エラー|오류|σφάλμα|خطأ|שגיאה|lỗi|kesalahan"
    r"|exception|warn|fail|invalid|illegal|undefined|impossib|cannot|can't|can not|unable|refus|reject|forbid|not (?:allowed|possible|defined|permitted|valid)|n/a|nan\b|infinit"
    r"|ungültig|nicht|unmöglich|undefiniert|verboten|inválid|invalide|interdit|indéfini|indefinid|no (?:se puede|permitid|definid)|não|impossível|non (?:si può|valid|definit)"
    r"|нельзя|невозмож|недопуст|不能|无效|無效|未定義|未定义|できません|無理|不可|불가",
    re.IGNORECASE,
)
"""Words by which a log message says that something is wrong, in the languages that learners log in."""


@dataclass(frozen=True)
class Calls:
    """What the server answered: one list of answers, in the order in which they were asked for.

    `spins`: whether the node answered a parameter call before; `stuck`: where it was when a call was not answered.
    """

    trace: Trace
    answers: tuple[CallAnswer, ...]
    spins: bool = True
    stuck: tuple[Frame, ...] = ()
    ending: Ending | None = None

    def of(self, service: str) -> tuple[CallAnswer, ...]:
        return tuple(answer for answer in self.answers if answer.service == service)


@dataclass(frozen=True)
class Division:
    """A good division, one by zero, and what came after; `said` is what was logged about the division by zero."""

    trace: Trace
    before: CallAnswer | None = None
    by_zero: CallAnswer | None = None
    after: CallAnswer | None = None
    ordinary: tuple[LogRecord, ...] = ()
    said: tuple[LogRecord, ...] = ()


@dataclass(frozen=True)
class Demonstration:
    """A run of the client against servers of ours. None of it where the submission has no client."""

    trace: Trace | None
    served: tuple[Served, ...] = ()
    exit: Exit | None = None
    stuck: tuple[Frame, ...] = ()


# --- scenarios ---------------------------------------------------------------------------------------------------------


async def survey(bench: Bench) -> Calls:
    """Call every service once as `ros2 service call` does, then press Ctrl+C."""
    async with bench.start(SERVER) as run:
        bench.doing(0.1, "waiting for the four services")
        await appears(run, lambda: not _missing(run.graph.services))
        spins = await run.parameters(2.0) is not None
        there = [name for name in SIGNS if name not in _missing(run.graph.services)]
        bench.doing(0.4, "calling each service")
        answers = await _ask(run, [(name, *EASY) for name in there])
        trace = run.trace()
        bench.doing(0.8, "pressing Ctrl+C")
        ended = await run.interrupt() if run.exit is None else None
    unanswered = next((answer for answer in answers if answer.response is None), None)
    stuck = await _stuck(bench, unanswered) if unanswered and trace.exit is None else ()
    return Calls(trace, answers, spins, stuck, ended)


async def _stuck(bench: Bench, unanswered: CallAnswer) -> tuple[Frame, ...]:
    """Ask the same once more, only to see where the node is while it does not answer."""
    async with bench.start(SERVER) as run:
        bench.doing(0.9, "looking where the node is stuck")
        await appears(run, lambda: any(service.name == unanswered.service for service in run.graph.services))
        await run.call(unanswered.service, TYPE, unanswered.request, limit_s=STUCK_S)
        return await run.stuck_at()


async def calculation(bench: Bench) -> Calls:
    """Calculate with operands by chance."""
    async with bench.start(SERVER) as run:
        await appears(run, lambda: not _missing(run.graph.services))
        there = [name for name in SIGNS if name not in _missing(run.graph.services)]
        bench.doing(0.3, "calculating with positive and negative numbers")
        answers = await _ask(run, [(name, a, b) for name in there for a, b in _operands(name)])
        return Calls(run.trace(), answers)


async def _ask(run: Run, questions: Sequence[tuple[str, int, int]]) -> tuple[CallAnswer, ...]:
    """Call one after another; stop at one without an answer, since each further one would cost the learner its limit."""
    answers: list[CallAnswer] = []
    for name, a, b in questions:
        answers.append(await run.call(name, TYPE, {"a": a, "b": b}, limit_s=ANSWER_S))
        if answers[-1].response is None:
            break
    return tuple(answers)


async def division(bench: Bench) -> Division:
    """Divide by zero, listen to what the node says, and call again."""
    async with bench.start(SERVER) as run:
        bench.doing(0.1, "waiting for /divide")
        if not await appears(run, lambda: "/divide" not in _missing(run.graph.services)):
            return Division(run.trace())

        async def divide(a: int, b: int) -> CallAnswer:
            return await run.call("/divide", TYPE, {"a": a, "b": b}, limit_s=ANSWER_S)

        before = await divide(84, 7)
        await _quiet(run)
        ordinary = tuple(run.logs)
        bench.doing(0.4, "calling /divide: 10 ÷ 0")
        by_zero = await divide(10, 0)
        await run.until(lambda: bool(_complaints(ordinary, run.logs[len(ordinary) :])), LOG_S)
        said = tuple(run.logs[len(ordinary) :])
        await run.until(lambda: run.exit is not None, AFTERWARDS_S)
        bench.doing(0.8, "calling /divide again: 18 ÷ 3")
        after = await divide(18, 3)
        return Division(run.trace(), before, by_zero, after, ordinary, said)


async def demonstration(bench: Bench) -> Demonstration:
    """Run the client against four servers of ours."""
    if not bench.has(CLIENT):
        return Demonstration(None)
    servers = {name: (TYPE, _server(name)) for name in SIGNS}
    async with bench.start(CLIENT, serve=servers) as run:
        bench.doing(0.2, "running the client against our servers")
        await run.until(lambda: run.exit is not None, CLIENT_S)
        trace, served, ended = run.trace(), tuple(run.served), run.exit
        return Demonstration(trace, served, ended, await run.stuck_at() if ended is None else ())


def _operands(service: str) -> list[tuple[int, int]]:
    """Operands by chance, so that no answer can be known beforehand; with every combination of signs."""
    chosen: list[tuple[int, int]] = []
    for sign_a, sign_b in ((1, 1), (-1, 1), (1, -1), (-1, -1)):
        a, b = sign_a * random.randint(20, 900), sign_b * random.randint(2, 19)
        chosen.append((a * b, b) if service == "/divide" else (a, b))
    return chosen


def _right(service: str, a: int, b: int) -> int:
    return {"/add": a + b, "/subtract": a - b, "/multiply": a * b, "/divide": a // b if b else 0}[service]


def _server(service: str) -> Any:
    def answer(request: Mapping[str, Any]) -> Mapping[str, Any]:
        result = _right(service, request["a"], request["b"])
        return {"sum": max(-(2**63), min(2**63 - 1, result))}

    return answer


def _missing(services: Sequence[Service]) -> list[str]:
    """The required services that are not there with the required type."""
    there = {service.name for service in services if service.type == TYPE}
    return [name for name in SIGNS if name not in there]


async def _quiet(run: Run) -> None:
    """Wait until the node has logged what it had to say about the call just answered."""
    seen = -1
    while len(run.logs) != seen:
        seen = len(run.logs)
        await run.until(lambda seen=seen: len(run.logs) != seen, 0.3)  # type: ignore[misc]


def _complaints(ordinary: Sequence[LogRecord], said: Sequence[LogRecord]) -> list[LogRecord]:
    """The messages that say that something is wrong. One of a kind that a good call brings too does not."""
    usual = {(log.level, _shape(log.text)) for log in ordinary}
    return [
        log
        for log in said
        if (log.level, _shape(log.text)) not in usual and (log.level >= Level.WARN or SAYS_ERROR.search(log.text))
    ]


def _shape(text: str) -> str:
    return re.sub(r"-?\d+(\.\d+)?", "#", text)


# --- judges ------------------------------------------------------------------------------------------------------------


def judge_services(seen: Calls) -> Verdict:
    expected = f"/add, /subtract, /multiply and /divide with type {TYPE}, answering a call"
    missing = _missing(seen.trace.graph.services)
    if missing:
        cause = _why_missing(seen.trace, missing)
        return failed(expected, f"missing: {', '.join(missing)}", cause, causes.last_words(seen.trace))
    unanswered = next((answer for answer in seen.answers if answer.response is None), None)
    if unanswered is not None:
        observed = f"no answer from {unanswered.service} in {ANSWER_S:g} s"
        return failed(expected, observed, _why_unanswered(seen), causes.last_words(seen.trace))
    return passed(expected, "all four answer", [f"{name} = {result}" for name, result in _answered(seen.answers)])


def _why_missing(trace: Trace, missing: Sequence[str]) -> Cause:
    broken = causes.of_process(trace)
    if broken is not None:
        return broken
    offered = [s for s in trace.graph.services if not _of_every_node(s)]
    for name in missing:
        for service in offered:
            if service.name == name:
                return Cause("wrong type", f"{name} has the type {service.type}, not {TYPE}",
                             f"create it with AddTwoInts: self.create_service(AddTwoInts, '{name[1:]}', ...)")
    for name in missing:
        for service in offered:
            if service.name not in SIGNS and (service.name.endswith(name) or name[1:4] in service.name):
                return Cause("wrong service name", f"there is {service.name} instead of {name}",
                             f"name it '{name[1:]}', without a namespace or ~ in front")
    return Cause("service missing", f"{', '.join(missing)} {'is' if len(missing) == 1 else 'are'} not there",
                 f"self.create_service(AddTwoInts, '{missing[0][1:]}', self.{missing[0][1:]}_callback)")


def _of_every_node(service: Service) -> bool:
    return service.type.startswith(("rcl_interfaces/", "type_description_interfaces/"))


def _why_unanswered(seen: Calls) -> Cause:
    broken = causes.of_process(seen.trace)
    if broken is not None:
        return broken
    if not seen.spins:
        return causes.no_spin(seen.trace)
    own = tracebacks.own(seen.stuck, seen.trace.folder)
    where = f", at {own}" if own else ""
    if _in_call(seen.stuck):
        return Cause("deadlock by call()", f"the callback waits for another service's answer{where}, which cannot come: the "
                     "executor is busy with this callback", "use call_async() and await it in an async callback")
    return Cause("blocked executor", f"the node was up, but its callback does not come to an end{where}",
                 "let the callback calculate, fill in the response and return it at once")


def _in_call(stuck: Sequence[Frame]) -> bool:
    return any(frame.function == "call" and frame.path.endswith("rclpy/client.py") for frame in stuck)


def judge_operations(seen: Calls) -> Verdict:
    expected = "right results, negative operands included"
    if _missing(seen.trace.graph.services):
        return skipped("not judged, because `services` did not pass")
    for answer in seen.answers:
        a, b = answer.request["a"], answer.request["b"]
        right = _right(answer.service, a, b)
        question = f"{answer.service}: {a} {SIGNS[answer.service]} {b}"
        if answer.response is None:
            return failed(f"{question} = {right}", f"no answer in {ANSWER_S:g} s",
                          causes.of_process(seen.trace) or Cause("no answer", "the service does not answer this call",
                                                                "return the response at the end of the callback"),
                          causes.last_words(seen.trace))
        if answer.response["sum"] != right:
            return failed(f"{question} = {right}", f"{answer.response['sum']}", _why_wrong(answer, right),
                          [f"{name} answered {result}" for name, result in _answered(seen.of(answer.service))])
    return passed(expected, f"{len(seen.answers)} calls", [f"{name} = {result}" for name, result in _answered(seen.answers)][:8])


def _answered(answers: Sequence[CallAnswer]) -> list[tuple[str, Any]]:
    return [
        (f"{a.request['a']} {SIGNS[a.service]} {a.request['b']}", a.response["sum"])
        for a in answers
        if a.response is not None
    ]


def _why_wrong(answer: CallAnswer, right: int) -> Cause:
    assert answer.response is not None
    got, a, b = answer.response["sum"], answer.request["a"], answer.request["b"]
    name = answer.service
    others = [other for other in SIGNS if other != name and _right(other, a, b) == got]
    if others:
        return Cause("wrong result", f"this is what {others[0]} would answer",
                     f"look at the sign in the callback of {name}, and at which callback belongs to which service")
    if name == "/subtract" and got == b - a:
        return Cause("wrong result", "the operands are the wrong way round", "resp.sum = req.a - req.b")
    if got == -1 and name == "/divide":
        return Cause("float in an int field", "a / b is a float, and resp.sum takes whole numbers only", "use a // b")
    if abs(got) == abs(right):
        return Cause("wrong result", "the sign is lost", "no abs(): negative numbers are numbers too")
    if got == 0:
        return Cause("wrong result", "the result is 0: is it put into resp.sum?", "set resp.sum before you return resp")
    return Cause("wrong result", f"{got} instead of {right}", f"look at the callback of {name}")


def judge_division(seen: Division) -> Verdict:
    expected = "dividing by zero gets an answer, the node says that it is an error, and the next call is answered too"
    if seen.before is None or seen.before.response is None or seen.by_zero is None or seen.after is None:
        return failed(expected, "/divide does not answer even 84 ÷ 7",
                      causes.of_process(seen.trace) or Cause("no answer", "the service does not answer", "see `services`"),
                      causes.last_words(seen.trace))
    if seen.by_zero.response is None:
        cause = causes.of_process(seen.trace) or Cause(
            "no answer", "the callback does not answer when b is 0", "return the response in that case too")
        return failed(expected, f"10 ÷ 0 got no answer in {ANSWER_S:g} s", cause, causes.last_words(seen.trace))
    complaints = _complaints(seen.ordinary, seen.said)
    if not complaints:
        printed = [line.text for line in seen.trace.output if line.stream == "stdout" and SAYS_ERROR.search(line.text)]
        cause = Cause("printed, not logged", f"it is only printed: {printed[0]}", "use self.get_logger().error(...)") if printed \
            else Cause("no error message", "nothing that the node logs says that this is an error",
                       "self.get_logger().error('division by zero') before you return the response")
        return failed(expected, f"answered {seen.by_zero.response['sum']}, without a word about an error", cause,
                      [str(log) for log in seen.said])
    if seen.after.response is None:
        cause = causes.of_process(seen.trace) or Cause(
            "no answer", "the node no longer answers after a division by zero", "let the node go on: only log, and answer")
        return failed(expected, "the call after it got no answer", cause, causes.last_words(seen.trace))
    return passed(expected, f"answered {seen.by_zero.response['sum']}; 18 ÷ 3 after it {seen.after.response['sum']}",
                  [str(complaints[0])])


def judge_client(seen: Demonstration) -> Verdict:
    expected = f"{CLIENT}, run without arguments, calls all four services and ends by itself with 0 within {CLIENT_S:g} s"
    if seen.trace is None:
        return failed(expected, f"there is no {CLIENT}", Cause("file missing", f"the submission has no {CLIENT}",
                                                               f"write {CLIENT} beside {SERVER}"))
    called = {served.service for served in seen.served}
    missing = [name for name in SIGNS if name not in called]
    calls_made = [f"{s.service} {s.request['a']} {s.request['b']} -> {s.response['sum']}" for s in seen.served[:12]]
    words = (*calls_made, *causes.last_words(seen.trace, 4))
    if seen.exit is None:
        return failed(expected, f"still running after {CLIENT_S:g} s; called {_listed(called)}",
                      _why_hanging(seen), words)
    ended = f"ended after {seen.exit.after_s:.1f} s with {seen.exit}"
    if seen.exit.code != 0:
        cause = causes.of_process(seen.trace)
        if cause is None or cause.name == "exit at once":
            cause = Cause("non-zero exit", f"the client {ended}", "end with return or sys.exit(0) when all went well")
        return failed(expected, f"{ended}; called {_listed(called)}", cause, words)
    if missing:
        cause = Cause("no main call", "main() is defined, but nothing calls it",
                      'end the file with: if __name__ == "__main__": main()') if seen.trace.uncalled_main and not called else \
            Cause("not called", f"{', '.join(missing)} got no request", "call each service, and wait for each answer before you go on")
        return failed(expected, f"{ended}; {', '.join(missing)} not called", cause, words)
    return passed(expected, f"{len(seen.served)} calls, {ended}", calls_made)


def _why_hanging(seen: Demonstration) -> Cause:
    assert seen.trace is not None
    own = tracebacks.own(seen.stuck, seen.trace.folder)
    where = f" at {own}" if own else ""
    if _in_call(seen.stuck):
        return Cause(
            "deadlock by call()",
            f"the client waits for ever{where}: call() blocks the thread that would have to take in the answer",
            "use call_async() and rclpy.spin_until_future_complete(node, future), outside of callbacks",
        )
    return Cause(
        "did not end",
        f"the client was still busy{where}" if where else "the client does not end by itself",
        "wait for each service, call it with call_async(), spin until its future is done, and return after the last answer",
    )


def _listed(called: set[str]) -> str:
    return ", ".join(name for name in SIGNS if name in called) or "nothing"


def judge_shutdown(seen: Calls) -> Verdict:
    return ending.judge(seen.trace, seen.ending)


CHECK = Check(
    "i1.3",
    (
        Criterion("services", judge_services, (survey,)),
        Criterion("operations", judge_operations, (calculation,)),
        Criterion("divide-by-zero", judge_division, (division,), after=("services",)),
        Criterion("client", judge_client, (demonstration,)),
        Criterion("shutdown", judge_shutdown, (survey,), bonus=True),
    ),
)
