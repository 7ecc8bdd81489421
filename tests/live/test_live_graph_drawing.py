from __future__ import annotations

import pytest

from tutor.live.facts import Endpoint, Qos, Topic
from tutor.tui.live.graph_drawing import drawing

S = "std_msgs/msg/String"
BEST_EFFORT = Qos("best_effort")


def lines(*topics: Topic, width: int = 82) -> list[str]:
    return ["".join(text for text, _ in row).rstrip() for row in drawing(topics, width)]


def test_a_node_leads_to_its_topic_and_that_to_its_listeners() -> None:
    listeners = (Endpoint("/listener", S), Endpoint("/message_stats", S))
    assert lines(Topic("/chatter", (Endpoint("/talker", S),), listeners)) == [
        "╭─────────╮    ┏━━━━━━━━━━━━━━━━━━━━┓    ╭────────────────╮",
        "│ /talker ├───▶┃ /chatter           ┃──┬▶│ /listener      │",
        "╰─────────╯    ┗━ std_msgs/String ━━┛  │ ╰────────────────╯",
        "                                       │ ╭────────────────╮",
        "                                       ╰▶│ /message_stats │",
        "                                         ╰────────────────╯",
    ]


def test_a_node_that_is_not_connected_has_no_arrow() -> None:
    listeners = (Endpoint("/good", S, BEST_EFFORT), Endpoint("/late", S))
    drawn = lines(Topic("/chatter", (Endpoint("/talker", S, BEST_EFFORT),), listeners))
    assert "▶│ /good" in drawn[1]
    assert "✗│ /late" in drawn[4]


def test_topics_of_one_node_hang_on_one_box_and_publishers_of_one_topic_meet() -> None:
    one = lines(Topic("/a", (Endpoint("/node", S),)), Topic("/b", (Endpoint("/node", S),)))
    assert sum("/node" in line for line in one) == 1
    assert [line.count("├───▶┃") for line in one] == [0, 1, 0, 0, 1, 0]
    two = lines(Topic("/a", (Endpoint("/x", S), Endpoint("/y", S))))
    assert "─┬─▶┃ /a" in two[1]
    assert two[4].endswith("├─╯")


def test_nobody_at_one_end_is_said_in_words() -> None:
    assert "nobody listens" in lines(Topic("/a", (Endpoint("/x", S),)))[1]
    assert lines(Topic("/a", (), (Endpoint("/x", S),)))[1].startswith(" nobody publishes")


@pytest.mark.parametrize("width", [60, 70, 118])
def test_it_fits_and_its_lines_meet(width: int) -> None:
    ends = tuple(Endpoint(f"/a_namespace/node_of_a_rather_long_name_{n}", S) for n in range(3))
    for row in lines(Topic("/another/long/name/of/a/topic", ends[:2], ends[2:]), width=width):
        assert len(row) <= width
