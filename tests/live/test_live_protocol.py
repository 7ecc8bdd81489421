from __future__ import annotations

import pytest

from tutor.live.protocol import (
    Call,
    Follow,
    Publish,
    Ready,
    SetParameter,
    SetVisible,
    StopPublishing,
    Update,
    WatcherError,
    decode_request,
    decode_update,
    encode_request,
    encode_update,
)
from tutor.live.updates import CallOutcome, NodeParameters, PublishStatus, RequestForm, SetOutcome, TopicUpdate
from tutor.ros_model import Field, Graph, Parameter, QoS, ServiceEndpoint, Timing, TopicEndpoint

ENDPOINT = TopicEndpoint("/t", "std_msgs/msg/String", "/n", QoS("best_effort", deadline_s=0.5))


@pytest.mark.parametrize(
    "update",
    [
        Ready(3),
        WatcherError("é\u2028"),
        Graph(
            ("/n", "/n"), (ENDPOINT,), (ENDPOINT, ENDPOINT), (ServiceEndpoint("/s", "a/srv/B", "/n", "best_effort"),)
        ),
        TopicUpdate("/t", "x", QoS(), 3, None, None, None),
        TopicUpdate("/t", "x", QoS(), 3, 1, Timing(2, 0.1, 0.0, 0.1, 0.1), 0.5, "a: 1\n", ("a",), "a", ((1.0, 2.0),)),
        NodeParameters("/n", True, (Parameter("/n", "p", "double array", [1.0], minimum=0.0),)),
        SetOutcome(1, "/n", "p", [1.0], True, False, "no", 1.0, 0.1),
        RequestForm("a/srv/B", (Field("x.y", "int64", "0"),)),
        CallOutcome(1, "/s", {"x.y": 3}, None, "cancelled", 1.0, 2.0),
        PublishStatus("/t", "a/msg/B", 2.0, 3, 1, 1.0, True, "no"),
    ],
)
def test_updates_round_trip(update: Update) -> None:
    line = encode_update(update)
    assert "\n" not in line
    assert line.isascii()
    assert decode_update(line) == update


def test_requests_round_trip() -> None:
    for request in (
        Follow("/t"),
        SetVisible(False),
        SetParameter(1, "/n", "p", "double", 2.0),
        Call(2, "/s", "a/srv/B", {"a": [1, 2]}, 3.0),
        Publish("/t", "a/msg/B", {"x.y": 1.5}, 0.0),
        StopPublishing("/t"),
    ):
        assert decode_request(encode_request(request)) == request


@pytest.mark.parametrize(
    "line", ["", "{}", "[1]", '{"kind": "Follow"}', '{"kind": "Eval", "x": 1}', encode_update(Ready(1))]
)
def test_other_lines_are_rejected(line: str) -> None:
    with pytest.raises(ValueError, match="not understood"):
        decode_request(line)


def test_values_without_a_json_form_round_trip() -> None:
    outcome = SetOutcome(1, "/n", "p", [float("inf"), -float("inf")], True, True, "\udcff", 1.0, 0.1)
    assert decode_update(encode_update(outcome)) == outcome
