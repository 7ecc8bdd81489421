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
    """Return a topic of these nodes. If `requested` gives any node's QoS, the publishers are best effort."""
    offered = BEST_EFFORT if requested else QoS()
    return Topic(
        name,
        tuple(TopicEndpoint(name, S, node, offered) for node in publishers),
        tuple(TopicEndpoint(name, S, node, requested.get(node[1:], QoS())) for node in subscriptions),
    )


def test_arrows_lead_from_publisher_to_topic_to_subscribers() -> None:
    assert lines(topic("/chatter", ["/talker"], ["/listener", "/message_stats"])) == [
        "╭─────────╮    ┏━━━━━━━━━━━━━━━━━━━━┓    ╭────────────────╮",
        "│ /talker ├───▶┃ /chatter           ┃──┬▶│ /listener      │",
        "╰─────────╯    ┗━ std_msgs/String ━━┛  │ ╰────────────────╯",
        "                                       │ ╭────────────────╮",
        "                                       ╰▶│ /message_stats │",
        "                                         ╰────────────────╯",
    ]


def test_an_incompatible_subscriber_has_no_arrow() -> None:
    drawn = lines(topic("/chatter", ["/talker"], ["/good", "/late"], good=BEST_EFFORT))
    assert "▶│ /good" in drawn[1]
    assert "✗│ /late" in drawn[4]


def test_a_node_has_one_box_for_all_its_topics_and_publishers_of_a_topic_join() -> None:
    one = lines(topic("/a", ["/node"]), topic("/b", ["/node"]))
    assert sum("/node" in line for line in one) == 1
    assert [line.count("├───▶┃") for line in one] == [0, 1, 0, 0, 1, 0]
    two = lines(topic("/a", ["/x", "/y"]))
    assert "─┬─▶┃ /a" in two[1]
    assert two[4].endswith("├─╯")


def test_a_missing_publisher_or_subscriber_is_described_in_words() -> None:
    assert "nobody listens" in lines(topic("/a", ["/x"]))[1]
    assert lines(topic("/a", [], ["/x"]))[1].startswith(" nobody publishes")


@pytest.mark.parametrize("width", [60, 70, 118])
def test_the_drawing_fits_the_width(width: int) -> None:
    nodes = [f"/a_namespace/node_of_a_rather_long_name_{n}" for n in range(3)]
    for row in lines(topic("/another/long/name/of/a/topic", nodes[:2], nodes[2:]), width=width):
        assert len(row) <= width
