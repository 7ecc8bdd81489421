from __future__ import annotations

from collections.abc import Sequence

import pytest

from tutor.ros_model import QoS, Topic, TopicEndpoint
from tutor.tui.live.graph_drawing import draw_graph

S = "std_msgs/msg/String"
BEST_EFFORT = QoS("best_effort")


def lines(*topics: Topic, width: int = 82) -> list[str]:
    return ["".join(text for text, _ in row).rstrip() for row in draw_graph(topics, width)]


def topic(name: str, publishers: Sequence[str], subscriptions: Sequence[str] = (), **requested: QoS) -> Topic:
    """A topic of these nodes; where some request another QoS, the publishers are best effort."""
    offered = BEST_EFFORT if requested else QoS()
    return Topic(
        name,
        tuple(TopicEndpoint(name, S, node, offered) for node in publishers),
        tuple(TopicEndpoint(name, S, node, requested.get(node[1:], QoS())) for node in subscriptions),
    )


def test_a_node_leads_to_its_topic_and_that_to_its_listeners() -> None:
    assert lines(topic("/chatter", ["/talker"], ["/listener", "/message_stats"])) == [
        "╭─────────╮    ┏━━━━━━━━━━━━━━━━━━━━┓    ╭────────────────╮",
        "│ /talker ├───▶┃ /chatter           ┃──┬▶│ /listener      │",
        "╰─────────╯    ┗━ std_msgs/String ━━┛  │ ╰────────────────╯",
        "                                       │ ╭────────────────╮",
        "                                       ╰▶│ /message_stats │",
        "                                         ╰────────────────╯",
    ]


def test_a_node_that_is_not_connected_has_no_arrow() -> None:
    drawn = lines(topic("/chatter", ["/talker"], ["/good", "/late"], good=BEST_EFFORT))
    assert "▶│ /good" in drawn[1]
    assert "✗│ /late" in drawn[4]


def test_topics_of_one_node_hang_on_one_box_and_publishers_of_one_topic_meet() -> None:
    one = lines(topic("/a", ["/node"]), topic("/b", ["/node"]))
    assert sum("/node" in line for line in one) == 1
    assert [line.count("├───▶┃") for line in one] == [0, 1, 0, 0, 1, 0]
    two = lines(topic("/a", ["/x", "/y"]))
    assert "─┬─▶┃ /a" in two[1]
    assert two[4].endswith("├─╯")


def test_nobody_at_one_end_is_said_in_words() -> None:
    assert "nobody listens" in lines(topic("/a", ["/x"]))[1]
    assert lines(topic("/a", [], ["/x"]))[1].startswith(" nobody publishes")


@pytest.mark.parametrize("width", [60, 70, 118])
def test_it_fits_and_its_lines_meet(width: int) -> None:
    nodes = [f"/a_namespace/node_of_a_rather_long_name_{n}" for n in range(3)]
    for row in lines(topic("/another/long/name/of/a/topic", nodes[:2], nodes[2:]), width=width):
        assert len(row) <= width
