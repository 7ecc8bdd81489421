"""B1.2 A Call Inside a Callback: a service that asks another one before it answers, and keeps nobody waiting."""

from __future__ import annotations

import random
from collections.abc import Mapping
from typing import Any

from tutor.exercise import (
    AnswersAtOnce,
    AnswersByAsking,
    AnswersWithoutReply,
    Asking,
    EndsCleanly,
    EndsWhileAsking,
    KeepsPaceWhileAsking,
    Program,
    Service,
    Topic,
    check,
)

LIGHT = Topic("/bridge/light", "std_msgs/msg/Bool")
LIGHT_HZ = 10.0


def reply(data: bool) -> Mapping[str, Any]:
    """Return what the harbour says: yes or no, and words with a number that nobody can guess."""
    success, number = random.random() < 0.5, random.randint(10**6, 10**7)
    move = "raise" if data else "lower"
    return {"success": success, "message": f"clearance {number} to {move}" if success else f"no {number}, a ship"}


MOVE = Asking(
    Service("/bridge/move", "std_srvs/srv/SetBool", ("data",)),
    asks=Service("/harbour/clearance", "std_srvs/srv/SetBool", ("data",)),
    requests=((True,), (False,)),
    replies=reply,
    refusal={"success": False, "message": str.strip},
    refused="success=False and a message",
)

asks = AnswersByAsking("asks", MOVE)

CHECK = check(
    "b1.2",
    Program("bridge_keeper.py"),
    asks,
    KeepsPaceWhileAsking("light", MOVE, LIGHT, LIGHT_HZ, hold_s=1.5, after=asks),
    AnswersAtOnce("at-once", MOVE, after=asks),
    AnswersWithoutReply("missing", MOVE, "missing", within_s=5.0, after=asks),
    EndsCleanly("shutdown"),
    AnswersWithoutReply("silent", MOVE, "silent", within_s=6.0, after=asks, bonus=True),
    EndsWhileAsking("shutdown-busy", MOVE, shown_by=asks, after=asks, bonus=True),
    expected_s=4.5,
    expected_reason="a harbour that does not reply: 3 s until the keeper gives up",
)
