from __future__ import annotations

import pytest

from tutor.ros_model import Graph, NodeName, Service, ServiceEndpoint, Topic, TopicEndpoint

TALKER = TopicEndpoint("/chatter", "std_msgs/msg/String", "/talker")
LISTENER = TopicEndpoint("/chatter", "std_msgs/msg/Int32", "/listener")
LIST = "rcl_interfaces/srv/ListParameters"


@pytest.mark.parametrize("full", ["/talker", "/robot1/talker", "/a/b/talker"])
def test_a_full_name_is_split_into_namespace_and_name(full: str) -> None:
    name = NodeName.parse(full)
    assert name.name == "talker"
    assert name.namespace.startswith("/")
    assert name.full == full


def test_the_first_slash_of_a_full_name_may_be_left_out() -> None:
    assert NodeName.parse("talker") == NodeName.parse("/talker") == ("talker", "/")
    assert NodeName.parse("robot1/talker") == ("talker", "/robot1")


def test_endpoints_are_grouped_by_topic_and_service() -> None:
    servers = (
        ServiceEndpoint("/b", "a/srv/B", "/two"),
        ServiceEndpoint("/a", "a/srv/A", "/one"),
        ServiceEndpoint("/a", "a/srv/B", "/two"),
    )
    graph = Graph(publishers=(TALKER,), subscriptions=(LISTENER,), servers=servers)
    assert graph.topics == (Topic("/chatter", (TALKER,), (LISTENER,)),)
    assert graph.topics[0].types == ("std_msgs/msg/String", "std_msgs/msg/Int32")
    assert graph.topic("/chatter") == graph.topics[0]
    assert graph.topic("/other") is None
    assert graph.services == (
        Service("/a", ("a/srv/A", "a/srv/B"), ("/one", "/two")),
        Service("/b", ("a/srv/B",), ("/two",)),
    )


def test_parameter_nodes_are_those_with_parameter_services() -> None:
    servers = [ServiceEndpoint(f"{node}/list_parameters", LIST, node) for node in ("/x", "/y", "/x")]
    graph = Graph(("/w", "/x", "/x", "/y"), servers=(*servers, ServiceEndpoint("/add", "a/srv/B", "/w")))
    assert graph.parameter_nodes == ("/x", "/y")
    assert [server.is_standard for server in graph.servers] == [True, True, True, False]
    assert [(service.name, service.is_standard) for service in graph.services] == [
        ("/add", False),
        ("/x/list_parameters", True),
        ("/y/list_parameters", True),
    ]


@pytest.mark.parametrize(("name", "standard"), [("/rosout", True), ("/parameter_events", True), ("/chatter", False)])
def test_topics_that_every_node_has_are_standard(name: str, standard: bool) -> None:
    assert Topic(name).is_standard is standard
