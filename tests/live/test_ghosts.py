"""Nodes that have left but that the rmw still lists."""

from __future__ import annotations

from tutor.live.ghosts import without_ghosts
from tutor.ros_model import Graph, ServiceEndpoint

SERVERS = tuple(ServiceEndpoint(f"{node}/add", "example_interfaces/srv/AddTwoInts", node) for node in ("/a", "/b"))


def test_a_node_that_lost_all_its_endpoints_has_left() -> None:
    connected: set[str] = set()
    both = Graph(nodes=("/a", "/b"), servers=SERVERS)
    assert without_ghosts(both, connected) == both
    assert without_ghosts(Graph(nodes=("/a", "/b"), servers=SERVERS[1:]), connected).nodes == ("/b",)
    assert without_ghosts(both, connected) == both, "the node has been restarted"


def test_a_node_whose_endpoints_are_not_discovered_yet_is_kept() -> None:
    connected: set[str] = set()
    assert without_ghosts(Graph(nodes=("/a",)), connected).nodes == ("/a",)


def test_of_two_nodes_with_one_name_none_is_dropped_while_one_runs() -> None:
    connected: set[str] = set()
    two = Graph(nodes=("/a", "/a"), servers=SERVERS[:1])
    assert without_ghosts(two, connected) == two
