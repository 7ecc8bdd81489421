"""ros2 topic list, info, type, find."""

from __future__ import annotations

from tests.ros2cli.bench import TALKER, Bench, Ran

MANY = """
from std_msgs.msg import String
nodes = [rclpy.create_node(f"node_{number}") for number in range(6)]
for node in nodes:
    node.create_publisher(String, f"_hidden_{node.get_name()}", 10)
    for topic in range(5):
        node.create_publisher(String, f"{node.get_name()}/topic_{topic}", 10)
        node.create_subscription(String, f"{node.get_name()}/heard_{topic}", print, 10)
spin(*nodes)
"""


def test_the_topic_list_is_complete_at_once_and_has_hidden_topics_on_request(bench: Bench) -> None:
    shown = [f"/node_{n}/{kind}_{t}" for n in range(6) for kind in ("heard", "topic") for t in range(5)]
    shown += ["/parameter_events", "/rosout"]
    hidden = [f"/_hidden_node_{n}" for n in range(6)]
    with bench.node(MANY):
        assert bench.ros2("topic", "list").stdout.splitlines() == sorted(shown)
        for words in (("list", "--include-hidden-topics"), ("--include-hidden-topics", "list")):
            listed = bench.ros2("topic", *words).stdout.splitlines()
            assert {*shown, *hidden} <= set(listed), words


def test_topics_are_listed_found_typed_and_described(bench: Bench) -> None:
    with bench.node(TALKER):
        assert bench.ros2("topic", "list", "-t").stdout == (
            "/chatter [std_msgs/msg/String]\n"
            "/parameter_events [rcl_interfaces/msg/ParameterEvent]\n"
            "/rosout [rcl_interfaces/msg/Log]\n"
        )
        assert bench.ros2("topic", "list", "-v").stdout == (
            "Published topics:\n"
            " * /chatter [std_msgs/msg/String] 1 publisher\n"
            " * /parameter_events [rcl_interfaces/msg/ParameterEvent] 2 publishers\n"
            " * /rosout [rcl_interfaces/msg/Log] 2 publishers\n"
            "\n"
            "Subscribed topics:\n"
            "\n"
        )
        assert bench.ros2("topic", "list", "-c").stdout == "3\n"
        assert bench.ros2("topic", "find", "std_msgs/msg/String") == Ran("/chatter\n", "", 0)
        assert bench.ros2("topic", "find", "std_msgs/String") == Ran("", "", 0)
        assert bench.ros2("topic", "type", "/chatter") == Ran("std_msgs/msg/String\n", "", 0)
        assert bench.ros2("topic", "type", "/nothing") == Ran("", "", 1)
        brief = bench.ros2("topic", "info", "/chatter")
        assert brief == Ran("Type: std_msgs/msg/String\nPublisher count: 1\nSubscription count: 0\n", "", 0)
        long = bench.ros2("topic", "info", "-v", "/chatter").stdout
        assert long.startswith(
            "Type: std_msgs/msg/String\n\nPublisher count: 1\n\nNode name: talker\nNode namespace: /\n"
        )
        assert "  Liveliness lease duration: Infinite\n\nSubscription count: 0\n\n" in long
        assert bench.ros2("topic", "info", "chatter") == Ran("", "Unknown topic 'chatter'\n", 1)
