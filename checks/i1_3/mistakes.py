"""I1.3: the mistakes that only this exercise can know: what a wrong result is the result of."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from checks.i1_3.facts import OPERATOR_SIGNS, SAYS_ERROR, correct_result
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import CallAnswer, LogRecord
from tutor.mistakes import Case, Catalogue, Evidence, Found
from tutor.mistakes.examples import in_run
from tutor.mistakes.themes.python import late_binding

CATALOGUE = Catalogue()

_BIG = 5 * 10**9


def _answered(service: str, *calls: tuple[int, int, int]) -> Callable[[str], Observation]:
    """An observation of these calls: both operands and the answer, the first of which is wrong."""
    answers = tuple(CallAnswer(service, {"a": a, "b": b}, {"sum": got}, 0.0, 0.1) for a, b, got in calls)
    return in_run(Symptom.WRONG_ANSWER, service=service, answer=answers[0], calls=answers)


def _results(case: Case, service: str) -> list[tuple[int, int, int]]:
    """What a service answered: both operands and the result of each call."""
    calls = [each for each in case.about("calls", ()) if each.service == service and each.response is not None]
    return [(each.request["a"], each.request["b"], each.response["sum"]) for each in calls]


def _wrong(case: Case) -> tuple[str, list[tuple[int, int, int]]]:
    """The service with the wrong answer, and all its wrong results."""
    service = case.about("service", "")
    results = _results(case, service) if service in OPERATOR_SIGNS else []
    return service, [(a, b, got) for a, b, got in results if got != correct_result(service, a, b)]


@CATALOGUE.mistake(
    "client-file-missing",
    name="file missing",
    explains=[Symptom.CALLS_MISSING],
    evidence=Evidence.PROCESS,
    says="there is no {file} among the files",
    do="Write the client in {file}, next to {beside}.",
    example=in_run(Symptom.CALLS_MISSING, file="bell_client.py", beside="bell_server.py"),
)
def file_missing(case: Case) -> Iterator[Found]:
    """One of the files is not there.

    An exercise with two programs has two files, each of which is started by its name.

    Bad:

        # bell_client.py is still to be written

    Good:

        # bell_client.py
        bell = node.create_client(Trigger, 'ring')

    See it: `ls`.
    """
    if case.about("file"):
        yield Found({"file": case.about("file"), "beside": case.about("beside")})


@CATALOGUE.mistake(
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
    alike = [other for other in OPERATOR_SIGNS if _answers_like(_results(case, service), other)]
    everywhere = [
        other for other in alike if all(_answers_like(_results(case, each), other) for each in OPERATOR_SIGNS)
    ]
    if alike and not (everywhere and any(late_binding(case))):
        yield Found({"service": service, "other": alike[0]})


def _answers_like(results: list[tuple[int, int, int]], other: str) -> bool:
    return all(got == correct_result(other, a, b) for a, b, got in results if b or other != "/divide")


@CATALOGUE.mistake(
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
    told = [(a, b, got) for a, b, got in wrong if a]
    if all(got == abs(correct_result(service, a, b)) for a, b, got in _results(case, service) if b):
        return  # the order is right, and the sign is lost
    if any(got for _, _, got in told) and all(got == correct_result(service, b, a) for a, b, got in told):
        yield Found({"service": service})


@CATALOGUE.mistake(
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
    negative = {got for a, b, got in _results(case, service) if min(a, b) < 0}
    if len(wrong) > 1 and len(negative) == 1 and all(min(a, b) < 0 for a, b, _ in wrong):
        yield Found({"service": service, "got": wrong[0][2]})


@CATALOGUE.mistake(
    "zero-refused",
    explains=[Symptom.WRONG_ANSWER],
    evidence=Evidence.RUN,
    says="{service} computes with every other number, but not when b is 0, which only a division must refuse",
    do="Test for zero only in the callback of /divide.",
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


@CATALOGUE.mistake(
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
    lost = all(abs(got) == abs(correct_result(service, a, b)) for a, b, got in wrong)
    never_there = all(got == correct_result(service, abs(a), abs(b)) for a, b, got in wrong)
    if wrong and (lost or never_there):
        yield Found({"service": service})


@CATALOGUE.mistake(
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
    if wrong and all((got - correct_result(service, a, b)) % 2**32 == 0 for a, b, got in wrong):
        yield Found({"service": service})


@CATALOGUE.mistake(
    "the-same-message-for-every-call",
    explains=[Symptom.NOT_LOGGED],
    evidence=Evidence.RUN,
    says="a valid division is logged in the same words as one by zero, so the message reports no error: {message}",
    do="Log the error only when b is 0.",
    example=in_run(
        Symptom.NOT_LOGGED,
        ordinary=(LogRecord(40, "node", "error", 0.0, 0.0),),
        logged=(LogRecord(40, "node", "error", 0.0, 0.0),),
    ),
)
def same_message(case: Case) -> Iterator[Found]:
    """The same message appears whether or not something went wrong.

    A message reports an error only if it does not also appear when all is well. Otherwise, whoever reads the log cannot
    tell the two apart.

    Bad:

        self.get_logger().error('door open, or door stuck')

    Good:

        self.get_logger().error('door stuck')

    See it: the log, after a call that works.
    """
    usual = [log.text for log in case.about("ordinary", ()) if log.level >= 30 or SAYS_ERROR.search(log.text)]
    if usual and case.about("logged"):
        yield Found({"message": usual[-1]})
