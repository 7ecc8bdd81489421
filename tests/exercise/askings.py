"""A service that asks another one, the forms of one, and calls of it."""

from __future__ import annotations

from tests.checks.builders import START
from tutor.exercise import (
    AnswersAtOnce,
    AnswersByAsking,
    AnswersWithoutReply,
    Asking,
    EndsWhileAsking,
    KeepsPaceWhileAsking,
    Program,
    Service,
    Topic,
    check,
)
from tutor.exercise.asking import AskingCall, Exchange
from tutor.judge.trace import CallAnswer

LAMP = Topic("/lamp", "std_msgs/msg/Bool")
COOK = Asking(
    Service("/cook", "std_srvs/srv/SetBool", ("data",)),
    Service("/oven", "std_srvs/srv/SetBool", ("data",)),
    requests=((True,), (False,)),
    replies=lambda data: {"success": data, "message": f"oven {data}"},
    refusal={"success": False, "message": str.strip},
    refused="success=False and a message",
)
ADD = Asking(
    Service("/taxed", "example_interfaces/srv/AddTwoInts", ("a", "b")),
    Service("/tax", "example_interfaces/srv/AddTwoInts", ("a", "b")),
    requests=((1, 2), (3, 4)),
    replies=lambda a, b: {"sum": 10 * a + b},
    asks_with=lambda a, b: (b, a),
    becomes=lambda reply: {"sum": reply["sum"] + 1},
)
asks = AnswersByAsking("asks", COOK)
CHECK = check(
    "t1",
    Program("node.py"),
    asks,
    KeepsPaceWhileAsking("pace", COOK, LAMP, 10.0),
    AnswersAtOnce("at-once", COOK),
    AnswersWithoutReply("missing", COOK, "missing"),
    AnswersWithoutReply("silent", COOK, "silent"),
    EndsWhileAsking("busy", COOK, shown_by=asks),
)


def call(
    data: bool = True,
    *exchanges: tuple[bool, str | None],
    success: bool = True,
    message: str | None = None,
    took_s: float = 0.1,
    held_s: float = 0.0,
) -> AskingCall:
    """A call. `exchanges`: with what we were asked, and our message (None: no reply); `message`: None if unanswered."""
    response = None if message is None else {"success": success, "message": message}
    answer = CallAnswer("/cook", {"data": data}, response, START, START + took_s)
    made = (
        Exchange({"data": asked}, START, None if text is None else {"success": True, "message": text})
        for asked, text in exchanges
    )
    return AskingCall(answer, tuple(made), held_s)


RIGHT = call(True, (True, "oven 7"), message="the oven 7 is hot")
OTHER = call(False, (False, "oven 8"), message="oven 8")
REFUSED = call(success=False, message="no oven")
