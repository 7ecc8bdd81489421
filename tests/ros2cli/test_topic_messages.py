"""ros2 topic echo and pub, between real nodes."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.ros2cli.bench import Bench, Ran, command
from tests.ros2cli.pseudo_terminal import terminal

LISTENER = """
from std_msgs.msg import String
node = rclpy.create_node("listener")
node.create_subscription(String, "chatter", lambda message: print(message.data, flush=True), 10)
spin(node)
"""
PUBLISHERS = """
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import LaserScan
from std_msgs.msg import String

node = rclpy.create_node("publishers")
chatter = node.create_publisher(String, "chatter", 10)
escapes = node.create_publisher(String, "escapes", 10)
scan = node.create_publisher(LaserScan, "scan", 10)
node.create_publisher(String, "mixed", 10)
mixed = node.create_publisher(String, "mixed", QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT))
latched = node.create_publisher(String, "map", QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL))
latched.publish(String(data="kept"))

laser = LaserScan(ranges=[0.5] * 3)
laser.header.frame_id = "laser"
count = 0

def publish():
    global count
    count += 1
    chatter.publish(String(data=f"Hello World: {count}"))
    escapes.publish(String(data="\\x1b[2Jred"))
    mixed.publish(String(data="hi"))
    scan.publish(laser)

node.create_timer(0.05, publish)
spin(node)
"""


@pytest.fixture(scope="module")
def echo_bench(module_bench: Bench) -> Iterator[Bench]:
    """A bench with something to echo on its domain."""
    with module_bench.node(PUBLISHERS):
        yield module_bench


def test_echo_runs_until_ctrl_c(echo_bench: Bench) -> None:
    with echo_bench.running("topic", "echo", "/chatter") as echo:
        lines = [echo.line() for _ in range(6)]
        ran = echo.interrupt()
    number = int(lines[0].removeprefix("data: 'Hello World: ").removesuffix("'"))
    expected = [line for n in range(3) for line in (f"data: 'Hello World: {number + n}'", "---")]
    assert lines == expected
    assert (ran.stderr, ran.code) == ("", 2)


def test_echo_once_with_each_option(echo_bench: Bench) -> None:
    whole = echo_bench.ros2("topic", "echo", "--once", "/scan")
    assert whole.code == 0
    assert "header:\n  stamp:\n    sec: 0\n    nanosec: 0\n  frame_id: laser\n" in whole.stdout
    assert "ranges:\n- 0.5\n- 0.5\n- 0.5\nintensities: []\n---\n" in whole.stdout
    forms: dict[tuple[str, ...], tuple[str, ...]] = {
        ("--flow-style",): ("ranges: [0.5, 0.5, 0.5]\nintensities: []\n---\n",),
        ("-l", "2", "-i"): ("frame_id: la...\n", "reception_sequence_number: null\nsource_timestamp: "),
        ("--no-arr", "--no-str"): (
            "ranges: '<sequence type: float, length: 3>'\n",
            "frame_id: '<string length: <5>>'\n",
        ),
        ("--field", "header.frame_id"): ("laser\n---\n",),
        ("--field", "header"): ("stamp:\n  sec: 0\n  nanosec: 0\nframe_id: laser\n---\n",),
        ("--csv",): ("0,0,laser,0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.5,0.5,0.5,\n",),
        ("--raw",): ("b'\\x00\\x01",),
    }
    for options, expected in forms.items():
        shown = echo_bench.ros2("topic", "echo", "--once", "scan", *options).stdout
        assert all(text in shown for text in expected), (options, shown)


def test_echo_filters(echo_bench: Bench) -> None:
    some = echo_bench.ros2("topic", "echo", "--once", "--filter", "m.data.endswith('0')", "/chatter")
    assert some.stdout.endswith("0'\n---\n")
    wrong = echo_bench.ros2("topic", "echo", "--filter", "m.dat > 1", "/chatter")
    assert (
        wrong.stderr
        == ("--filter m.dat > 1: AttributeError: 'String' object has no attribute 'dat'. Did you mean: 'data'?\n")
        or wrong.stderr == "--filter m.dat > 1: AttributeError: 'String' object has no attribute 'dat'\n"
    )
    assert wrong.code == 1


def test_echo_adapts_its_qos_to_the_publishers(echo_bench: Bench) -> None:
    assert echo_bench.ros2("topic", "echo", "--once", "/map") == Ran("data: kept\n---\n", "", 0)
    ran = echo_bench.ros2("topic", "echo", "--once", "/mixed")
    assert ran.stdout == (
        "Some, but not all, publishers are offering QoSReliabilityPolicy.RELIABLE. Falling back to "
        "QoSReliabilityPolicy.BEST_EFFORT as it will connect to all publishers\ndata: hi\n---\n"
    )


def test_echo_warns_of_incompatible_qos(echo_bench: Bench) -> None:
    words = ["topic", "echo", "--qos-durability", "transient_local", "--once", "--timeout", "2", "/chatter"]
    ran = echo_bench.ros2(*words)
    assert "offering incompatible QoS. No messages will be received from it" in ran.stderr
    assert (ran.stdout, ran.code) == ("", 0)


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (
            ["/nothing"],
            Ran(
                "WARNING: topic [/nothing] does not appear to be published yet\n",
                "Could not determine the type for the passed topic\n",
                1,
            ),
        ),
        (["/nothing", "std_msgs/msg/Nope"], Ran("", "The passed message type is invalid\n", 1)),
        (["/nothing", "Strin"], Ran("", "The passed message type is invalid\n", 1)),
        (["/nothing", "nopkg/msg/String"], Ran("", "The passed message type is invalid\n", 1)),
        (["--once", "--timeout", "0.5", "/nothing", "std_msgs/msg/String"], Ran("", "", 0)),
        (["--field", ".", "/nothing"], Ran("", "Invalid field value '.'\n", 1)),
    ],
)
def test_errors_of_echo(bench: Bench, words: list[str], expected: Ran) -> None:
    assert bench.ros2("topic", "echo", *words) == expected


def test_escape_sequences_in_a_message_are_escaped_on_a_terminal_only(echo_bench: Bench) -> None:
    words = ["topic", "echo", "--once", "--field", "data", "/escapes"]
    with terminal(command(*words), echo_bench.env, echo_bench.folder) as echo:
        assert "\x1b" not in echo.until("---")
    assert echo_bench.ros2(*words).stdout == "\x1b[2Jred\n---\n"


def test_a_bad_topic_name_is_reported_without_a_traceback(bench: Bench) -> None:
    for words in (["echo", "bad name"], ["pub", "bad name"]):
        ran = bench.ros2("topic", *words, "std_msgs/msg/String")
        assert "Traceback" not in ran.stderr
        assert "bad name" in ran.stderr
        assert ran.code == 1


def test_pub_once_waits_for_a_subscription_and_without_a_count_pub_runs_until_ctrl_c(bench: Bench) -> None:
    with bench.node(LISTENER) as listener:
        ran = bench.ros2("topic", "pub", "--once", "/chatter", "std_msgs/msg/String", "{data: hi}")
        assert listener.line() == "hi"
        assert ran.stdout == "publisher: beginning loop\npublishing #1: std_msgs.msg.String(data='hi')\n\n"
        assert (ran.stderr, ran.code) == ("", 0)
        words = ["topic", "pub", "-t", "3", "-r", "20", "-p", "2", "/chatter", "std_msgs/String", "--stdin"]
        ran = bench.ros2(*words, stdin="data: there\n")
        assert [listener.line() for _ in range(3)] == ["there"] * 3
        assert ran.stdout.endswith("loop\npublishing #2: std_msgs.msg.String(data='there')\n\n")
        with bench.running("topic", "pub", "-r", "20", "/chatter", "std_msgs/msg/String", "data: 5") as pub:
            assert listener.line() == "5"
            ran = pub.interrupt()
        assert (ran.stderr, ran.code) == ("", 2)


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (["std_msgs/msg/Int32", "data: 1.5"], "publishing #1: std_msgs.msg.Int32(data=1)\n\n"),
        (["std_msgs/msg/String"], "publishing #1: std_msgs.msg.String(data='')\n\n"),
        (
            ["geometry_msgs/msg/Twist", "{linear: {x: 2.0}, angular: {z: 1.8}}"],
            "publishing #1: geometry_msgs.msg.Twist(linear=geometry_msgs.msg.Vector3(x=2.0, y=0.0, z=0.0), "
            "angular=geometry_msgs.msg.Vector3(x=0.0, y=0.0, z=1.8))\n\n",
        ),
        (
            ["diagnostic_msgs/msg/DiagnosticArray", "{status: [{name: motor, values: [{key: a, value: 1}]}]}"],
            "status=[diagnostic_msgs.msg.DiagnosticStatus(level=b'\\x00', name='motor', message='', "
            "hardware_id='', values=[diagnostic_msgs.msg.KeyValue(key='a', value='1')])])\n\n",
        ),
    ],
)
def test_pub_converts_values_to_the_types_of_the_fields(bench: Bench, words: list[str], expected: str) -> None:
    ran = bench.ros2("topic", "pub", "--once", "-w", "0", "/t", *words)
    assert ran.stdout.startswith("publisher: beginning loop\n")
    assert ran.stdout.endswith(expected)
    assert (ran.stderr, ran.code) == ("", 0)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["std_msgs/msg/String", "{dat: hi}"], "Failed to populate field: 'String' object has no attribute 'dat'"),
        (["std_msgs/msg/String", "{data: 'hi"], "The passed value needs to be in YAML string or a dictionary"),
        (["std_msgs/msg/String", "hello"], "The passed value needs to be a dictionary in YAML format"),
        (["std_msgs/msg/Strin", "data: hi"], "The passed message type is invalid"),
        (["String", "data: hi"], "The passed message type is invalid"),
        (
            ["-w", "2", "--max-wait-time-secs", "0.1", "std_msgs/msg/String"],
            "Timed out waiting for subscribers: Expected 2 subcribers but only got 0 subscribers",
        ),
    ],
)
def test_errors_of_pub(bench: Bench, words: list[str], message: str) -> None:
    ran = bench.ros2("topic", "pub", "/t", *words)
    assert ran.stderr == f"{message}\n"
    assert ran.code == 1


def test_pub_with_a_rate_of_zero_is_a_usage_error(bench: Bench) -> None:
    ran = bench.ros2("topic", "pub", "-r", "0", "/t", "std_msgs/msg/Bool", "data: true")
    assert ran.stderr == (
        "usage: ros2 topic pub [-h] [--stdin] [-r N] [-p N] [-1 | -t TIMES]\n"
        "                      [-w WAIT_MATCHING_SUBSCRIPTIONS]\n"
        "                      [--max-wait-time-secs MAX_WAIT_TIME_SECS]\n"
        "                      [--keep-alive N] [-n NODE_NAME]\n"
        "                      [--qos-profile {unknown,default,system_default,sensor_data,services_default,"
        "parameters,parameter_events,action_status_default,best_available}]\n"
        "                      [--qos-depth N]\n"
        "                      [--qos-history {system_default,keep_last,keep_all,unknown}]\n"
        "                      [--qos-reliability {system_default,reliable,best_effort,unknown,best_available}]\n"
        "                      [--qos-durability {system_default,transient_local,volatile,unknown,best_available}]\n"
        "                      [--qos-liveliness {system_default,automatic,manual_by_topic,unknown,best_available}]\n"
        "                      [--qos-liveliness-lease-duration-seconds QOS_LIVELINESS_LEASE_DURATION_SECONDS]\n"
        "                      [--spin-time SPIN_TIME] [-s]\n"
        "                      topic_name message_type [values]\n"
        "ros2 topic pub: error: argument -r/--rate: Value must be positive\n"
    )
    assert ran.code == 2
