from __future__ import annotations

import pytest

from tutor.judge.trace import Parameter
from tutor.live.facts import (
    CallOutcome,
    Endpoint,
    Field,
    Graph,
    NodeParameters,
    Published,
    Qos,
    RequestForm,
    Service,
    SetOutcome,
    Timing,
    Topic,
    TopicNews,
)
from tutor.live.protocol import (
    Attend,
    Call,
    Follow,
    News,
    Publish,
    Ready,
    SetParameter,
    StopPublishing,
    Trouble,
    decode_command,
    decode_news,
    encode,
)

END = Endpoint("/n", "std_msgs/msg/String", Qos("best_effort", deadline_s=0.5))


@pytest.mark.parametrize(
    "news",
    [
        Ready(3),
        Trouble("é\u2028"),
        Graph(("/n", "/n"), (Topic("/t", (END,), (END, END)),), (Service("/s", ("a/srv/B",), ("/n",)),)),
        TopicNews("/t", "x", Qos(), 3, None, None, None),
        TopicNews("/t", "x", Qos(), 3, 1, Timing(2, 0.1, 0.0, 0.1, 0.1), 0.5, "a: 1\n", ("a",), "a", ((1.0, 2.0),)),
        NodeParameters("/n", True, (Parameter("/n", "p", "double array", [1.0], minimum=0.0),)),
        SetOutcome(1, "/n", "p", [1.0], True, False, "no", 1.0, 0.1),
        RequestForm("a/srv/B", (Field("x.y", "int64", "0"),)),
        CallOutcome(1, "/s", {"x.y": 3}, None, "cancelled", 1.0, 2.0),
        Published("/t", "a/msg/B", 2.0, 3, 1, 1.0, True, "no"),
    ],
)
def test_news_arrive_as_they_were_said(news: News) -> None:
    line = encode(news)
    assert "\n" not in line
    assert line.isascii()
    assert decode_news(line) == news


def test_commands_arrive_as_they_were_given() -> None:
    for command in (
        Follow("/t"),
        Attend(False),
        SetParameter(1, "/n", "p", "double", 2.0),
        Call(2, "/s", "a/srv/B", {"a": [1, 2]}, 3.0),
        Publish("/t", "a/msg/B", {"x.y": 1.5}, 0.0),
        StopPublishing("/t"),
    ):
        assert decode_command(encode(command)) == command


@pytest.mark.parametrize("line", ["", "{}", "[1]", '{"kind": "Follow"}', '{"kind": "Eval", "x": 1}', encode(Ready(1))])
def test_anything_else_is_no_command(line: str) -> None:
    with pytest.raises(ValueError, match="not understood"):
        decode_command(line)
