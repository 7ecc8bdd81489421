"""I2.2: judging made launches."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import pytest

from checks.i2_2 import facts, judges, processes
from checks.i2_2.facts import LaunchRun
from tests.checks.made import FOLDER, START, assert_failed, assert_passed, ending, exited, lines
from tutor.errors import NeedsInstalledRos
from tutor.judge.trace import LogRecord, Sample, Trace
from tutor.judge.verdict import Status
from tutor.ros_model import Graph, QoS, ServiceEndpoint, TopicEndpoint

STRING = "std_msgs/msg/String"
TALKS, HEARS = "/talker", "/listener"


def end(
    topic: str, node: str, *, type: str = STRING, reliability: str = "reliable", durability: str = "volatile"
) -> TopicEndpoint:
    return TopicEndpoint(topic, type, node, QoS(reliability, durability))


def graph(sends: Sequence[TopicEndpoint], takes: Sequence[TopicEndpoint], more: Sequence[str] = ()) -> Graph:
    """A graph of these endpoints; each node has parameter services."""
    nodes = sorted({each.node for each in (*sends, *takes)} | set(more))
    servers = tuple(
        ServiceEndpoint(f"{node}/list_parameters", "rcl_interfaces/srv/ListParameters", node) for node in nodes
    )
    return Graph(tuple(nodes), tuple(sends), tuple(takes), servers)


def pair(topic: str, other: str | None = None, *, namespace: str = "") -> Graph:
    """A talker, and a listener (on another topic, if one is given)."""
    return graph([end(topic, namespace + TALKS)], [end(other or topic, namespace + HEARS)])


def launched(
    seen: Graph, *, out: str = "", command_lines: Sequence[str] = (), messages: int = 2, **more: Any
) -> LaunchRun:
    """A launch with this graph, and messages on each topic that something is sent on."""
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


USUAL = launched(pair("/chatter"))


def with_topic(seen: Graph, **more: Any) -> LaunchRun:
    return launched(seen, arguments={"topic": "news"}, **more)


def in_robot1(seen: Graph, **more: Any) -> LaunchRun:
    return launched(seen, arguments={"namespace": "robot1"}, **more)


def with_both(seen: Graph, **more: Any) -> LaunchRun:
    return launched(seen, arguments={"topic": "news", "namespace": "robot1"}, **more)


# --- starts ---


def test_two_nodes_have_started() -> None:
    assert_passed(judges.judge_starts(USUAL))


def test_on_whatever_topics() -> None:
    assert_passed(judges.judge_starts(launched(pair("/chatter", "/chater"))))


def test_what_ros_subscribes_to_by_itself_makes_no_subscriber() -> None:
    seen = graph([end("/chatter", TALKS)], [end("/clock", HEARS), end("/parameter_events", HEARS)])
    assert_failed(judges.judge_starts(launched(seen)), "no subscriber", TALKS)


def test_one_node_is_not_two() -> None:
    seen = graph([end("/chatter", "/both")], [end("/chatter", "/both")])
    assert_failed(judges.judge_starts(launched(seen)), "one node only")


def test_two_nodes_of_one_name_are_two() -> None:
    seen = Graph(("/both", "/both"), (end("/chatter", "/both"),), (end("/chatter", "/both"),))
    assert_passed(judges.judge_starts(launched(seen)))


ERROR = "[ERROR] [launch]: Caught exception in launch (see debug for traceback): "
LOADING = f"{ERROR}Caught multiple exceptions when trying to load file of format [py]:\n"
ONE = LOADING.replace("multiple exceptions", "exception")
FORMAT = " - InvalidFrontendLaunchFileError: The launch file may have a syntax error, or its format is unknown"
OPEN, ZERO = "import launch\n\n\nlaunch.main(\n", "import launch\n\n\n\0launch.main()\n"
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
        (f"{ERROR}\"package 'demo' not found, searching: ['/opt/ros/jazzy']\"", "package not found", "'demo'"),
        (f"{ERROR}executable 'talk' not found on the libexec directory '/x'", "executable not found", "'talk'"),
        (f"{LOADING} - NameError: name 'LogInfo' is not defined\n{OWN_LINE}", "unhandled exception", "line 9"),
        (
            f"{LOADING} - InvalidPythonLaunchFileError: launch file at 'x' does not contain the required function "
            "'generate_launch_description()'",
            "no generate_launch_description",
            "my_launch.py",
        ),
        (f"{ERROR}'NoneType' object has no attribute 'entities'", "nothing returned", "return LaunchDescription"),
        (f"{ERROR}something else", "error in the launch", "something else"),
        (DEAD, "a node that ends", "hearer.py, line 7"),
        ("", "nothing to launch", "LaunchDescription(["),
    ],
)
def test_a_launch_that_starts_nothing_says_why(out: str, cause: str, words: str) -> None:
    seen = launched(Graph(), out=out, exit=exited(1, after_s=0.4))
    assert_failed(judges.judge_starts(seen), cause, words)


@pytest.mark.parametrize(
    ("out", "source", "cause", "words"),
    [
        (f"{LOADING} - SyntaxError: '(' was never closed (my_launch.py, line 4)", OPEN, "syntax error", "main()"),
        (f"{LOADING} - IndentationError: unexpected indent (my_launch.py, line 4)", "", "syntax error", "line 4"),
        (f"{ONE} - SyntaxError: source code string cannot contain null bytes", ZERO, "syntax error", "line 4 becomes"),
        (f"{LOADING} - ValueError: not yet", "", "unhandled exception", "ValueError: not yet"),
    ],
)
def test_an_installed_ros_shows_no_traceback_of_a_file_that_it_cannot_load(
    out: str, source: str, cause: str, words: str
) -> None:
    seen = launched(Graph(), out=f"{out}\n{FORMAT}", exit=exited(1, after_s=0.4))
    seen = replace(seen, trace=replace(seen.trace, sources={"my_launch.py": source}))
    assert_failed(judges.judge_starts(seen), cause, words)


def test_a_traceback_is_read_although_the_streams_are_mixed() -> None:
    mixed = lines(f'  File "{FOLDER}/my_launch.py", line 3\n    ])\n    ^')
    mixed += lines(" - InvalidFrontendLaunchFileError: The launch file may have a syntax error", "stdout")
    mixed += lines("SyntaxError: closing parenthesis ']' does not match")
    trace = Trace("my_launch.py", FOLDER, output=(*lines(LOADING, "stdout"), *mixed), exit=exited(1))
    assert_failed(judges.judge_starts(LaunchRun(trace)), "syntax error", "line 3")


def test_a_command_that_only_an_installed_ros_has_is_no_fault_of_the_learner() -> None:
    says = "[ros2-1] ros2: `ros2 topic` needs an installed ROS 2; this ros2 knows: launch, run"
    out = f"{says}\n[ERROR] [ros2-1]: process has died [pid 12, exit code 2, cmd 'ros2 topic pub /chatter']"
    with pytest.raises(NeedsInstalledRos, match="ros2 topic"):
        judges.judge_starts(launched(Graph(nodes=(HEARS,)), out=out))


def test_a_substitution_in_an_f_string() -> None:
    broken = (
        "[talker-1] Couldn't parse remap rule: '-r chatter:=<launch.substitutions.launch_configuration.LaunchConfig"
    )
    out = f"{broken}uration object at 0x7f1>'\n{DEAD.replace('hearer-2', 'talker-1')}"
    assert_failed(judges.judge_starts(launched(Graph(), out=out)), "substitution made text too early", "f-string")


def test_what_only_an_installed_ros_has_is_no_fault_of_the_learner() -> None:
    says = "launch_ros.actions.LifecycleNode is not supported by the launch files that run without an installed ROS 2"
    broken = launched(Graph(), out=f"{ERROR}{says}; it works where ROS 2 is installed and sourced", exit=exited(1))
    with pytest.raises(NeedsInstalledRos, match=r"^launch_ros\.actions\.LifecycleNode is not supported"):
        judges.judge_starts(broken)


# --- topic ---


def test_both_use_the_topic() -> None:
    assert_passed(judges.judge_topic(USUAL, with_topic(pair("/news"))))


def test_other_topics_may_stay() -> None:
    extra_sends, extra_takes = end("/beat", "/heart"), end("/beat", "/watchdog")
    usual = graph([end("/chatter", TALKS), extra_sends], [end("/chatter", HEARS), extra_takes])
    seen = graph([end("/news", TALKS), extra_sends], [end("/news", HEARS), extra_takes])
    assert_passed(judges.judge_topic(launched(usual), with_topic(seen)))


def test_the_default_topic_must_not_be_used_any_more() -> None:
    seen = graph([end("/news", TALKS), end("/chatter", TALKS)], [end("/news", HEARS)])
    assert_failed(judges.judge_topic(USUAL, with_topic(seen)), "default topic still used", TALKS, "/chatter")


@pytest.mark.parametrize(("sent", "taken"), [("/news", "/chatter"), ("/chatter", "/news")])
def test_one_node_is_not_remapped(sent: str, taken: str) -> None:
    command_lines = ["talker --ros-args -r chatter:=news", "listener --ros-args"]
    verdict = judges.judge_topic(USUAL, with_topic(pair(sent, taken), command_lines=command_lines))
    assert_failed(verdict, "remapping missing on one node", "/chatter")


def test_something_is_added_to_the_topic() -> None:
    seen = with_topic(pair("/news_data"), command_lines=["talker --ros-args -r chatter:=news_data"])
    assert_failed(judges.judge_topic(USUAL, seen), "wrong topic", "/news_data", "added")


@pytest.mark.parametrize(
    ("command_lines", "declares", "cause"),
    [
        (["talker --ros-args -r chatter:=chatter"], ("topik", "namespace"), "wrong argument name"),
        (["talker --ros-args"], ("namespace",), "argument missing"),
        (["talker --ros-args -r chatter:=my_topic"], ("topic",), "topic hard-coded"),
        (["talker --ros-args -r topic:=news"], ("topic",), "remapping from an unused name"),
        (["talker --ros-args -r news:=chatter"], ("topic",), "remapping the wrong way round"),
    ],
)
def test_nobody_uses_the_topic(command_lines: list[str], declares: tuple[str, ...], cause: str) -> None:
    seen = with_topic(
        pair("/chatter"), command_lines=["ros2 launch my_launch.py topic:=news", *command_lines], declares=declares
    )
    assert_failed(judges.judge_topic(USUAL, seen), cause)


def test_what_breaks_with_the_argument_only_is_told() -> None:
    seen = with_topic(Graph(), out=f"{ERROR}'NoneType' object has no attribute 'x'\n{OWN_LINE}", exit=exited(1))
    assert_failed(judges.judge_topic(USUAL, seen), "unhandled exception", "line 9")


def test_nothing_is_sent_on_the_topic() -> None:
    assert_failed(judges.judge_topic(USUAL, with_topic(pair("/news"), messages=0)), "no messages")


def test_a_publisher_that_never_sends_is_not_blamed_for_it_here() -> None:
    assert_passed(judges.judge_topic(launched(pair("/chatter"), messages=0), with_topic(pair("/news"), messages=0)))


def test_a_type_that_cannot_be_seen_is_taken_as_sent() -> None:
    seen = with_topic(pair("/news"), messages=0, hidden=frozenset({"/news"}))
    assert_passed(judges.judge_topic(USUAL, seen))


# --- namespace ---

ELSEWHERE = with_topic(pair("/news"))
ALONE = in_robot1(pair("/robot1/chatter", namespace="/robot1"))
BOTH = with_both(pair("/robot1/news", namespace="/robot1"))


def test_all_is_under_the_namespace() -> None:
    assert_passed(judges.judge_namespace(USUAL, ELSEWHERE, ALONE, BOTH))


def test_a_deeper_namespace_is_under_it_too() -> None:
    alone = in_robot1(pair("/robot1/arm/chatter", namespace="/robot1/arm"))
    assert_passed(judges.judge_namespace(USUAL, ELSEWHERE, alone, BOTH))


def test_the_namespace_is_there_twice() -> None:
    alone = in_robot1(pair("/robot1/robot1/chatter", namespace="/robot1/robot1"))
    both = with_both(pair("/robot1/robot1/news", namespace="/robot1/robot1"))
    assert_failed(judges.judge_namespace(USUAL, ELSEWHERE, alone, both), "namespace applied twice", "/robot1/robot1")
    topic_only = with_both(pair("/robot1/robot1/news", namespace="/robot1"))
    assert_failed(judges.judge_namespace(USUAL, ELSEWHERE, ALONE, topic_only), "namespace applied twice")


def test_one_node_has_no_namespace() -> None:
    seen = graph([end("/robot1/chatter", "/robot1/talker")], [end("/chatter", HEARS)])
    assert_failed(
        judges.judge_namespace(USUAL, ELSEWHERE, in_robot1(seen), BOTH), "namespace missing on one node", HEARS
    )


def test_no_node_has_it() -> None:
    seen = in_robot1(pair("/chatter"), command_lines=["talker --ros-args"])
    assert_failed(judges.judge_namespace(USUAL, ELSEWHERE, seen, BOTH), "namespace not used")


def test_its_argument_has_another_name() -> None:
    seen = in_robot1(pair("/chatter"), command_lines=["talker --ros-args"], declares=("topic", "ns"))
    assert_failed(judges.judge_namespace(USUAL, ELSEWHERE, seen, BOTH), "wrong argument name", "ns")


def test_a_name_like_the_namespace_is_not_under_it() -> None:
    seen = in_robot1(pair("/robot1chatter", namespace="/robot1x"), command_lines=["talker -r __node:=robot1x"])
    assert_failed(judges.judge_namespace(USUAL, ELSEWHERE, seen, BOTH), "namespace not used")


def test_the_topic_has_a_slash() -> None:
    seen = in_robot1(pair("/chatter", namespace="/robot1"), command_lines=["talker --ros-args -r chatter:=/chatter"])
    assert_failed(judges.judge_namespace(USUAL, ELSEWHERE, seen, BOTH), "absolute topic", "/chatter")


def test_a_remapping_from_a_slash_works_without_a_namespace_only() -> None:
    both = with_both(
        pair("/robot1/chatter", namespace="/robot1"), command_lines=["talker -r __ns:=/robot1 -r /chatter:=news"]
    )
    assert_failed(judges.judge_namespace(USUAL, ELSEWHERE, ALONE, both), "absolute remapping", "/chatter")


def test_a_topic_that_is_not_followed_anywhere_is_for_the_other_criterion() -> None:
    both = with_both(pair("/robot1/chatter", namespace="/robot1"))
    assert_passed(judges.judge_namespace(USUAL, with_topic(pair("/chatter")), ALONE, both))


def test_nodes_that_never_meet_may_be_in_a_namespace_all_the_same() -> None:
    usual, alone = launched(pair("/a", "/b")), in_robot1(pair("/robot1/a", "/robot1/b", namespace="/robot1"))
    assert_passed(judges.judge_namespace(usual, ELSEWHERE, alone, BOTH))


# --- communicates ---


def heard(text: str, name: str = "listener") -> LogRecord:
    return LogRecord(20, name, text, START + 1.5, START + 1.5)


@pytest.mark.parametrize("home", ["/demo", "/robot1"])
def test_the_default_namespace_need_not_be_empty(home: str) -> None:
    usual, elsewhere = (
        launched(pair(f"{home}/chatter", namespace=home)),
        with_topic(pair(f"{home}/news", namespace=home)),
    )
    another = launched(pair("/robot2/chatter", namespace="/robot2"), arguments={"namespace": "robot2"})
    assert_passed(judges.judge_topic(usual, elsewhere))
    assert_passed(judges.judge_namespace(usual, elsewhere, ALONE, BOTH, another if home == "/robot1" else None))


@pytest.mark.parametrize("home", ["/demo", "/robot1"])
def test_a_namespace_that_stays_what_it_is(home: str) -> None:
    usual, elsewhere = (
        launched(pair(f"{home}/chatter", namespace=home)),
        with_topic(pair(f"{home}/news", namespace=home)),
    )
    alone = in_robot1(pair(f"{home}/chatter", namespace=home))
    another = launched(pair(f"{home}/chatter", namespace=home), arguments={"namespace": "robot2"})
    verdict = judges.judge_namespace(usual, elsewhere, alone, BOTH, another if home == "/robot1" else None)
    assert_failed(verdict, "namespace not used")


def test_a_topic_that_leaves_the_default_namespace_with_one_node_only() -> None:
    usual = launched(pair("/demo/chatter", namespace="/demo"))
    seen = with_topic(pair("/demo/news", "/demo/chatter", namespace="/demo"))
    assert_failed(judges.judge_topic(usual, seen), "remapping missing on one node")


def test_a_message_is_logged() -> None:
    seen = launched(pair("/chatter"), logs=(heard("I heard: [Hello World: 1]"),))
    verdict = judges.judge_communicates(seen)
    assert_passed(verdict)
    assert any("I heard" in line for line in verdict.evidence)


def test_a_subscriber_that_says_nothing_is_right_where_it_spins() -> None:
    assert_passed(judges.judge_communicates(USUAL))
    assert_failed(judges.judge_communicates(launched(pair("/chatter"), answering=frozenset({TALKS}))), "no spin", HEARS)


def test_one_that_answers_no_calls_but_logs_is_right() -> None:
    seen = launched(pair("/chatter"), answering=frozenset(), logs=(heard("Hello World: 0"),))
    assert_passed(judges.judge_communicates(seen))


@pytest.mark.parametrize(
    ("logged", "proves"),
    [
        (("got 0", "got 1"), True),
        (("got 0", "still 0"), False),  # a number may stand in any message
        (("waiting 1.0 s",), False),
        (("10 and 11",), False),
    ],
)
def test_one_that_answers_no_calls_but_logs_numbers(logged: Sequence[str], proves: bool) -> None:
    samples = [Sample("/chatter", {"data": number}, START + number / 10, START) for number in range(2)]
    found = facts.logs_of_messages(facts.pairs(pair("/chatter"))[0], [heard(text) for text in logged], samples)
    assert bool(found) == proves


@pytest.mark.parametrize(
    ("said", "proves"), [("HELLO WORLD: 1!", True), ("Hello World: 11", False), ("Hello World: 1.", True)]
)
def test_a_logged_message_stands_for_itself(said: str, proves: bool) -> None:
    samples = [Sample("/chatter", {"data": "Hello World: 1"}, START, START)]
    assert bool(facts.logs_of_messages(facts.pairs(pair("/chatter"))[0], [heard(said)], samples)) == proves


def test_a_log_of_another_node_is_no_proof() -> None:
    seen = launched(pair("/chatter"), answering=frozenset(), logs=(heard("Hello World: 0", "talker"),))
    assert_failed(judges.judge_communicates(seen), "no spin")


@pytest.mark.parametrize(
    ("sends", "takes", "cause"),
    [
        (end("/chatter", TALKS, reliability="best_effort"), end("/chatter", HEARS), "incompatible QoS"),
        (end("/chatter", TALKS), end("/chatter", HEARS, durability="transient_local"), "incompatible QoS"),
        (end("/chatter", TALKS), end("/chatter", HEARS, type="std_msgs/msg/Int32"), "wrong type"),
        (end("/chatter", TALKS), end("/chater", HEARS), "wrong topic"),
    ],
)
def test_what_is_sent_does_not_arrive(sends: TopicEndpoint, takes: TopicEndpoint, cause: str) -> None:
    seen = launched(graph([sends], [takes]), logs=(heard("I heard: [Hello World: 1]"),))
    assert_failed(judges.judge_communicates(seen), cause)


def test_one_connected_pair_is_enough() -> None:
    deaf = end("/chatter", "/deaf", durability="transient_local")
    assert_passed(judges.judge_communicates(launched(graph([end("/chatter", TALKS)], [deaf, end("/chatter", HEARS)]))))


def test_nothing_is_sent() -> None:
    assert_failed(judges.judge_communicates(launched(pair("/chatter"), messages=0)), "no messages", TALKS)


def test_a_subscriber_that_has_died_of_it() -> None:
    seen = launched(pair("/chatter"), out=DEAD, parted=True)
    assert_failed(judges.judge_communicates(seen), "a node that ends", "hearer.py, line 7")


# --- shutdown ---


def test_a_clean_end() -> None:
    assert_passed(judges.judge_shutdown(launched(pair("/chatter"), ending=ending())))


def test_a_process_is_left() -> None:
    left = ending()
    object.__setattr__(left, "left", ("sleep 1000",))
    assert_failed(judges.judge_shutdown(launched(pair("/chatter"), ending=left)), "process left behind", "sleep 1000")


def test_the_launch_goes_on() -> None:
    seen = launched(pair("/chatter"), ending=ending(None, still_there=True))
    assert_failed(judges.judge_shutdown(seen), "SIGINT ignored")


def test_a_traceback_of_a_node_counts_though_the_launch_ends_well() -> None:
    seen = launched(pair("/chatter"), ending=ending(0, err=DEAD))
    assert judges.judge_shutdown(seen).status is Status.FAILED


# --- what the launch writes ---


def test_lines_are_told_apart_by_their_process() -> None:
    output = lines("[a-1] one\n[INFO] [a-1]: process started with pid [3]\n\x1b[32m[b-2] two\x1b[0m\nplain")
    assert [line.text for line in processes.written_by(output, "a-1")] == ["one"]
    assert [line.text for line in processes.written_by(output, "b-2")] == ["two"]
    assert processes.writers(output) == ["a-1", "b-2"]


def test_processes_that_have_gone() -> None:
    output = lines(f"{DEAD}\n[INFO] [talker-1]: process has finished cleanly [pid 11]")
    assert [(each.process, each.code) for each in processes.ended_processes(output)] == [
        ("hearer-2", 1),
        ("talker-1", 0),
    ]


def test_what_was_heard_must_have_been_sent_before() -> None:
    sample = Sample("/chatter", {"data": "late"}, START + 9, START + 9)
    seen = facts.pairs(pair("/chatter"))[0]
    assert facts.logs_of_messages(seen, [heard("late")], [sample]) == []
