"""ros2 lifecycle, against real lifecycle nodes."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.ros2cli.bench import TALKER, Bench, Ran
from tests.ros2cli.test_completion import complete

NODES = """
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn

class Careful(LifecycleNode):
    def on_configure(self, state):
        ready = self.get_parameter("ready").value
        return TransitionCallbackReturn.SUCCESS if ready else TransitionCallbackReturn.FAILURE

camera = Careful("camera", namespace="/robot")
camera.declare_parameter("ready", True)
spin(camera, LifecycleNode("_spare"))
"""
CAMERA = "/robot/camera"
NOT_FOUND = Ran("", "Node not found\n", 1)
DONE = Ran("Transitioning successful\n", "", 0)
AT_FIRST = """\
- configure [1]
\tStart: unconfigured
\tGoal: configuring
- shutdown [5]
\tStart: unconfigured
\tGoal: shuttingdown
"""


@pytest.fixture(scope="module")
def cameras(module_bench: Bench) -> Iterator[Bench]:
    """A bench with two unconfigured lifecycle nodes, one of them hidden, and a node that is none."""
    with module_bench.node(NODES), module_bench.node(TALKER):
        yield module_bench


def test_only_lifecycle_nodes_are_listed(cameras: Bench) -> None:
    assert cameras.ros2("lifecycle", "nodes") == Ran(f"{CAMERA}\n", "", 0)
    assert cameras.ros2("lifecycle", "nodes", "-a") == Ran(f"/_spare\n{CAMERA}\n", "", 0)
    assert cameras.ros2("lifecycle", "nodes", "--count-nodes").stdout == "1\n"
    assert cameras.ros2("lifecycle", "nodes", "-a", "-c").stdout == "2\n"


def test_states_are_shown(cameras: Bench) -> None:
    assert cameras.ros2("lifecycle", "get", CAMERA) == Ran("unconfigured [1]\n", "", 0)
    assert cameras.ros2("lifecycle", "get", "robot/camera").stdout == "unconfigured [1]\n"
    assert cameras.ros2("lifecycle", "get") == Ran(f"{CAMERA}: unconfigured [1]\n", "", 0)
    assert cameras.ros2("lifecycle", "get", "--include-hidden-nodes", "_spare").stdout == "unconfigured [1]\n"
    every = cameras.ros2("lifecycle", "get", "--include-hidden-nodes").stdout
    assert every == f"/_spare: unconfigured [1]\n{CAMERA}: unconfigured [1]\n"


def test_transitions_are_listed(cameras: Bench) -> None:
    assert cameras.ros2("lifecycle", "list", CAMERA) == Ran(AT_FIRST, "", 0)
    every = cameras.ros2("lifecycle", "list", "-a", CAMERA).stdout
    assert every.startswith(
        "- configure [1]\n\tStart: unconfigured\n\tGoal: configuring\n"
        "- transition_success [10]\n\tStart: configuring\n\tGoal: inactive\n"
    )
    assert every.endswith("- transition_error [62]\n\tStart: errorprocessing\n\tGoal: finalized\n")
    assert every.count("- ") == 25


@pytest.mark.parametrize("verb", [("get",), ("list",), ("set", "configure")])
@pytest.mark.parametrize("node", ["/nope", "/_spare", "/talker"])
def test_a_node_that_is_absent_hidden_or_none_with_a_lifecycle_is_not_found(
    cameras: Bench, verb: tuple[str, ...], node: str
) -> None:
    assert cameras.ros2("lifecycle", verb[0], node, *verb[1:]) == NOT_FOUND


def test_an_unknown_transition_is_answered_with_those_there_are(cameras: Bench) -> None:
    assert cameras.ros2("lifecycle", "set", CAMERA, "activate") == Ran(
        "", "Unknown transition requested, available ones are:\n- configure [1]\n- shutdown [5]\n", 1
    )


def test_names_of_nodes_and_transitions_are_completed(cameras: Bench) -> None:
    assert complete(cameras, "ros2 lifecycle get /") == [CAMERA]
    assert complete(cameras, f"ros2 lifecycle set {CAMERA} c") == ["configure"]


def test_a_node_goes_through_its_life(bench: Bench) -> None:
    with bench.node(NODES):
        for transition, state in (
            ("configure", "inactive [2]"),
            ("3", "active [3]"),
            ("deactivate", "inactive [2]"),
            ("cleanup", "unconfigured [1]"),
        ):
            assert bench.ros2("lifecycle", "set", CAMERA, transition) == DONE
            assert bench.ros2("lifecycle", "get", CAMERA).stdout == f"{state}\n"
        bench.ros2("param", "set", CAMERA, "ready", "false")
        assert bench.ros2("lifecycle", "set", CAMERA, "configure") == Ran("", "Transitioning failed\n", 0)
        assert bench.ros2("lifecycle", "set", CAMERA, "shutdown") == DONE
        assert bench.ros2("lifecycle", "get", CAMERA).stdout == "finalized [4]\n"
        assert bench.ros2("lifecycle", "list", CAMERA) == Ran("", "", 0)
