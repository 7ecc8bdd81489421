"""Services that answer, but with something else than they should."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.judge.trace import CallAnswer
from tutor.mistakes.entry import Case, Evidence, Found, found, mistake
from tutor.mistakes.examples import in_run
from tutor.mistakes.themes.services import place_of
from tutor.source import argument, calls_in


@mistake(
    "answered-too-early",
    explains=[Symptom.WRONG_ANSWER],
    says="{line} does the work outside the callback, which answers at once, with nothing filled in yet: {code}",
    do="Let the callback itself do the work, and return the response when the work is done.",
)
def answered_early(case: Case) -> Iterator[Found]:
    """A service answers before its work is done.

    The response goes out when the callback returns it. A thread or task that fills it in later fills in an object that
    nobody sends any more.

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
    empty = all(value == 0 for each in (response, *calls) for value in (each or {}).values())
    if response and wanted not in (None, 0) and empty and not _sets_a_field(case, tuple(response)):
        yield Found({"service": case.about("service", "the service"), "wanted": wanted})


def _sets_a_field(case: Case, fields: tuple[str, ...]) -> bool:
    """Whether the service's callback, as far as it can be found, puts something into one of these fields."""
    file, made = place_of(case, case.about("service", "")) or (case.file, None)
    callback = file.function(argument(made, "callback"))
    nodes = [node for each in (file.reachable_from(callback) if callback else ()) for node in ast.walk(each)]
    return any(
        (isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store) and node.attr in fields)
        or (isinstance(node, ast.keyword) and node.arg in fields)
        for node in nodes
    )


@mistake(
    "shared-state",
    explains=[Symptom.WRONG_ANSWER],
    evidence=Evidence.RUN,
    says="one call was answered with the result of another that was made at the same time",
    do="Keep what belongs to one call in local variables of the callback.",
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

    See it: call the service twice at once, with different values.
    """
    if case.about("shared"):
        yield Found()
