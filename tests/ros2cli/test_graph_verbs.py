"""ros2 node, service, param and action, against real nodes."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.ros.ordinary_domain import ordinary_domain
from tests.ros2cli.bench import TALKER, Bench, Ran, command
from tests.ros2cli.pseudo_terminal import terminal

SERVER = """
from example_interfaces.srv import AddTwoInts
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor, SetParametersResult
from rclpy.qos import qos_profile_system_default
from rclpy.service_introspection import ServiceIntrospectionState
node = rclpy.create_node("server", namespace="/math")

def add(request, response):
    response.sum = request.a + request.b
    return response

node.create_service(AddTwoInts, "/add", add).configure_introspection(
    node.get_clock(), qos_profile_system_default, ServiceIntrospectionState.CONTENTS)
node.declare_parameter("rate", 2.0, ParameterDescriptor(
    description="how often", floating_point_range=[FloatingPointRange(from_value=0.5, to_value=10.0)]))
node.declare_parameter("names", ["a", "b"])
node.declare_parameter("deep.er.value", 3)

def allow(given):
    seven = any(each.value == 7.0 for each in given)
    return SetParametersResult(successful=not seven, reason="not seven" if seven else "")

node.add_on_set_parameters_callback(allow)
spin(node)
"""
NODE = "/math/server"
HOSTILE = """
node = rclpy.create_node("hostile")
node.declare_parameter("a[/]gain", "\\x1b]0;owned\\x07\\x1b[2J\\x9b2J")
spin(node)
"""


@pytest.fixture(scope="module")
def server_bench(module_bench: Bench) -> Iterator[Bench]:
    """A bench with the server on its domain, for tests that leave its parameters as they are."""
    with module_bench.node(SERVER):
        yield module_bench


def test_nodes_are_listed_and_described(server_bench: Bench) -> None:
    bench = server_bench
    with bench.node(TALKER):
        assert bench.ros2("node", "list") == Ran("/math/server\n/talker\n", "", 0)
        assert bench.ros2("node", "list", "-c").stdout == "2\n"
        info = bench.ros2("node", "info", NODE).stdout.splitlines()
        assert info[:3] == [NODE, "  Subscribers:", ""]
        assert "    /add: example_interfaces/srv/AddTwoInts" in info[info.index("  Service Servers:") :]
        assert info[-4:] == ["  Action Servers:", "", "  Action Clients:", ""]
        assert bench.ros2("node", "info", "/nope") == Ran("", "Unable to find node '/nope'\n", 1)


def test_duplicate_node_names_are_reported(bench: Bench) -> None:
    with bench.node(TALKER), bench.node(TALKER):
        listed = bench.ros2("node", "list")
        assert listed.stdout == "/talker\n/talker\n"
        assert listed.stderr.startswith("WARNING: Be aware that there are nodes in the graph that share an exact name")
        assert bench.ros2("node", "info", "/talker").stderr.startswith("There are 2 nodes in the graph")


def test_services_are_listed_and_called(server_bench: Bench) -> None:
    listed = server_bench.ros2("service", "list", "-t").stdout.splitlines()
    assert listed[0] == "/add [example_interfaces/srv/AddTwoInts]"
    assert server_bench.ros2("service", "type", "/add") == Ran("example_interfaces/srv/AddTwoInts\n", "", 0)
    assert server_bench.ros2("service", "find", "example_interfaces/srv/AddTwoInts").stdout == "/add\n"
    assert server_bench.ros2("service", "info", "/add").stdout == (
        "Type: example_interfaces/srv/AddTwoInts\nClients count: 0\nServices count: 1\n"
    )
    for form in ("example_interfaces/srv/AddTwoInts", "example_interfaces/AddTwoInts"):
        assert server_bench.ros2("service", "call", "/add", form, "{a: 10, b: 5}") == Ran(
            "waiting for service to become available...\n"
            "requester: making request: example_interfaces.srv.AddTwoInts_Request(a=10, b=5)\n\n"
            "response:\nexample_interfaces.srv.AddTwoInts_Response(sum=15)\n\n",
            "",
            0,
        )


def test_a_call_that_cannot_be_made_says_why(bench: Bench) -> None:
    call = ("service", "call", "/add")
    assert bench.ros2(*call, "AddTwoInts") == Ran("", "The passed service type is invalid\n", 1)
    assert bench.ros2(*call, "example_interfaces/srv/AddTwoInts", "{a: ten}") == Ran(
        "", "Failed to populate field: invalid literal for int() with base 10: 'ten'\n", 1
    )
    bad = bench.ros2(*call, "example_interfaces/srv/AddTwoInts", "{a: 10")
    assert (bad.stdout, bad.code, bad.stderr.count("\n")) == ("", 1, 1)
    assert "not YAML" in bad.stderr
    assert bench.ros2(*call, "std_msgs/msg/String") == Ran("", "The passed type is not a service\n", 1)
    with bench.running(*call, "example_interfaces/srv/AddTwoInts") as waiting:
        assert waiting.line() == "waiting for service to become available..."
        assert waiting.interrupt() == Ran("", "", 2)


def test_a_wait_for_a_service_says_what_is_missing(server_bench: Bench) -> None:
    with server_bench.running("service", "call", "/nope", "std_srvs/srv/Trigger") as waiting:
        assert waiting.error() == "no node offers /nope yet; Ctrl+C ends the wait"
    with server_bench.running("service", "call", "add", "std_srvs/Trigger") as waiting:
        assert waiting.error() == "/add is there, but its type is example_interfaces/srv/AddTwoInts"


def test_service_events_are_echoed(server_bench: Bench) -> None:
    bench = server_bench
    assert bench.ros2("service", "echo", "/nope") == Ran("", "Cannot find type for '/nope'\n", 1)
    assert bench.ros2("service", "echo", "/add", "nopkg/srv/X") == Ran(
        "", "The service type 'nopkg/srv/X' is invalid\n", 1
    )
    call = ("service", "call", "-r", "5", "/add", "example_interfaces/srv/AddTwoInts", "{a: 1, b: 2}")
    with bench.running(*call):
        with bench.running("service", "echo", "--csv", "/add") as heard:
            assert heard.line().split(",")[0] in ("1", "2")  # REQUEST_RECEIVED, RESPONSE_SENT
        with bench.running("service", "echo", "--flow-style", "/add") as heard:
            lines = [heard.line() for _ in range(30)]
    assert {"  event_type: REQUEST_RECEIVED", "request: [{a: 1, b: 2}]", "response: [{sum: 3}]"} <= set(lines)


def test_parameters_are_listed_read_and_described(server_bench: Bench) -> None:
    listed = server_bench.ros2("param", "list", NODE).stdout.split()
    assert listed[:3] == ["deep.er.value", "names", "rate"]
    assert server_bench.ros2("param", "list").stdout.startswith("/math/server:\n  deep.er.value\n")
    assert (
        server_bench.ros2("param", "list", "--filter", "ra.*", "--param-type", NODE).stdout == "  rate (type: double)\n"
    )
    assert server_bench.ros2("param", "get", NODE, "rate").stdout == "Double value is: 2.0\n"
    assert server_bench.ros2("param", "get", "math/server", "names").stdout == "String values are: ['a', 'b']\n"
    assert server_bench.ros2("param", "get", "--hide-type", NODE, "deep.er.value").stdout == "3\n"
    assert server_bench.ros2("param", "get", NODE, "nope") == Ran("", "Parameter not set\n", 1)
    assert server_bench.ros2("param", "describe", NODE, "rate").stdout == (
        "Parameter name: rate\n  Type: double\n  Description: how often\n  Constraints:\n"
        "    Min value: 0.5\n    Max value: 10.0\n"
    )
    for verb in (("list",), ("dump",), ("get", "x"), ("set", "x", "1")):
        assert server_bench.ros2("param", verb[0], "/nope", *verb[1:]) == Ran("", "Node not found\n", 1)


def test_parameters_are_set_dumped_and_loaded_and_refusals_go_to_stderr(bench: Bench) -> None:
    with bench.node(SERVER):
        assert bench.ros2("param", "set", NODE, "rate", "5.0") == Ran("Set parameter successful\n", "", 0)
        assert bench.ros2("param", "set", NODE, "rate", "7.0") == Ran("", "Setting parameter failed: not seven\n", 0)
        assert bench.ros2("param", "get", NODE, "rate").stdout == "Double value is: 5.0\n"
        refused = bench.ros2("param", "delete", NODE, "rate")
        assert refused.stderr.startswith("Deleting parameter failed: ")
        assert refused.code == 0
        dumped = bench.ros2("param", "dump", NODE).stdout
        assert "    deep:\n      er:\n        value: 3\n" in dumped
        assert "rate: 5.0" in dumped
        (bench.folder / "dump.yaml").write_text(dumped.replace("rate: 5.0", "rate: 4.0"))
        loaded = bench.ros2("param", "load", NODE, "dump.yaml")
        assert "Set parameter rate successful\n" in loaded.stdout
        assert bench.ros2("param", "get", NODE, "rate").stdout == "Double value is: 4.0\n"
        for name, text in (("empty", ""), ("list", "[1]"), ("bad", "{a: 1")):
            (bench.folder / f"{name}.yaml").write_text(text)
            wrong = bench.ros2("param", "load", NODE, f"{name}.yaml")
            assert (wrong.stdout, wrong.code, wrong.stderr.count("\n")) == ("", 1, 1), name
        assert bench.ros2("param", "load", NODE, "nope.yaml").code == 1


def test_action_verbs_without_any_actions(bench: Bench) -> None:
    assert bench.ros2("action", "list") == Ran("", "", 0)
    assert bench.ros2("action", "list", "-c").stdout == "0\n"
    assert bench.ros2("action", "type", "/x") == Ran("", "", 1)
    assert bench.ros2("action", "info", "/x").stdout == "Action: /x\nAction clients: 0\nAction servers: 0\n"
    bad = bench.ros2("action", "info", "bad name")
    assert bad.stderr.startswith("topic name 'bad name' is invalid: topic name must not contain characters other than")
    assert (bad.code, bench.ros2("action", "info", "~/x").code) == (1, 0)
    assert bench.ros2("action", "send_goal", "/x", "nopkg/action/X").stderr == "The passed action type is invalid\n"


def test_doctor_names_a_topic_without_subscribers(bench: Bench) -> None:
    with ordinary_domain() as domain:
        bench.env["ROS_DOMAIN_ID"] = str(domain)
        with bench.node(TALKER):
            ran = bench.ros2("doctor")
    assert ran == Ran(
        "UserWarning: Publisher without subscriber detected on /chatter.\n\nAll 3 checks passed\n\n", "", 0
    )


def test_escape_sequences_in_a_parameter_are_escaped_on_a_terminal_only(bench: Bench) -> None:
    words = ("param", "get", "--hide-type", "/hostile", "a[/]gain")
    with bench.node(HOSTILE):
        with terminal(command(*words), bench.env, bench.folder) as shown:
            assert shown.until("\n") == "\\x1b]0;owned\\x07\\x1b[2J\\x9b2J\r\n"
        assert bench.ros2(*words).stdout == "\x1b]0;owned\x07\x1b[2J\x9b2J\n"
