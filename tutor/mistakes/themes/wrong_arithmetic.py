"""Services that compute a wrong result: what it is the result of instead."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import CallAnswer
from tutor.mistakes.entry import Case, Evidence, Found, mistake
from tutor.mistakes.examples import in_run
from tutor.mistakes.themes.python_pitfalls import late_binding

_BIG = 5 * 10**9

Result = tuple[int, int, int]
"""Both operands of a call, and the result that it was answered with."""

Operation = Callable[[int, int], int | None]
"""Computes the right result of two operands; None if any answer is right."""

_BELLS: dict[str, Operation] = {
    "/add": lambda a, b: a + b,
    "/subtract": lambda a, b: a - b,
    "/divide": lambda a, b: a // b if b else None,
}


def _answered(service: str, *calls: Result) -> Callable[[str], Observation]:
    """An observation of these calls, the first of which is answered wrongly."""
    answers = tuple(CallAnswer(service, {"a": a, "b": b}, {"sum": got}, 0.0, 0.1) for a, b, got in calls)
    return in_run(
        Symptom.WRONG_ANSWER, service=service, answer=answers[0], calls=answers, field="sum", operations=_BELLS
    )


def _operations(case: Case) -> dict[str, Operation]:
    """What each service should compute, by name; empty unless all take two whole numbers."""
    operations: dict[str, Any] = case.about("operations", {})
    calls = [call for call in case.about("calls", ()) if call.response is not None]
    numbers = [[*call.request.values(), call.response.get(case.about("field"))] for call in calls]
    are_whole = all(len(values) == 3 and all(type(value) is int for value in values) for values in numbers)
    return operations if are_whole else {}


def _results(case: Case, service: str) -> list[Result]:
    """What a service answered."""
    calls = [call for call in case.about("calls", ()) if call.service == service and call.response is not None]
    return [(*call.request.values(), call.response[case.about("field")]) for call in calls]


def _wrong(case: Case) -> tuple[str, list[Result]]:
    """The service with the wrong answer, and all its wrong results."""
    service, operations = case.about("service", ""), _operations(case)
    if (right := operations.get(service)) is None:
        return service, []
    return service, [(a, b, got) for a, b, got in _results(case, service) if right(a, b) not in (None, got)]


@mistake(
    "another-operation",
    explains=[Symptom.WRONG_ANSWER],
    evidence=Evidence.RUN,
    says="{service} answers what {other} should",
    do="Look at which callback {service} is made with, and at what that callback computes.",
    example=_answered("/add", (20, 4, 16), (9, 3, 6)),
)
def another_operation(case: Case) -> Iterator[Found]:
    """A service computes what another should.

    Services that look alike are often copied, and a name, an operator or a callback of the original stays behind. Or a
    result is kept under a key that two services share.

    Bad:

        self.create_service(Trigger, 'open', self.on_close)

    Good:

        self.create_service(Trigger, 'open', self.on_open)

    See it: call it with numbers for which all operations differ, such as 20 and 4.
    """
    service, wrong = _wrong(case)
    if not any(got for _, _, got in wrong):
        return
    operations = _operations(case)
    alike = [name for name, other in operations.items() if _answers_like(_results(case, service), other)]
    everywhere = [
        name for name in alike if all(_answers_like(_results(case, other), operations[name]) for other in operations)
    ]
    if alike and not (everywhere and any(late_binding(case))):
        yield Found({"service": service, "other": alike[0]})


def _answers_like(results: list[Result], other: Operation) -> bool:
    return all(other(a, b) in (None, got) for a, b, got in results)


@mistake(
    "operands-the-wrong-way-round",
    explains=[Symptom.WRONG_ANSWER],
    evidence=Evidence.RUN,
    says="{service} takes the two numbers the wrong way round",
    do="Look at the order of a and b in the callback of {service}.",
    example=_answered("/subtract", (20, 4, -16), (3, 10, 7)),
)
def wrong_way_round(case: Case) -> Iterator[Found]:
    """Two operands are swapped.

    Sums and products do not care which number comes first. Differences and quotients do.

    Bad:

        left = request.opened - request.doors

    Good:

        left = request.doors - request.opened

    See it: call it with two numbers, then the other way round.
    """
    service, wrong = _wrong(case)
    right = _operations(case).get(service)
    told = [(a, b, got) for a, b, got in wrong if a]
    if right is None or all(_size(right(a, b)) in (None, got) for a, b, got in _results(case, service)):
        return  # the order is right, and the sign is lost
    if any(got for _, _, got in told) and all(got == right(b, a) for a, b, got in told):
        yield Found({"service": service})


@mistake(
    "negative-operands-refused",
    explains=[Symptom.WRONG_ANSWER],
    evidence=Evidence.RUN,
    says="{service} answers {got} whenever an operand is negative, and is right otherwise",
    do="Remove the test for negative numbers from the callback of {service}.",
    example=_answered("/add", (-40, 4, 0), (50, -5, 0), (6, 3, 9)),
)
def negatives_refused(case: Case) -> Iterator[Found]:
    """Negative numbers are refused.

    An int64 holds negative numbers as well, and they can be computed with like any others.

    Bad:

        if request.floor < 0:
            return response

    Good:

        response.height = request.floor * 3

    See it: call it with one negative number, then with two.
    """
    service, wrong = _wrong(case)
    if not wrong:
        return  # or the request has more numbers than two
    negative = {got for a, b, got in _results(case, service) if min(a, b) < 0}
    if len(wrong) > 1 and len(negative) == 1 and all(min(a, b) < 0 for a, b, _ in wrong):
        yield Found({"service": service, "got": wrong[0][2]})


@mistake(
    "zero-refused",
    explains=[Symptom.WRONG_ANSWER],
    evidence=Evidence.RUN,
    says="{service} computes with every other number, but not with a 0 as the second one, which it need not refuse",
    do="Test for zero only where a number is divided by it.",
    example=_answered("/add", (7, 0, 0), (6, 3, 9)),
)
def zero_refused(case: Case) -> Iterator[Found]:
    """A zero is refused where it is a number like any other.

    Only a division has no result for b = 0. A test that all callbacks share refuses it everywhere.

    Bad:

        if request.doors == 0:
            return response

    Good:

        response.keys = request.doors + 1

    See it: add 0 to something.
    """
    service, wrong = _wrong(case)
    if wrong and all(b == 0 for _, b, _ in wrong) and len(_results(case, service)) > len(wrong):
        yield Found({"service": service})


@mistake(
    "sign-lost",
    explains=[Symptom.WRONG_ANSWER],
    evidence=Evidence.RUN,
    says="{service} gives the right number with the wrong sign",
    do="Look for what changes the sign in the callback of {service}, such as abs().",
    example=_answered("/divide", (-60, 3, 20), (60, 3, 20)),
)
def sign_lost(case: Case) -> Iterator[Found]:
    """A result has lost its sign.

    abs() makes every number positive; applied to operands, it changes differences, products and quotients.

    Bad:

        floors = abs(request.to - request.start)

    Good:

        floors = request.to - request.start

    See it: call it with a negative number.
    """
    service, wrong = _wrong(case)
    right = _operations(case).get(service)
    if wrong and right is not None:
        lost = all(abs(got) == _size(right(a, b)) for a, b, got in wrong)
        never_there = all(got == right(abs(a), abs(b)) for a, b, got in wrong)
        if lost or never_there:
            yield Found({"service": service})


def _size(number: int | None) -> int | None:
    return None if number is None else abs(number)


@mistake(
    "cut-to-32-bits",
    explains=[Symptom.WRONG_ANSWER],
    evidence=Evidence.RUN,
    says="{service} cuts its result to 32 bits, but large ones need more",
    do="Leave the numbers as they are: an int64 has 64 bits, and Python's int has no limit.",
    example=_answered("/add", (_BIG, 3, (_BIG + 3) % 2**32), (6, 3, 9)),
)
def cut_off(case: Case) -> Iterator[Found]:
    """A result is cut to 32 bits.

    An int64 field holds numbers up to about 9 * 10^18. A mask, or numpy's or ctypes' int32, cuts them at about 2 *
    10^9.

    Bad:

        rings = (self.rings + 1) & 0xFFFFFFFF

    Good:

        rings = self.rings + 1

    See it: compute with numbers beyond 2147483647.
    """
    service, wrong = _wrong(case)
    right = _operations(case).get(service)
    if wrong and right is not None and all((got - (right(a, b) or 0)) % 2**32 == 0 for a, b, got in wrong):
        yield Found({"service": service})
