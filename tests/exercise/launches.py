"""Fabricated launches, and the judges of i2.2 to judge them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import Any

from checks.i2_2_launch_file import CHECK
from tests.checks import builders
from tests.checks.builders import FOLDER, START, judge_of, lines
from tutor.exercise.launch_run import LaunchRun
from tutor.judge.trace import LogRecord, Sample, Trace
from tutor.ros_model import Graph, QoS, ServiceEndpoint, TopicEndpoint

assert_failed = partial(builders.assert_failed, check=CHECK)

judge_starts = judge_of(CHECK, "starts")
judge_topic = judge_of(CHECK, "topic")
judge_namespace = judge_of(CHECK, "namespace")
judge_communicates = judge_of(CHECK, "communicates")
judge_shutdown = judge_of(CHECK, "shutdown")

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


def log_record(text: str, name: str = "listener") -> LogRecord:
    return LogRecord(20, name, text, START + 1.5, START + 1.5)


def with_program(seen: LaunchRun, program: str) -> LaunchRun:
    """The launch, with a program of the learner's beside the launch file."""
    sources = {"my_launch.py": "def generate_launch_description(): ...", "ear.py": program}
    return replace(seen, trace=replace(seen.trace, sources=sources))


ERROR = "[ERROR] [launch]: Caught exception in launch (see debug for traceback): "
LOADING = f"{ERROR}Caught multiple exceptions when trying to load file of format [py]:\n"
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
