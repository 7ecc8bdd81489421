"""Each likely cause is recognised by its own symptoms, and by nothing else."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

import pytest

from tests.checks.builders import CRASH, CRASHED, FOLDER, NO_NODE, NODE_UP, exited, graph, lines, log, trace
from tests.judge.crashes import crash
from tutor.judge.causes import (
    diagnose_incompatible_qos,
    diagnose_incompatible_service,
    diagnose_lifecycle,
    diagnose_no_answer,
    diagnose_no_messages,
    diagnose_nothing_received,
    diagnose_printed,
    diagnose_process,
    diagnose_refusal,
    diagnose_same_name,
    diagnose_wrong_topic,
    output_tail,
)
from tutor.judge.trace import Trace
from tutor.judge.tracebacks import Frame, Traceback, find_tracebacks
from tutor.ros_model import Graph, QoS, ServiceEndpoint, TopicEndpoint

TOPIC, TYPE = "/sensor/temperature", "std_msgs/msg/Float64"
EMPTY_GRAPH = Graph()


def parameter_type(wanted: str, given: str) -> str:
    return f"""Traceback (most recent call last):
  File "{FOLDER}/node.py", line 9, in __init__
    self.declare_parameter('publish_rate', 1)
rclpy.exceptions.InvalidParameterTypeException: Trying to set parameter 'publish_rate' to '2.0' of type '{given}', \
expecting type '{wanted}': wrong"""


@pytest.mark.parametrize(
    ("seen", "cause", "word"),
    [
        (trace(graph=EMPTY_GRAPH, err=crash("x =")), "syntax error", "node.py, line 1: x ="),
        (trace(graph=EMPTY_GRAPH, err=crash("def f():\npass")), "syntax error", "line 2"),
        (trace(graph=EMPTY_GRAPH, err=crash("import std_msg")), "import error", "No module named 'std_msg'"),
        (trace(graph=EMPTY_GRAPH, err=crash("from os import nothing")), "import error", "line 1"),
        (trace(err=parameter_type("INTEGER", "DOUBLE"), exit=exited(1)), "integer parameter", "line 9"),
        (trace(err=parameter_type("DOUBLE", "INTEGER"), exit=exited(1)), "integer parameter", "line 9"),
        (trace(err=parameter_type("STRING", "DOUBLE"), exit=exited(1)), "wrong parameter type", "publish_rate"),
        (trace(err=crash("raise SystemError('x')"), exit=exited(1)), "float in an int field", "SystemError"),
        (
            trace(err=crash("assert False, \"The 'sum' field must be of type 'int'\""), exit=exited(1)),
            "float in an int field",
            "sum",
        ),
        (trace(err=crash("assert False, 'other'"), exit=exited(1)), "unhandled exception", "other"),
        (CRASHED, "unhandled exception", "node.py, line 12: self.nothing()"),
        (trace(err=CRASH), "unhandled exception", "AttributeError"),
        (trace(exit=exited(0, after_s=0.4)), "exit at once", "0.4 s"),
        (trace(exit=exited(0, after_s=9.0)), "exit at once", "9.0 s"),
        (trace(exit=exited(3)), "exit at once", "exit code 3"),
        (trace(exit=exited(signal=9)), "killed", "SIGKILL"),
        (trace(exit=exited(signal=77)), "killed", "signal 77"),
        (
            trace(
                err="terminate called without an active exception\nFatal Python error: Aborted", exit=exited(signal=6)
            ),
            "thread still running",
            "one of its threads",
        ),
        (trace(err="free(): invalid pointer", exit=exited(signal=6)), "killed", "SIGABRT"),
        (trace(exit=exited(0), uncalled_main=True), "no main call", "main()"),
        (NO_NODE, "no node", "made no ROS node"),
        (trace(graph=EMPTY_GRAPH, dropped_lines=5), "no node", "prints without end"),
    ],
)
def test_causes_in_the_process(seen: Trace, cause: str, word: str) -> None:
    found = diagnose_process(seen)
    assert found is not None
    assert found.name == cause
    assert word in found.text
    assert found.hint


@pytest.mark.parametrize("seen", [trace(), trace(uncalled_main=True), trace(out=CRASH), trace(dropped_lines=5)])
def test_a_node_that_is_up_gives_no_cause(seen: Trace) -> None:
    assert diagnose_process(seen) is None


@pytest.mark.parametrize(
    ("seen", "answers", "cause", "word"),
    [
        (CRASHED, True, "unhandled exception", ""),
        (NO_NODE, True, "no node", ""),
        (trace(graph=graph(publishers={TOPIC: TYPE})), False, "no spin", "/node"),
        (trace(graph=graph(publishers={TOPIC: TYPE})), True, "no messages", TOPIC),
        (trace(graph=graph(publishers={TOPIC: "std_msgs/msg/Float32"})), True, "wrong type", "std_msgs/msg/Float32"),
        (trace(graph=graph(publishers={"/sensor_temperature": TYPE})), True, "wrong topic", "slash"),
        (trace(graph=graph(publishers={"/sensortemperature": TYPE})), True, "wrong topic", "slash"),
        (trace(graph=graph(publishers={"/robot/sensor/temperature": TYPE})), True, "wrong topic", "namespace"),
        (trace(graph=graph(publishers={"/temperature": TYPE})), True, "wrong topic", "first part"),
        (trace(graph=graph(publishers={"/sensor/temprature": TYPE})), True, "wrong topic", "spelled differently"),
        (trace(graph=graph(publishers={"/anything": TYPE})), True, "wrong topic", "spelled differently"),
        (trace(graph=graph(publishers={"/sensor/temperatur": "std_msgs/msg/String"})), True, "wrong topic", ""),
        (trace(graph=graph(publishers={"/scan": "sensor_msgs/msg/LaserScan"})), True, "no publisher", "/node"),
        (trace(graph=NODE_UP), True, "no publisher", TOPIC),
        (trace(graph=NODE_UP), False, "no publisher", TOPIC),
    ],
)
def test_causes_of_no_messages(seen: Trace, answers: bool, cause: str, word: str) -> None:
    found = diagnose_no_messages(seen, TOPIC, TYPE, answers=answers)
    assert found.name == cause
    assert word in found.text
    assert found.hint


def test_the_nearest_of_several_wrong_topics_is_explained() -> None:
    endpoints = [TopicEndpoint(name, TYPE, "/node") for name in ("/zzz", "/me/sensor/temperature", "/a")]
    assert "namespace" in diagnose_wrong_topic(endpoints, TOPIC).text


def test_output_tail_is_the_last_lines_that_are_not_blank() -> None:
    text = "\n".join(f"line {i}\n   " for i in range(20))
    assert output_tail(trace(out=text)) == tuple(f"line {i}" for i in range(14, 20))
    assert output_tail(trace(out=text), 2) == ("line 18", "line 19")
    assert output_tail(trace()) == ()


def test_how_a_traceback_names_its_exception() -> None:
    (found,) = find_tracebacks(lines(CRASH))
    assert found.raised == "AttributeError: 'Sensor' object has no attribute 'nothing'"
    assert Traceback("KeyboardInterrupt", "", ()).raised == "KeyboardInterrupt"


def test_two_nodes_are_reported_only_if_they_have_the_same_name() -> None:
    cause = diagnose_same_name(Trace("x.py", graph=Graph(nodes=("/a", "/talker", "/talker"))))
    assert cause is not None
    assert cause.name == "second node of the same name"
    assert "2 nodes called /talker" in cause.text
    assert diagnose_same_name(Trace("x.py", graph=Graph(nodes=("/a", "/talker")))) is None


@pytest.mark.parametrize(
    ("made", "step"),
    [
        ("ex.add_node(P())\nex.add_node(P())", "remove line 4: ex.add_node(P())"),
        ("one = P()\ntwo = P()\ntwo.run()", "remove line 5: two.run()\nremove line 4: two = P()"),
        ("one = P()", "make one node only; is the class instantiated twice, or the program started twice?"),
    ],
)
def test_a_second_node_of_the_same_class_is_removed(made: str, step: str) -> None:
    text = f"class P(Node):\n    pass\n{made}\n"
    cause = diagnose_same_name(Trace("x.py", sources={"x.py": text}, graph=Graph(nodes=("/p", "/p"))))
    assert cause is not None
    assert cause.hint == step


PLAIN = ("reliable", "volatile")
OURS = TopicEndpoint("/chatter", "std_msgs/msg/String", "/ours")


def subscribed(topic: str = OURS.topic, type_name: str = OURS.type, qos: QoS = OURS.qos) -> Trace:
    asked = TopicEndpoint(topic, type_name, "/node", qos)
    return trace(graph=Graph(nodes=("/node",), subscriptions=(asked,)))


@pytest.mark.parametrize(
    ("seen", "answers", "cause", "word"),
    [
        (CRASHED, True, "unhandled exception", ""),
        (subscribed(OURS.topic, OURS.type, QoS("reliable", "transient_local")), True, "incompatible QoS", "durability"),
        (subscribed("/chater"), True, "wrong topic", "are taken from /chater, not from /chatter"),
        (subscribed("/Chatter"), True, "wrong topic", "upper and lower case"),
        (subscribed(OURS.topic, "std_msgs/msg/Int32"), True, "wrong type", "Int32"),
        (subscribed(), False, "no spin", "/node"),
        (subscribed(), True, "callback does nothing", "/chatter"),
        (trace(graph=NODE_UP), True, "no subscription", "/chatter"),
    ],
)
def test_causes_of_nothing_received(seen: Trace, answers: bool, cause: str, word: str) -> None:
    found = diagnose_nothing_received(seen, OURS, answers=answers)
    assert found.name == cause
    assert word in found.text
    assert found.hint


@pytest.mark.parametrize("topic", ["'chatter'", "'/chatter'", "TOPIC"])
def test_the_step_for_an_incompatible_subscription_replaces_its_qos(topic: str) -> None:
    code = f"""\
node.create_subscription(Map, '/map', on_map, LATCHED)
node.create_subscription(String, {topic}, on_text, qos_profile=LATCHED)
"""
    seen = replace(subscribed(OURS.topic, OURS.type, QoS("reliable", "transient_local")), sources={"node.py": code})
    hint = diagnose_nothing_received(seen, OURS, answers=True).hint
    assert hint == f"line 2 becomes: node.create_subscription(String, {topic}, on_text, qos_profile=10)"


@pytest.mark.parametrize(
    ("offered", "asked", "policy"),
    [
        (("best_effort", "volatile"), ("reliable", "volatile"), "reliability"),
        (("reliable", "volatile"), ("reliable", "transient_local"), "durability"),
        (("reliable", "transient_local"), ("best_effort", "volatile"), ""),
        (("best_effort", "volatile"), ("best_effort", "volatile"), ""),
        (("system_default", "system_default"), ("reliable", "volatile"), ""),
        ((*PLAIN, None), (*PLAIN, 0.5), "deadline infinite"),
        ((*PLAIN, 1.0), (*PLAIN, 0.5), "deadline 1 s"),
        ((*PLAIN, 0.5), (*PLAIN, 0.5), ""),
        ((*PLAIN, 0.5), (*PLAIN, None), ""),
        ((*PLAIN, None, "automatic"), (*PLAIN, None, "manual_by_topic"), "liveliness automatic"),
        ((*PLAIN, None, "manual_by_topic"), (*PLAIN, None, "automatic"), ""),
        ((*PLAIN, None, "automatic", None), (*PLAIN, None, "automatic", 1.0), "lease"),
    ],
)
def test_incompatible_qos_of_the_learners_own_endpoints(
    offered: tuple[Any, ...], asked: tuple[Any, ...], policy: str
) -> None:
    publisher, subscription = (
        TopicEndpoint("/a", "T", node, QoS(*qos)) for node, qos in (("/one", offered), ("/two", asked))
    )
    found = diagnose_incompatible_qos(publisher, subscription)
    assert (found.name if found else "") == ("incompatible QoS" if policy else "")
    assert found is None or policy in found.text


@pytest.mark.parametrize("qos", [("best_effort", "volatile"), ("reliable", "transient_local")])
def test_a_service_with_an_unusual_qos_is_not_connected(qos: tuple[str, str]) -> None:
    services = [ServiceEndpoint("/add", "T", "/node"), ServiceEndpoint("/divide", "T", "/node", *qos)]
    found = diagnose_incompatible_service(services)
    assert found is not None
    assert (found.name, "/divide" in found.text) == ("incompatible QoS", True)
    assert diagnose_incompatible_service(services[:1]) is None


OWN = Frame(f"{FOLDER}/node.py", 12, "tick", "time.sleep(9)")
MAIN = Frame(f"{FOLDER}/node.py", 30, "main", "rclpy.spin(node)")
EXECUTOR = Frame("/lib/rclpy/executors.py", 296, "spin", "")
CALL = Frame("/lib/rclpy/client.py", 90, "call", "")


@pytest.mark.parametrize(
    ("stuck", "spins", "cause"),
    [
        ((OWN, EXECUTOR, MAIN), False, "blocked executor"),
        ((OWN, EXECUTOR, MAIN), True, "blocked executor"),
        ((CALL, OWN, EXECUTOR, MAIN), False, "deadlock by call()"),
        ((OWN, MAIN), False, "no spin"),
        ((), False, "no spin"),
        ((EXECUTOR, MAIN), False, "no spin"),
    ],
)
def test_causes_of_no_answer(stuck: tuple[Frame, ...], spins: bool, cause: str) -> None:
    found = diagnose_no_answer(trace(), stuck, spins=spins)
    assert found.name == cause
    assert ("line 12" in found.text) == (OWN in stuck)
    assert diagnose_no_answer(CRASHED, stuck).name == "unhandled exception"


CONSOLE = "[INFO] [1763716000.125] [node]: kx7 is up"


@pytest.mark.parametrize(
    ("seen", "after", "cause"),
    [
        (trace(out="kx7: 25"), "", "printed, not logged"),
        (trace(err="INFO:root:kx7: 25"), "", "printed, not logged"),
        (trace(), "kx7: 25", "output held back by buffering"),
        (trace(err=CONSOLE.replace("[node]", "[sensor]")), "", "not the node's logger"),
        (trace(err=CONSOLE, logs=[log("hello")]), "", "not the node's logger"),
        (trace(err=CONSOLE), "", "rosout switched off"),
        (trace(err=CONSOLE, logs=[log("kx7 is up")]), "", ""),
        (trace(out="something else"), "bye", ""),
    ],
)
def test_causes_of_output_that_was_not_logged(seen: Trace, after: str, cause: str) -> None:
    found = diagnose_printed(seen, lambda text: "kx7" in text, "the name", after=lines(after, "stdout"))
    assert (found.name if found else "") == cause


LOGS = """
import logging
log = logging.getLogger('me')
class A(Node):
    def tick(self):
        {line}
"""


@pytest.mark.parametrize(
    ("line", "out", "text", "step"),
    [
        ("print(f'sensor {name}')", "sensor kx7", "line 6", "line 6 becomes: self.get_logger().info(f'sensor {name}')"),
        ("print('name', name)", "name kx7", "line 6", "line 6 becomes: self.get_logger().info(f'name {name}')"),
        ("log.info('%s up', name)", "INFO:me:kx7 up", "Python's own", ".get_logger().info('%s up' % (name,))"),
        (
            "logging.warning(f'{name} up')",
            "WARNING:root:kx7 up",
            "Python's own",
            "self.get_logger().warning(f'{name} up')",
        ),
        ("print('is', self.get('key'))", "is kx7", "line 6", "line 6 becomes: self.get_logger().info(f'is {self.get("),
        ("print(name)", "kx7", "with print(): kx7", "use self.get_logger().info(...)"),
        ("log.info('%s up', name)", "", "Python's own", "line 6 becomes: self.get_logger().info('%s up' % (name,))"),
    ],
)
def test_the_line_that_printed_is_named(line: str, out: str, text: str, step: str) -> None:
    seen = trace(out=out, sources={"node.py": LOGS.format(line=line)})
    found = diagnose_printed(seen, lambda text: "kx7" in text, "the name")
    assert found is not None
    assert text in found.text
    assert step in found.hint


def test_pythons_logging_is_blamed_for_silence_only_if_the_node_logs_nothing() -> None:
    both = LOGS.format(line="log.debug('x'); self.get_logger().debug(name)")
    assert diagnose_printed(trace(sources={"node.py": both}), lambda text: "kx7" in text, "the name") is None


ROSOUT = "Failed to publish log message to rosout: publisher's context is invalid, at ./src/rcl/publisher.c:423"
RCL = "rclpy._rclpy_pybind11.RCLError: failed to shutdown: rcl_shutdown already called on the given context"
SHUTDOWN = f"""Traceback (most recent call last):
  File "{FOLDER}/node.py", line 30, in main
    rclpy.shutdown()
{RCL}"""


@pytest.mark.parametrize(
    ("seen", "after"),
    [
        (trace(), ROSOUT),
        (trace(), f"{RCL}, at /project/src/rcl/init.c:253"),
        (trace(), SHUTDOWN),
        (trace(err=ROSOUT), ""),
        (trace(err=SHUTDOWN), ""),
        (trace(err="[ERROR] [1763716000.125] [rcl.logging_rosout]: Failed to publish"), ""),
    ],
)
def test_output_of_ros_itself_is_not_the_learners_print(seen: Trace, after: str) -> None:
    assert diagnose_printed(seen, re.compile("(?i)error|fail").search, "the error", after=lines(after)) is None


@pytest.mark.parametrize(
    ("reason", "cause"),
    [
        ("Callback returned an invalid type", "callback returns None"),
        ("Wrong parameter type, expected 'Type.INTEGER' got 'Type.DOUBLE'", "integer parameter"),
        ("Wrong parameter type, expected 'Type.STRING' got 'Type.DOUBLE'", "wrong parameter type"),
        ("rate has not been declared", "parameter not declared"),
        ("Trying to set a read-only parameter: rate.", "rejected"),
        ("too fast", "rejected"),
        ("", "rejected"),
        ("Parameter rate out of range Min: 1.0, Max: 5.0, value: 10.0", "range too narrow"),
    ],
)
def test_causes_of_a_valid_value_refused(reason: str, cause: str) -> None:
    found = diagnose_refusal(reason, "declare it")
    assert found.name == cause
    assert found.hint == "declare it"


def test_the_step_for_an_unknown_exception_is_not_its_unchanged_line() -> None:
    cause = diagnose_process(trace(err=CRASH.replace("AttributeError: 'Sensor' object has", "OddError: it has")))
    assert cause is not None
    assert "self.nothing()" in cause.text
    assert "line 12 of " in cause.hint
    assert "self.nothing()" not in cause.hint


def test_a_node_that_is_created_on_import_needs_rclpy_before() -> None:
    started = (
        "import rclpy, base\n\n\nnode = base.N()\n\n\ndef main():\n    rclpy.init()\n    rclpy.spin(node)\n\nmain()\n"
    )
    err = f"""Traceback (most recent call last):
  File "{FOLDER}/node.py", line 4, in <module>
    node = base.N()
  File "{FOLDER}/base.py", line 3, in __init__
    super().__init__('n')
rclpy.exceptions.NotInitializedException: rclpy.init() has not been called"""
    sources = {"node.py": started, "base.py": "class N(Node):\n  def __init__(self):\n    super().__init__('n')\n"}
    found = diagnose_process(trace(err=err, exit=exited(1), sources=sources))
    assert found is not None
    assert found.hint.startswith("in node.py, ")
    assert "remove line 8: rclpy.init()" in found.hint
    assert "write above line 4, with the same indentation: rclpy.init()" in found.hint


def test_an_exception_chain_is_named_after_its_most_informative_member() -> None:
    wrapped = "try:\n    import std_msg\nexcept ImportError as error:\n    raise RuntimeError('set it up') from error"
    found = diagnose_process(trace(err=crash(wrapped), exit=exited(1)))
    assert found is not None
    assert found.name == "import error"
    assert "std_msg" in found.text
    assert "set it up" in found.text
    found = diagnose_process(trace(err=crash("try:\n    1 / 0\nfinally:\n    undefined"), exit=exited(1)))
    assert found is not None
    assert found.name == "unhandled exception"
    assert "ZeroDivisionError" in found.text
    assert "line 2" in found.text


def test_a_service_callback_without_a_response() -> None:
    text = f"""Traceback (most recent call last):
  File "{FOLDER}/node.py", line 30, in main
    rclpy.spin(node)
  File "/lib/rclpy/service.py", line 75, in send_response
    raise TypeError()
TypeError"""
    found = diagnose_process(trace(err=text, exit=exited(1)))
    assert found is not None
    assert found.name == "response not returned"


LIFECYCLE = """\
class Sensor(LifecycleNode):
    def on_activate(self, state):
        return TransitionCallbackReturn.SUCCESS


def main():
    sensor = Sensor()
"""


@pytest.mark.parametrize(
    ("source", "steps"),
    [
        ("", ["node.trigger_configure(), then node.trigger_activate()"]),
        (
            LIFECYCLE,
            [
                "below line 7, with the same indentation:\n    sensor.trigger_configure()\n    sensor.trigger_act",
                "line 3 becomes: return super().on_activate(state)",
            ],
        ),
        (
            LIFECYCLE.replace("sensor = Sensor()", "rclpy.spin(Sensor())"),
            ["    node = Sensor()\n    node.trigger_configure()", "line 7 becomes: rclpy.spin(node)"],
        ),
        (  # rclpy.lifecycle's Node
            LIFECYCLE.replace("LifecycleNode", "Node"),
            ["below line 7, with the same indentation:\n    sensor.trigger_configure()"],
        ),
        (
            LIFECYCLE + "    sensor.trigger_configure()\n",
            ["write below line 8, with the same indentation: sensor.trigger_activate()"],
        ),
        (LIFECYCLE + "    sensor.trigger_activate()\n", ["line 3 becomes: return super().on_activate(state)"]),
    ],
)
def test_a_lifecycle_node_that_is_never_activated(source: str, steps: list[str]) -> None:
    asleep = graph(services={"/sensor/change_state": "lifecycle_msgs/srv/ChangeState"})
    seen = trace(graph=asleep, sources={"node.py": source})
    cause = diagnose_no_messages(seen, "/chatter", "std_msgs/msg/String", answers=True)
    assert cause.name == "lifecycle node not activated"
    for step in steps:
        assert step in cause.hint
    awake = trace(
        graph=asleep,
        sources={
            "node.py": LIFECYCLE.replace("TransitionCallbackReturn.SUCCESS", "super().on_activate(state)")
            + "    sensor.trigger_activate()"
        },
    )
    assert diagnose_lifecycle(awake) is None


def test_rosout_is_enabled_if_logs_do_not_reach_it() -> None:
    text = "class A(Node):\n    def __init__(self):\n        super().__init__('a', enable_rosout=False)\n"
    found = diagnose_printed(trace(err=CONSOLE, sources={"node.py": text}), lambda said: "kx7" in said, "the name")
    assert found is not None
    assert found.hint == "line 3 becomes: super().__init__('a', enable_rosout=True)"


@pytest.mark.parametrize(
    ("handler", "cause"),
    [
        ("print(error.args[5])", "IndexError"),
        ("raise RuntimeError('no') from error", "ZeroDivisionError"),
        ("raise RuntimeError('no')", "ZeroDivisionError"),
    ],
)
def test_a_mistake_in_an_exception_handler_is_explained_before_what_it_handles(handler: str, cause: str) -> None:
    source = f"a = b = 0\ntry:\n    rate = 1 / (a - b)\nexcept ZeroDivisionError as error:\n    {handler}\n"
    found = diagnose_process(trace(err=crash(source), exit=exited(1), sources={"node.py": source}))
    assert found is not None
    assert found.text.startswith(cause)
