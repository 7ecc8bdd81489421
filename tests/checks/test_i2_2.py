"""I2.2: verdicts on fabricated launches."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import pytest

from checks.i2_2 import CHECK, facts, judges
from checks.i2_2.facts import LaunchRun
from tests.checks import builders
from tests.checks.builders import FOLDER, START, assert_passed, ending, exited, explained, lines
from tutor.errors import NeedsInstalledRos
from tutor.judge import launch_output
from tutor.judge.trace import LogRecord, Sample, Trace
from tutor.judge.verdict import Status
from tutor.ros_model import Graph, QoS, ServiceEndpoint, TopicEndpoint

assert_failed = partial(builders.assert_failed, check=CHECK)

STRING = "std_msgs/msg/String"
TALKER, LISTENER = "/talker", "/listener"


def endpoint(
    topic: str, node: str, *, type: str = STRING, reliability: str = "reliable", durability: str = "volatile"
) -> TopicEndpoint:
    return TopicEndpoint(topic, type, node, QoS(reliability, durability))


def graph(
    publishers: Sequence[TopicEndpoint], subscriptions: Sequence[TopicEndpoint], more: Sequence[str] = ()
) -> Graph:
    """A graph of these endpoints, in which each node has its parameter services."""
    nodes = sorted({each.node for each in (*publishers, *subscriptions)} | set(more))
    servers = tuple(
        ServiceEndpoint(f"{node}/list_parameters", "rcl_interfaces/srv/ListParameters", node) for node in nodes
    )
    return Graph(tuple(nodes), tuple(publishers), tuple(subscriptions), servers)


def pair(topic: str, other: str | None = None, *, namespace: str = "") -> Graph:
    """A talker and a listener, which subscribes to `other` if given."""
    return graph([endpoint(topic, namespace + TALKER)], [endpoint(other or topic, namespace + LISTENER)])


def launched(
    seen: Graph, *, out: str = "", command_lines: Sequence[str] = (), messages: int = 2, **more: Any
) -> LaunchRun:
    """A launch with this graph, and with messages on each topic that has a publisher."""
    arguments = more.pop("arguments", {})
    topics = {each.topic for each in seen.publishers}
    samples = {
        topic: tuple(
            Sample(topic, {"data": f"Hello World: {n}"}, START + n, START + n + 0.001) for n in range(messages)
        )
        for topic in topics
    }
    trace = Trace(
        file="my_launch.py",
        folder=FOLDER,
        graph=seen,
        samples=samples,
        output=lines(out, "stdout"),
        exit=more.pop("exit", None),
        logs=more.pop("logs", ()),
        launch_arguments=more.pop("declares", ("topic", "namespace")),
    )
    more.setdefault("answering", frozenset(seen.nodes))
    return LaunchRun(trace, arguments, tuple(command_lines), **more)


DEFAULT_RUN = launched(pair("/chatter"))


def with_topic(seen: Graph, **more: Any) -> LaunchRun:
    return launched(seen, arguments={"topic": "news"}, **more)


def in_robot1(seen: Graph, **more: Any) -> LaunchRun:
    return launched(seen, arguments={"namespace": "robot1"}, **more)


def with_both(seen: Graph, **more: Any) -> LaunchRun:
    return launched(seen, arguments={"topic": "news", "namespace": "robot1"}, **more)


# --- starts ---


def test_a_talker_and_a_listener_pass() -> None:
    assert_passed(judges.judge_starts(DEFAULT_RUN))


def test_nodes_on_any_topics_pass() -> None:
    assert_passed(judges.judge_starts(launched(pair("/chatter", "/chater"))))


def test_a_node_whose_namespace_begins_with_an_underscore_counts() -> None:
    seen = graph([endpoint("/chatter", TALKER)], [endpoint("/_opr/chatter", "/_opr/listener")])
    assert_passed(judges.judge_starts(launched(seen)))


def test_subscriptions_of_ros_itself_do_not_make_a_subscriber() -> None:
    seen = graph(
        [endpoint("/chatter", TALKER)],
        [endpoint(topic, LISTENER) for topic in ("/clock", "/parameter_events", "/fibonacci/_action/feedback")],
    )
    assert_failed(judges.judge_starts(launched(seen)), "one side missing", TALKER)


def test_one_node_is_not_two() -> None:
    seen = graph([endpoint("/chatter", "/both")], [endpoint("/chatter", "/both")])
    assert_failed(judges.judge_starts(launched(seen)), "one side missing")


def test_two_nodes_of_the_same_name_are_two() -> None:
    seen = Graph(("/both", "/both"), (endpoint("/chatter", "/both"),), (endpoint("/chatter", "/both"),))
    assert_passed(judges.judge_starts(launched(seen)))


ERROR = "[ERROR] [launch]: Caught exception in launch (see debug for traceback): "
LOADING = f"{ERROR}Caught multiple exceptions when trying to load file of format [py]:\n"
ONE = LOADING.replace("multiple exceptions", "exception")
FORMAT = " - InvalidFrontendLaunchFileError: The launch file may have a syntax error, or its format is unknown"
UNCLOSED, NULL_BYTE = "import launch\n\n\nlaunch.main(\n", "import launch\n\n\n\0launch.main()\n"
OWN_LINE = f"""\
Traceback (most recent call last):
  File "{FOLDER}/my_launch.py", line 9, in generate_launch_description
    LogInfo(msg='x'),
NameError: name 'LogInfo' is not defined"""
DEAD = f"""\
[hearer-2] Traceback (most recent call last):
[hearer-2]   File "{FOLDER}/hearer.py", line 7, in main
[hearer-2]     nothing()
[hearer-2] NameError: name 'nothing' is not defined
[ERROR] [hearer-2]: process has died [pid 12, exit code 1, cmd '/x/hearer --ros-args']."""


@pytest.mark.parametrize(
    ("out", "cause", "words"),
    [
        (f"{ERROR}\"package 'demo' not found, searching: ['/opt/ros/jazzy']\"", "package not found", "demo"),
        (f"{ERROR}executable 'talk' not found on the libexec directory '/x'", "executable not found", "'talk'"),
        (f"{LOADING} - NameError: name 'LogInfo' is not defined\n{OWN_LINE}", "unhandled exception", "line 9"),
        (
            f"{LOADING} - InvalidPythonLaunchFileError: launch file at 'x' does not contain the required function "
            "'generate_launch_description()'",
            "no generate_launch_description",
            "function",
        ),
        (f"{ERROR}'NoneType' object has no attribute 'entities'", "nothing returned", "LaunchDescription"),
        (f"{ERROR}something else", "error in the launch", "something else"),
        (DEAD, "unhandled exception", "hearer.py, line 7"),
        ("", "nothing to launch", "LaunchDescription"),
    ],
)
def test_causes_of_a_launch_that_starts_nothing(out: str, cause: str, words: str) -> None:
    seen = launched(Graph(), out=out, exit=exited(1, after_s=0.4))
    assert_failed(judges.judge_starts(seen), cause, words)


@pytest.mark.parametrize(
    ("out", "source", "cause", "words"),
    [
        (f"{LOADING} - SyntaxError: '(' was never closed (my_launch.py, line 4)", UNCLOSED, "syntax error", "main()"),
        (f"{LOADING} - IndentationError: unexpected indent (my_launch.py, line 4)", "", "syntax error", "line 4"),
        (
            f"{ONE} - SyntaxError: source code string cannot contain null bytes",
            NULL_BYTE,
            "syntax error",
            "line 4",
        ),
        (f"{LOADING} - ValueError: not yet", "", "unhandled exception", "ValueError: not yet"),
    ],
)
def test_causes_without_the_traceback_that_an_installed_ros_omits(
    out: str, source: str, cause: str, words: str
) -> None:
    seen = launched(Graph(), out=f"{out}\n{FORMAT}", exit=exited(1, after_s=0.4))
    seen = replace(seen, trace=replace(seen.trace, sources={"my_launch.py": source}))
    assert_failed(judges.judge_starts(seen), cause, words)


def test_a_traceback_is_read_from_interleaved_streams() -> None:
    mixed = lines(f'  File "{FOLDER}/my_launch.py", line 3\n    ])\n    ^')
    mixed += lines(" - InvalidFrontendLaunchFileError: The launch file may have a syntax error", "stdout")
    mixed += lines("SyntaxError: closing parenthesis ']' does not match")
    trace = Trace("my_launch.py", FOLDER, output=(*lines(LOADING, "stdout"), *mixed), exit=exited(1))
    assert_failed(judges.judge_starts(LaunchRun(trace)), "syntax error", "line 3")


def test_a_command_that_needs_an_installed_ros_is_not_the_learners_fault() -> None:
    says = "[ros2-1] ros2: `ros2 topic` needs an installed ROS 2; this ros2 knows: launch, run"
    out = f"{says}\n[ERROR] [ros2-1]: process has died [pid 12, exit code 2, cmd 'ros2 topic pub /chatter']"
    with pytest.raises(NeedsInstalledRos, match="ros2 topic"):
        judges.judge_starts(launched(Graph(nodes=(LISTENER,)), out=out))


def test_a_default_that_is_no_valid_name() -> None:
    raised = (
        "rclpy._rclpy_pybind11.RCLError: failed to initialize rcl: Couldn't parse remap rule: '-r chatter:=my-topic'."
    )
    seen = launched(Graph(), out=f"[talker-1] {raised}")
    assert_failed(judges.judge_starts(seen), "invalid name", "my-topic", "digits")


def test_a_substitution_in_an_f_string() -> None:
    broken = (
        "[talker-1] Couldn't parse remap rule: '-r chatter:=<launch.substitutions.launch_configuration.LaunchConfig"
    )
    out = f"{broken}uration object at 0x7f1>'\n{DEAD.replace('hearer-2', 'talker-1')}"
    assert_failed(
        judges.judge_starts(launched(Graph(), out=out)), "substitution made text too early", "before its value is known"
    )


def test_an_action_that_needs_an_installed_ros_is_not_the_learners_fault() -> None:
    says = "launch_ros.actions.LifecycleNode is not supported by the launch files that run without an installed ROS 2"
    broken = launched(Graph(), out=f"{ERROR}{says}; it works where ROS 2 is installed and sourced", exit=exited(1))
    with pytest.raises(NeedsInstalledRos, match=r"^launch_ros\.actions\.LifecycleNode is not supported"):
        judges.judge_starts(broken)


# --- topic ---


def test_topic_passes_if_both_nodes_use_it() -> None:
    assert_passed(judges.judge_topic(DEFAULT_RUN, with_topic(pair("/news"))))


def test_other_topics_may_stay_the_same() -> None:
    extra_publisher, extra_subscription = endpoint("/beat", "/heart"), endpoint("/beat", "/watchdog")
    default_run = graph(
        [endpoint("/chatter", TALKER), extra_publisher], [endpoint("/chatter", LISTENER), extra_subscription]
    )
    seen = graph([endpoint("/news", TALKER), extra_publisher], [endpoint("/news", LISTENER), extra_subscription])
    assert_passed(judges.judge_topic(launched(default_run), with_topic(seen)))


def test_the_default_topic_must_not_be_used_any_more() -> None:
    seen = graph([endpoint("/news", TALKER), endpoint("/chatter", TALKER)], [endpoint("/news", LISTENER)])
    assert_failed(judges.judge_topic(DEFAULT_RUN, with_topic(seen)), "default topic still used", TALKER, "/chatter")


def test_a_node_that_drops_its_ros_arguments_is_blamed() -> None:
    program = "def main():\n    rclpy.init(args=remove_ros_args(sys.argv))\n    rclpy.spin(Node('ear'))\n"
    for verdict in (
        judges.judge_topic(DEFAULT_RUN, with_program(with_topic(pair("/news", "/chatter")), program)),
        judges.judge_topic(DEFAULT_RUN, with_program(with_topic(pair("/chatter")), program)),
    ):
        assert_failed(verdict, "arguments left out", "ear.py, line 2")


def test_a_namespace_of_its_own_is_named() -> None:
    seen = graph([endpoint("/news", TALKER)], [endpoint("/opr/news", "/opr/listener")])
    assert_failed(judges.judge_topic(DEFAULT_RUN, with_topic(seen)), "namespace of its own", "/opr/listener")


def with_program(seen: LaunchRun, program: str) -> LaunchRun:
    """The launch, with a program of the learner's beside the launch file."""
    sources = {"my_launch.py": "def generate_launch_description(): ...", "ear.py": program}
    return replace(seen, trace=replace(seen.trace, sources=sources))


@pytest.mark.parametrize(("more", "is_named"), [("", True), (", condition=IfCondition(plain)", False)])
def test_a_launch_file_that_sets_the_argument_itself(more: str, is_named: bool) -> None:
    line = f"SetLaunchConfiguration('topic', 'chatter'{more}),"
    source = f"description = LaunchDescription([\n    talker,\n    {line}\n])\n"
    seen = with_topic(pair("/news", "/chatter"))
    seen = replace(seen, trace=replace(seen.trace, sources={"my_launch.py": source}))
    verdict = judges.judge_topic(DEFAULT_RUN, seen)
    assert ("argument overwritten" in explained(verdict, CHECK).cause) is is_named


@pytest.mark.parametrize(
    ("more", "read", "is_named"),
    [("", "target", True), (", scoped=False", "target", False), ("", "other", False)],
)
def test_a_setting_that_a_group_takes_back(more: str, read: str, is_named: bool) -> None:
    group = f"GroupAction([SetLaunchConfiguration('target', topic)]{more})"
    source = f"description = LaunchDescription([\n    {group},\n    talker(LaunchConfiguration('{read}')),\n])\n"
    seen = with_topic(pair("/chatter", "/chatter"))
    seen = replace(seen, trace=replace(seen.trace, sources={"my_launch.py": source}))
    verdict = judges.judge_topic(DEFAULT_RUN, seen)
    assert ("setting lost with its group" in explained(verdict, CHECK).cause) is is_named


@pytest.mark.parametrize(("sent", "taken"), [("/news", "/chatter"), ("/chatter", "/news")])
def test_one_node_is_not_remapped(sent: str, taken: str) -> None:
    command_lines = ["talker --ros-args -r chatter:=news", "listener --ros-args"]
    verdict = judges.judge_topic(DEFAULT_RUN, with_topic(pair(sent, taken), command_lines=command_lines))
    assert_failed(verdict, "only one node is renamed", "/chatter")


def test_a_suffix_is_added_to_the_topic() -> None:
    seen = with_topic(pair("/news_data"), command_lines=["talker --ros-args -r chatter:=news_data"])
    assert_failed(judges.judge_topic(DEFAULT_RUN, seen), "wrong topic", "/news_data", "added")


@pytest.mark.parametrize(
    ("command_lines", "declares", "cause"),
    [
        (["talker --ros-args -r chatter:=chatter"], ("topik", "namespace"), "no such launch argument"),
        (["talker --ros-args"], ("namespace",), "no such launch argument"),
        (["talker --ros-args -r chatter:=my_topic"], ("topic",), "argument without effect"),
        (["talker --ros-args -r topic:=news"], ("topic",), "remapping without effect"),
        (["talker --ros-args -r news:=chatter"], ("topic",), "remapping the wrong way round"),
        (["talker --ros-args -r chatter:=x -r chatter:=news"], ("topic",), "remapping without effect"),
    ],
)
def test_causes_of_a_topic_that_no_node_uses(command_lines: list[str], declares: tuple[str, ...], cause: str) -> None:
    seen = with_topic(
        pair("/chatter"), command_lines=["ros2 launch my_launch.py topic:=news", *command_lines], declares=declares
    )
    assert_failed(judges.judge_topic(DEFAULT_RUN, seen), cause)


def test_a_remapping_of_another_node_does_not_show_that_the_name_is_unused() -> None:
    swapped = pair("/news")
    swapped = replace(swapped, subscriptions=(replace(swapped.subscriptions[0], topic="/news/bot"),))
    seen = with_topic(swapped, command_lines=["talker -r chatter:=news", "listener -r __ns:=/news -r chatter:=bot"])
    assert_failed(judges.judge_topic(DEFAULT_RUN, seen), "only one node is renamed")


def test_a_crash_that_only_the_argument_causes_is_reported() -> None:
    seen = with_topic(Graph(), out=f"{ERROR}'NoneType' object has no attribute 'x'\n{OWN_LINE}", exit=exited(1))
    assert_failed(judges.judge_topic(DEFAULT_RUN, seen), "unhandled exception", "line 9")


def test_no_messages_on_the_topic() -> None:
    assert_failed(
        judges.judge_topic(DEFAULT_RUN, with_topic(pair("/news"), messages=0)), "wrong names", "nothing is sent"
    )


def test_a_publisher_that_never_publishes_is_not_blamed_here() -> None:
    assert_passed(judges.judge_topic(launched(pair("/chatter"), messages=0), with_topic(pair("/news"), messages=0)))


def test_messages_of_a_type_that_we_cannot_subscribe_to_count_as_sent() -> None:
    seen = with_topic(pair("/news"), messages=0, hidden=frozenset({"/news"}))
    assert_passed(judges.judge_topic(DEFAULT_RUN, seen))


# --- namespace ---

OTHER_TOPIC = with_topic(pair("/news"))
NAMESPACED = in_robot1(pair("/robot1/chatter", namespace="/robot1"))
BOTH = with_both(pair("/robot1/news", namespace="/robot1"))


def test_namespace_passes_if_everything_is_under_it() -> None:
    assert_passed(judges.judge_namespace(DEFAULT_RUN, OTHER_TOPIC, NAMESPACED, BOTH))


def test_a_nested_namespace_passes() -> None:
    namespaced = in_robot1(pair("/robot1/arm/chatter", namespace="/robot1/arm"))
    assert_passed(judges.judge_namespace(DEFAULT_RUN, OTHER_TOPIC, namespaced, BOTH))


def test_the_namespace_is_applied_twice() -> None:
    namespaced = in_robot1(pair("/robot1/robot1/chatter", namespace="/robot1/robot1"))
    both = with_both(pair("/robot1/robot1/news", namespace="/robot1/robot1"))
    assert_failed(
        judges.judge_namespace(DEFAULT_RUN, OTHER_TOPIC, namespaced, both), "namespace applied twice", "/robot1/robot1"
    )
    topic_only = with_both(pair("/robot1/robot1/news", namespace="/robot1"))
    assert_failed(judges.judge_namespace(DEFAULT_RUN, OTHER_TOPIC, NAMESPACED, topic_only), "namespace applied twice")


def test_one_node_has_no_namespace() -> None:
    seen = graph([endpoint("/robot1/chatter", "/robot1/talker")], [endpoint("/chatter", LISTENER)])
    assert_failed(
        judges.judge_namespace(DEFAULT_RUN, OTHER_TOPIC, in_robot1(seen), BOTH),
        "only one node is renamed",
        LISTENER,
    )


def test_no_node_has_the_namespace() -> None:
    seen = in_robot1(pair("/chatter"), command_lines=["talker --ros-args"])
    assert_failed(judges.judge_namespace(DEFAULT_RUN, OTHER_TOPIC, seen, BOTH), "argument without effect")


def test_the_namespace_argument_has_the_wrong_name() -> None:
    seen = in_robot1(pair("/chatter"), command_lines=["talker --ros-args"], declares=("topic", "ns"))
    assert_failed(judges.judge_namespace(DEFAULT_RUN, OTHER_TOPIC, seen, BOTH), "no such launch argument", "ns")


def test_a_name_that_starts_with_the_namespace_is_not_under_it() -> None:
    seen = in_robot1(pair("/robot1chatter", namespace="/robot1x"), command_lines=["talker -r __node:=robot1x"])
    assert_failed(judges.judge_namespace(DEFAULT_RUN, OTHER_TOPIC, seen, BOTH), "wrong names")


def test_an_absolute_topic_is_outside_the_namespace() -> None:
    seen = in_robot1(pair("/chatter", namespace="/robot1"), command_lines=["talker --ros-args -r chatter:=/chatter"])
    assert_failed(judges.judge_namespace(DEFAULT_RUN, OTHER_TOPIC, seen, BOTH), "absolute topic", "/chatter")


def test_a_remapping_from_an_absolute_name_fails_in_a_namespace() -> None:
    both = with_both(
        pair("/robot1/chatter", namespace="/robot1"), command_lines=["talker -r __ns:=/robot1 -r /chatter:=news"]
    )
    assert_failed(
        judges.judge_namespace(DEFAULT_RUN, OTHER_TOPIC, NAMESPACED, both), "remapping without effect", "/chatter"
    )


def test_a_topic_argument_that_is_never_used_is_left_to_the_topic_criterion() -> None:
    both = with_both(pair("/robot1/chatter", namespace="/robot1"))
    assert_passed(judges.judge_namespace(DEFAULT_RUN, with_topic(pair("/chatter")), NAMESPACED, both))


def test_unconnected_nodes_may_pass_in_a_namespace() -> None:
    default_run, namespaced = launched(pair("/a", "/b")), in_robot1(pair("/robot1/a", "/robot1/b", namespace="/robot1"))
    assert_passed(judges.judge_namespace(default_run, OTHER_TOPIC, namespaced, BOTH))


# --- communicates ---


def log_record(text: str, name: str = "listener") -> LogRecord:
    return LogRecord(20, name, text, START + 1.5, START + 1.5)


@pytest.mark.parametrize("home", ["/demo", "/robot1"])
def test_the_default_namespace_need_not_be_empty(home: str) -> None:
    default_run, other_topic = (
        launched(pair(f"{home}/chatter", namespace=home)),
        with_topic(pair(f"{home}/news", namespace=home)),
    )
    another = launched(pair("/robot2/chatter", namespace="/robot2"), arguments={"namespace": "robot2"})
    assert_passed(judges.judge_topic(default_run, other_topic))
    assert_passed(
        judges.judge_namespace(default_run, other_topic, NAMESPACED, BOTH, another if home == "/robot1" else None)
    )


@pytest.mark.parametrize("home", ["/demo", "/robot1"])
def test_a_namespace_that_never_changes_fails(home: str) -> None:
    default_run, other_topic = (
        launched(pair(f"{home}/chatter", namespace=home)),
        with_topic(pair(f"{home}/news", namespace=home)),
    )
    namespaced = in_robot1(pair(f"{home}/chatter", namespace=home))
    another = launched(pair(f"{home}/chatter", namespace=home), arguments={"namespace": "robot2"})
    verdict = judges.judge_namespace(default_run, other_topic, namespaced, BOTH, another if home == "/robot1" else None)
    assert_failed(verdict, "argument without effect")


def test_a_topic_that_only_one_node_uses_in_a_default_namespace_fails() -> None:
    default_run = launched(pair("/demo/chatter", namespace="/demo"))
    seen = with_topic(pair("/demo/news", "/demo/chatter", namespace="/demo"))
    assert_failed(judges.judge_topic(default_run, seen), "only one node is renamed")


def test_a_logged_message_is_evidence() -> None:
    seen = launched(pair("/chatter"), logs=(log_record("I heard: [Hello World: 1]"),))
    verdict = judges.judge_communicates(seen)
    assert_passed(verdict)
    assert any("I heard" in line for line in verdict.evidence)


def test_a_subscriber_that_logs_nothing_passes_if_it_spins() -> None:
    assert_passed(judges.judge_communicates(DEFAULT_RUN))
    assert_failed(
        judges.judge_communicates(launched(pair("/chatter"), answering=frozenset({TALKER}))), "not connected", LISTENER
    )


def test_a_subscriber_that_answers_no_calls_passes_if_it_logs() -> None:
    seen = launched(pair("/chatter"), answering=frozenset(), logs=(log_record("Hello World: 0"),))
    assert_passed(judges.judge_communicates(seen))


@pytest.mark.parametrize(
    ("logged", "proves"),
    [
        (("got 0", "got 1"), True),
        (("got 0", "still 0"), False),  # any message may contain a number
        (("waiting 1.0 s",), False),
        (("10 and 11",), False),
    ],
)
def test_which_logged_numbers_prove_communication(logged: Sequence[str], proves: bool) -> None:
    samples = [Sample("/chatter", {"data": number}, START + number / 10, START) for number in range(2)]
    found = facts.logs_of_messages(facts.pairs(pair("/chatter"))[0], [log_record(text) for text in logged], samples)
    assert bool(found) == proves


@pytest.mark.parametrize(
    ("said", "proves"), [("HELLO WORLD: 1!", True), ("Hello World: 11", False), ("Hello World: 1.", True)]
)
def test_which_logged_texts_prove_communication(said: str, proves: bool) -> None:
    samples = [Sample("/chatter", {"data": "Hello World: 1"}, START, START)]
    assert bool(facts.logs_of_messages(facts.pairs(pair("/chatter"))[0], [log_record(said)], samples)) == proves


def test_a_log_of_another_node_is_no_proof() -> None:
    seen = launched(pair("/chatter"), answering=frozenset(), logs=(log_record("Hello World: 0", "talker"),))
    assert_failed(judges.judge_communicates(seen), "not connected")


@pytest.mark.parametrize(
    ("publisher", "subscription", "cause"),
    [
        (endpoint("/chatter", TALKER, reliability="best_effort"), endpoint("/chatter", LISTENER), "incompatible QoS"),
        (
            endpoint("/chatter", TALKER),
            endpoint("/chatter", LISTENER, durability="transient_local"),
            "incompatible QoS",
        ),
        (endpoint("/chatter", TALKER), endpoint("/chatter", LISTENER, type="std_msgs/msg/Int32"), "not connected"),
        (endpoint("/chatter", TALKER), endpoint("/chater", LISTENER), "wrong topic"),
    ],
)
def test_causes_of_messages_that_do_not_arrive(
    publisher: TopicEndpoint, subscription: TopicEndpoint, cause: str
) -> None:
    seen = launched(graph([publisher], [subscription]), logs=(log_record("I heard: [Hello World: 1]"),))
    assert_failed(judges.judge_communicates(seen), cause)


def test_one_connected_pair_is_enough() -> None:
    deaf = endpoint("/chatter", "/deaf", durability="transient_local")
    assert_passed(
        judges.judge_communicates(
            launched(graph([endpoint("/chatter", TALKER)], [deaf, endpoint("/chatter", LISTENER)]))
        )
    )


def test_no_messages_at_all() -> None:
    assert_failed(judges.judge_communicates(launched(pair("/chatter"), messages=0)), "not connected", TALKER)


def test_a_subscriber_that_a_message_crashed() -> None:
    seen = launched(pair("/chatter"), out=DEAD, disconnected=True)
    assert_failed(judges.judge_communicates(seen), "unhandled exception", "hearer.py, line 7")


# --- shutdown ---


def test_a_clean_shutdown_passes() -> None:
    assert_passed(judges.judge_shutdown(launched(pair("/chatter"), ending=ending())))


def test_a_process_is_left_behind() -> None:
    left = ending()
    object.__setattr__(left, "survivors", ("sleep 1000",))
    assert_failed(judges.judge_shutdown(launched(pair("/chatter"), ending=left)), "process left behind", "sleep 1000")


@pytest.mark.parametrize(("name", "cause"), [("my_launch.py", "does not end"), ("talker.py", "SIGINT ignored")])
def test_a_launch_that_goes_on_is_explained_by_its_programs_only(name: str, cause: str) -> None:
    seen = launched(pair("/chatter"), ending=ending(None, still_running=True))
    assert seen.trace.file == "my_launch.py"
    ignoring = "signal.signal(signal.SIGINT, signal.SIG_IGN)"
    seen = replace(seen, trace=replace(seen.trace, sources={name: ignoring}))
    assert_failed(judges.judge_shutdown(seen), cause)


def test_a_traceback_of_a_node_fails_though_the_launch_exits_cleanly() -> None:
    seen = launched(pair("/chatter"), ending=ending(0, err=DEAD))
    assert judges.judge_shutdown(seen).status is Status.FAILED


# --- what the launch writes ---


def test_output_is_attributed_to_its_process() -> None:
    output = lines("[a-1] one\n[INFO] [a-1]: process started with pid [3]\n\x1b[32m[b-2] two\x1b[0m\nplain")
    assert [line.text for line in launch_output.written_by(output, "a-1")] == ["one"]
    assert [line.text for line in launch_output.written_by(output, "b-2")] == ["two"]
    assert launch_output.writers(output) == ["a-1", "b-2"]


def test_ended_processes() -> None:
    output = lines(f"{DEAD}\n[INFO] [talker-1]: process has finished cleanly [pid 11]")
    assert [(each.process, each.code) for each in launch_output.ended_processes(output)] == [
        ("hearer-2", 1),
        ("talker-1", 0),
    ]


def test_a_message_must_be_sent_before_its_log_to_be_proof() -> None:
    sample = Sample("/chatter", {"data": "late"}, START + 9, START + 9)
    seen = facts.pairs(pair("/chatter"))[0]
    assert facts.logs_of_messages(seen, [log_record("late")], [sample]) == []
