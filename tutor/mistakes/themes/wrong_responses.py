"""Services that answer, but with something else than they should."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.judge.trace import CallAnswer
from tutor.mistakes.entry import Case, Evidence, Found, found, mistake
from tutor.mistakes.examples import in_run
from tutor.mistakes.themes.services import place_of, services_of
from tutor.source import argument, calls_in, last_name


@mistake(
    "answered-too-early",
    explains=[Symptom.WRONG_ANSWER],
    says="{line} does the work outside the callback, which answers at once, with nothing filled in yet: {code}",
    do="Let the callback itself do the work, and return the response when the work is done.",
)
def answered_early(case: Case) -> Iterator[Found]:
    """A service answers before its work is done.

    The response goes out when the callback returns it. A thread, a task or a done callback that fills it in later fills
    in an object that nobody sends any more.

    Bad:

        def __init__(self):
            self.create_service(Trigger, 'open_door', self.open_the_door)

        def open_the_door(self, request, response):
            Thread(target=self.turn_the_key, args=(response,)).start()
            return response

    Good:

        def __init__(self):
            self.create_service(Trigger, 'open_door', self.open_the_door)

        def open_the_door(self, request, response):
            self.turn_the_key(response)
            return response

    See it: `ros2 service call` answers at once.
    """
    for file in case.files if case.about("early", True) else ():
        for service in file.calls("create_service"):
            callback = file.function(argument(service, "callback"))
            if calls_in(callback, "join", "result", "wait"):
                continue
            for call in calls_in(callback, "Thread", "Timer", "submit", "create_task"):
                yield found(file, call)
            if callback is not None and not any(isinstance(node, ast.Await) for node in ast.walk(callback)):
                yield from (found(file, call) for call in calls_in(callback, "add_done_callback"))


@mistake(
    "response-field-not-set",
    explains=[Symptom.WRONG_ANSWER],
    evidence=Evidence.SYMPTOM,
    says="{service} answers 0 instead of {wanted}: a field that is never set is 0",
    do="Put the result into the response's field that the type has for it.",
    example=in_run(
        Symptom.WRONG_ANSWER,
        service="/count",
        wanted=7,
        answer=CallAnswer("/count", {}, {"sum": 0}, 0.0, 0.1),
    ),
)
def field_not_set(case: Case) -> Iterator[Found]:
    """A response is returned unchanged.

    The callback is given a response whose fields are 0, false or empty. What it computes reaches the caller only if it
    is put into one of these fields.

    Bad:

        def count(self, request, response):
            total = request.a + request.b
            return response

    Good:

        def count(self, request, response):
            response.sum = request.a + request.b
            return response

    See it: `ros2 interface show TYPE` lists the fields.
    """
    answer, wanted = case.about("answer"), case.about("wanted")
    response = answer.response if answer is not None else None
    calls = [call.response for call in case.about("calls", ()) if call.service == case.about("service")]
    empty = all(value == 0 for fields in (response, *calls) for value in (fields or {}).values())
    if response and wanted not in (None, 0) and empty and not _sets_a_field(case, tuple(response)):
        yield Found({"service": case.about("service", "the service"), "wanted": wanted})


def _sets_a_field(case: Case, fields: tuple[str, ...]) -> bool:
    """Whether the service's callback, as far as it can be found, puts something into one of these fields."""
    file, made = place_of(case, case.about("service", "")) or (case.file, None)
    callback = file.function(argument(made, "callback"))
    nodes = [node for function in (file.reachable_from(callback) if callback else ()) for node in ast.walk(function)]
    return any(
        (isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store) and node.attr in fields)
        or (isinstance(node, ast.keyword) and node.arg in fields)
        for node in nodes
    )


@mistake(
    "shared-state",
    explains=[Symptom.WRONG_ANSWER, Symptom.WRONG_GOAL],
    evidence=Evidence.RUN,
    says="{what}",
    do="Keep what belongs to one {call} in local variables of the callback.",
    example=in_run(Symptom.WRONG_ANSWER, shared=True),
)
def shared_state(case: Case) -> Iterator[Found]:
    """Calls that run at the same time share a variable.

    With several threads, a callback can run several times at once. All of these runs share the node's attributes: the
    second call overwrites what the first has put there.

    Bad:

        def open_the_door(self, request, response):
            self.who = request.data
            time.sleep(3.0)
            response.message = f'hello {self.who}'
            return response

    Good:

        def open_the_door(self, request, response):
            time.sleep(3.0)
            response.message = f'hello {request.data}'
            return response

    See it: call the service twice at once, with different values. The same happens to two goals of an action.
    """
    if not (shared := case.about("shared")):
        return
    if case.symptom is Symptom.WRONG_GOAL:
        found = shared if isinstance(shared, str) else "a goal that came while another one ran"
        yield Found({"what": f"{found} ended with what belongs to that one", "call": "goal"})
    else:
        other = shared if isinstance(shared, str) else "the result of another that was made at the same time"
        yield Found({"what": f"one call was answered with {other}", "call": "call"})


@mistake(
    "wrong-duration",
    explains=[Symptom.WRONG_ANSWER],
    evidence=Evidence.SYMPTOM,
    says="the answer comes after {took_s:.1f} s, not after {wanted_s:g} s{where}",
    do="Look at how long the callback works before it answers, and in which unit that is.",
    example=in_run(Symptom.WRONG_ANSWER, took_s=1.0, wanted_s=5.0),
)
def wrong_duration(case: Case) -> Iterator[Found]:
    """A callback takes longer, or less long, than it should.

    time.sleep() takes seconds. The wait() of an Event that is already set returns at once; a loop of short sleeps takes
    a little longer than their sum.

    Bad:

        time.sleep(500)

    Good:

        time.sleep(0.5)

    See it: `time ros2 service call …`.
    """
    if case.about("took_s") is None:
        return
    words = {"took_s": case.about("took_s"), "wanted_s": case.about("wanted_s")}
    waits = [
        (file, call)
        for file in case.files
        for function in file.callbacks("create_service")
        for call in calls_in(function, "sleep", "wait")
    ]
    if len(waits) == 1:
        file, call = waits[0]
        yield found(file, call, where=f"; {case.place(file.name, call.lineno)}: {file.line(call.lineno)}", **words)
    yield Found({**words, "where": ""})


@mistake(
    "wrong-sum",
    explains=[Symptom.WRONG_ANSWER],
    evidence=Evidence.SYMPTOM,
    says="{seen}; see {line}: {code}",
    do="{step}",
    example=in_run(
        Symptom.WRONG_ANSWER,
        answer=CallAnswer("/count", {"a": 2, "b": 5}, {"sum": 10}, 0.0, 0.1),
        wanted=7,
        says="10 instead of 7",
        do="Count again.",
    ),
)
def wrong_sum(case: Case) -> Iterator[Found]:
    """What a callback puts into the response is wrong.

    A response holds what the callback puts into its fields. Whole numbers in a request are Python's own integers, which
    are as long as they need to be: neither a float nor a narrower type is needed in between.

    Bad:

        response.sum = 10

    Good:

        response.sum = request.a + request.b

    See it: `ros2 service call`, with small numbers and with large ones.
    """
    answer = case.about("answer")
    if answer is None or not (answer.response or {}).get("sum") or len(services_of(case)) > 1:
        return  # where several services put their results, the place is not what makes one of them wrong
    places = [
        (file, node)
        for file in case.files
        for node in file.nodes
        if isinstance(node, ast.Assign) and any(last_name(target) == "sum" for target in node.targets)
    ]
    if len(places) == 1:
        yield found(*places[0], seen=case.seen.says, step=case.seen.do)
