"""I1.3 Calculator Service: four services that calculate and report a division by zero, and a client that calls all."""

from __future__ import annotations

import random

from tutor.exercise import (
    Answers,
    CallsAll,
    EndsCleanly,
    Program,
    Question,
    Serves,
    Service,
    SurvivesBadCall,
    check,
)

TYPE, FIELDS = "example_interfaces/srv/AddTwoInts", ("a", "b")

ADD = Service("/add", TYPE, FIELDS, "sum", lambda a, b: a + b, "+")
SUBTRACT = Service("/subtract", TYPE, FIELDS, "sum", lambda a, b: a - b, "-")
MULTIPLY = Service("/multiply", TYPE, FIELDS, "sum", lambda a, b: a * b, "*")
DIVIDE = Service("/divide", TYPE, FIELDS, "sum", lambda a, b: a // b if b else None, "÷")  # any answer, if b is 0
SERVICES = (ADD, SUBTRACT, MULTIPLY, DIVIDE)


def random_operands() -> list[tuple[int, int]]:
    """Return random pairs (a, b), so that no answer can be hard-coded; a is a multiple of b.

    They cover every combination of signs, values beyond 32 bits, and a = 0. No result has more than 53 bits.
    """
    ordinary = [(sign * random.randint(20, 900), by) for by in (1, -1) for sign in (1, -1)]
    large = random.choice((1, -1)) * random.randint(2 * 10**9, 4 * 10**9)
    return [
        (quotient * divisor, divisor)
        for quotient, sign in (*ordinary, (large, 1), (0, 1))
        for divisor in [sign * random.randint(3, 19)]
    ]


def questions() -> list[Question]:
    """Return calls of all services with the same operands, and some with these swapped.

    Not to divide: the quotient would not be a whole number, or the divisor is 0.
    """
    chosen = random_operands()
    swapped = [(service, (b, a)) for service in SERVICES[:3] for a, b in (chosen[0], chosen[-1])]
    return [*((service, (a, b)) for service in SERVICES for a, b in chosen), *swapped]


serves = Serves("services", SERVICES, call_with=(6, 3))

CHECK = check(
    "i1.3",
    Program("calculator_server.py"),
    serves,
    Answers("operations", SERVICES, questions),
    SurvivesBadCall(
        "divide-by-zero",
        DIVIDE,
        good=(84, 7),
        bad=(10, 0),
        then=((18, 3), (-9, 0), (0, 0), (35, 5)),
        what="a division by zero",
        after=serves,
    ),
    CallsAll("client", Program("calculator_client.py"), SERVICES, within_s=15.0),
    EndsCleanly("shutdown", bonus=True),
    expected_s=1.1,
    expected_reason="a division by zero: 0.6 s until the log is quiet, 0.5 s in which a node may exit",
)
