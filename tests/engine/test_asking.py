"""A service that asks another one, by its forms, on real nodes: our server replies, holds back, or is not there."""

from __future__ import annotations

import random

import pytest

from tests.engine.helpers import NODE, Scene, assert_failed_for, statuses
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

COOK = Asking(
    Service("/cook", "std_srvs/srv/SetBool", ("data",)),
    Service("/oven", "std_srvs/srv/SetBool", ("data",)),
    requests=((True,), (False,)),
    replies=lambda data: {"success": data, "message": f"oven {random.randint(10**6, 10**7)}"},
    refusal={"success": False, "message": str.strip},
    refused="success=False and a message",
)
asks = AnswersByAsking("asks", COOK)
CHECK = check(
    "t1",
    Program("node.py"),
    asks,
    KeepsPaceWhileAsking("pace", COOK, Topic("/lamp", "std_msgs/msg/Bool"), 20.0, hold_s=1.0),
    AnswersAtOnce("at-once", COOK),
    AnswersWithoutReply("missing", COOK, "missing"),
    AnswersWithoutReply("silent", COOK, "silent"),
    EndsWhileAsking("busy", COOK, shown_by=asks),
)

COOKS = """
import time

from rclpy.callback_groups import ReentrantCallbackGroup
from std_msgs.msg import Bool
from std_srvs.srv import SetBool

seen = []
group = ReentrantCallbackGroup()
oven = node.create_client(SetBool, "/oven", callback_group={group})
lamp = node.create_publisher(Bool, "/lamp", 10)
node.create_timer(0.05, lambda: lamp.publish(Bool()), callback_group={timer})

async def cook(request, response):
    if {unknown}:
        return SetBool.Response(message="no oven")
    {before}
    asked = oven.call_async(request)
    limit = node.create_timer({limit_s}, asked.cancel, callback_group=group)
    reply = await asked
    node.destroy_timer(limit)
    return reply or SetBool.Response(message="no reply")

node.create_service(SetBool, "/cook", cook, callback_group={service})
"""

SEEN_ONCE = "not seen and not (oven.service_is_ready() and not seen.append(True))"
"""Whether the oven has never been there."""


def cook(**changes: str) -> str:
    """A learner's node that asks the oven."""
    usual = {
        "group": "group",
        "timer": "group",
        "service": "group",
        "unknown": "not oven.service_is_ready()",
        "limit_s": "2.0",
        "before": "pass",
    }
    return NODE.format(COOKS.format(**{**usual, **changes}))


async def test_a_right_node_passes(scene: Scene) -> None:
    result = await scene.judge(*CHECK.criteria, source=cook())
    assert set(statuses(result).values()) == {"passed"}, result


@pytest.mark.parametrize(
    ("changes", "criterion", "mistake", "words"),
    [
        ({"group": "None", "service": "None"}, "asks", "deadlock-by-await", "/oven had replied at once"),
        ({"limit_s": "0.7"}, "asks", "wrong-answer", "gives up before /oven has replied"),
        ({"timer": "None", "service": "None"}, "pace", "same-callback-group", "the longest pause 1."),
        ({"unknown": "False", "limit_s": "60.0"}, "missing", "asked-without-looking", "asks /oven"),
        ({"before": "time.sleep(0.9)"}, "pace", "callbacks-wait-for-each-other", "stops before /cook asks /oven"),
        ({"unknown": SEEN_ONCE, "limit_s": "60.0"}, "missing", "no-answer", "/oven, which has gone again"),
        ({"limit_s": "60.0"}, "silent", "no-limit-to-a-wait", "waits for a reply of /oven"),
    ],
)
async def test_a_wrong_node_fails_what_it_breaks(
    scene: Scene, changes: dict[str, str], criterion: str, mistake: str, words: str
) -> None:
    result = await scene.judge(*CHECK.criteria, source=cook(**changes), only=frozenset({criterion}))
    assert_failed_for(result, mistake, words)
