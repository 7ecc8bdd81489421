"""Which mistake is told from what a run shows: how the process ended, the graph, and the output."""

from __future__ import annotations

import re
from typing import Any

import pytest

from tests.checks.builders import CRASH, CRASHED, FOLDER, NO_NODE, exited, graph, lines, log, trace
from tests.judge.crashes import crash
from tests.mistakes.cases import assert_told, told
from tutor.judge.symptom import Symptom
from tutor.judge.trace import Trace
from tutor.ros_model import Graph, QoS, ServiceEndpoint, TopicEndpoint

TOPIC, TYPE = "/sensor/temperature", "std_msgs/msg/Float64"
EMPTY_GRAPH = Graph()


def parameter_type(wanted: str, given: str) -> str:
    return f"""Traceback (most recent call last):
  File "{FOLDER}/node.py", line 9, in __init__
    self.declare_parameter('publish_rate', 1)
rclpy.exceptions.InvalidParameterTypeException: Trying to set parameter 'publish_rate' to '2.0' of type '{given}', \
expecting type '{wanted}': wrong"""


TORN = "terminate called without an active exception\nFatal Python error: Aborted"
NO_RESPONSE = f"""Traceback (most recent call last):
  File "{FOLDER}/node.py", line 30, in main
    rclpy.spin(node)
  File "/lib/rclpy/service.py", line 75, in send_response
    raise TypeError()
TypeError"""


@pytest.mark.parametrize(
    ("run", "mistake", "words"),
    [
        (trace(graph=EMPTY_GRAPH, err=crash("x =")), "syntax-error", "node.py, line 1: x ="),
        (trace(graph=EMPTY_GRAPH, err=crash("def f():\npass")), "wrong-indentation", "line 2"),
        (trace(graph=EMPTY_GRAPH, err=crash("import std_msg")), "import-error", "std_msg"),
        (trace(graph=EMPTY_GRAPH, err=crash("from os import nothing")), "import-error", "line 1"),
        (trace(err=parameter_type("INTEGER", "DOUBLE"), exit=exited(1)), "integer-parameter-given-a-double", "line 9"),
        (trace(err=parameter_type("STRING", "DOUBLE"), exit=exited(1)), "parameter-given-another-type", "publish_rate"),
        (
            trace(err=crash("assert False, \"The 'sum' field must be of type 'int'\""), exit=exited(1)),
            "float-in-an-int-field",
            "sum",
        ),
        (trace(err=crash("assert False, 'other'"), exit=exited(1)), "raised-by-the-program-itself", "other"),
        (CRASHED, "unhandled-exception", "node.py, line 12: self.nothing()"),
        (trace(err=CRASH), "unhandled-exception", "AttributeError"),
        (trace(err=NO_RESPONSE, exit=exited(1)), "response-not-returned", ""),
        (trace(exit=exited(0, after_s=0.4)), "exit-at-once", "0.4 s"),
        (trace(exit=exited(0, after_s=9.0)), "exit-at-once", "9.0 s"),
        (trace(exit=exited(3)), "exit-at-once", "exit code 3"),
        (trace(exit=exited(signal=9)), "killed", "SIGKILL"),
        (trace(exit=exited(signal=77)), "killed", "signal 77"),
        (trace(err=TORN, exit=exited(signal=6)), "thread-still-running", "one of its threads"),
        (trace(err=f"{CRASH}\n{TORN}", exit=exited(signal=6)), "unhandled-exception", "AttributeError"),
        (trace(err="free(): invalid pointer", exit=exited(signal=6)), "killed", "SIGABRT"),
        (NO_NODE, "no-node", "made no ROS node"),
        (trace(graph=EMPTY_GRAPH, dropped_lines=5), "no-node", "prints endlessly"),
        (trace(out=CRASH), "no-messages", ""),
        (trace(dropped_lines=5), "no-messages", ""),
    ],
)
def test_what_the_process_shows(run: Trace, mistake: str, words: str) -> None:
    assert_told(told(Symptom.NO_MESSAGES, "", run=run), mistake, words)


WRAPPED = "try:\n    import std_msg\nexcept ImportError as error:\n    raise RuntimeError('set it up') from error"
HANDLED = "a = b = 0\ntry:\n    rate = 1 / (a - b)\nexcept ZeroDivisionError as error:\n    {}\n"


@pytest.mark.parametrize(
    ("source", "mistake", "words"),
    [
        (WRAPPED, "import-error", "std_msg"),
        (WRAPPED, "import-error", "then RuntimeError"),
        ("try:\n    1 / 0\nfinally:\n    undefined", "unhandled-exception", "ZeroDivisionError"),
        (HANDLED.format("print(error.args[5])"), "unhandled-exception", "IndexError"),
        (HANDLED.format("raise RuntimeError('no') from error"), "unhandled-exception", "ZeroDivisionError"),
        (HANDLED.format("raise RuntimeError('no')"), "unhandled-exception", "ZeroDivisionError"),
    ],
)
def test_which_of_several_exceptions_is_told(source: str, mistake: str, words: str) -> None:
    assert_told(told(Symptom.ENDED, source, run=trace(err=crash(source), exit=exited(1))), mistake, words)


GUARD = "def main():\n    pass\n\nif __name__ == '{}':\n    main()\n"
CALLBACK = """\
class Talker(Node):
    def __init__(self):
        super().__init__('talker')
        self.timer = self.create_timer(1.0, self.tick)

    def tick(self):
        if not self.on:
            {}


rclpy.spin(Talker())
"""
TALKER = "class Talker(Node):\n    pass\n\n\ndef main():\n    talker = Talker()\n    {}\n\n\nmain()\n"


@pytest.mark.parametrize(
    ("source", "mistake", "words"),
    [
        (GUARD.format("main"), "no-main-call", "line 4"),
        (GUARD.format("__init__"), "no-main-call", "line 4"),
        (GUARD.format("__main__"), "exit-at-once", ""),
        ("def main():\n    pass\n", "no-main-call", "nothing calls it"),
        ("def main():\n    pass\n\nmain\n", "no-main-call", "line 4"),
        (CALLBACK.format("raise SystemExit"), "ended-by-a-callback", "line 8"),
        (CALLBACK.format("sys.exit(0)"), "ended-by-a-callback", "line 8"),
        (CALLBACK.format("rclpy.shutdown()"), "ended-by-a-callback", "line 8"),
        (CALLBACK.format("return"), "exit-at-once", "nothing keeps it running"),
        (TALKER.format("rclpy.spin_once(talker)"), "exit-at-once", "line 7 handles at most one callback"),
        (TALKER.format("ex.spin_once(0.1)"), "exit-at-once", "line 7 handles at most one callback"),
        (TALKER.format("talker.tick()"), "exit-at-once", "line 6, but never spins it"),
        (TALKER.format("rclpy.spin(talker)"), "exit-at-once", "nothing keeps it running"),
        (TALKER.format("while ok():\n        rclpy.spin_once(talker)"), "exit-at-once", "nothing keeps it running"),
        ("if len(sys.argv) > 1:\n  print('usage:', sys.argv[0])\n  sys.exit(1)\n", "arguments-refused", "line 1"),
        ("def main():\n  if len(sys.argv) != 1:\n    return\n  run()\nmain()\n", "arguments-refused", "line 2"),
        ("if len(sys.argv) < 2:\n  sys.exit(1)\nrate = float(sys.argv[1])\n", "exit-at-once", ""),
        ("if len(sys.argv) > 1:\n  print('no')\n", "exit-at-once", ""),
    ],
)
def test_what_ended_the_program(source: str, mistake: str, words: str) -> None:
    assert_told(told(Symptom.ENDED, source, run=trace(exit=exited(0))), mistake, words)


def publishing(**publishers: str) -> Trace:
    return trace(graph=graph(publishers={name.replace("__", "/"): kind for name, kind in publishers.items()}))


@pytest.mark.parametrize(
    ("run", "answers", "mistake", "words"),
    [
        (publishing(__sensor__temperature=TYPE), False, "no-spin", "/node"),
        (publishing(__sensor__temperature=TYPE), True, "no-messages", TOPIC),
        (publishing(__sensor__temperature="std_msgs/msg/Float32"), True, "wrong-type", "std_msgs/msg/Float32"),
        (publishing(__sensor_temperature=TYPE), True, "wrong-topic", "slash"),
        (publishing(__sensortemperature=TYPE), True, "wrong-topic", "slash"),
        (publishing(__robot__sensor__temperature=TYPE), True, "wrong-topic", "namespace"),
        (publishing(__temperature=TYPE), True, "wrong-topic", "first part"),
        (publishing(__sensor__temprature=TYPE), True, "wrong-topic", "spelled differently"),
        (publishing(__anything=TYPE), True, "wrong-topic", "spelled differently"),
        (publishing(__sensor__temperatur="std_msgs/msg/String"), True, "wrong-topic", ""),
        (publishing(__zzz=TYPE, __me__sensor__temperature=TYPE, __a=TYPE), True, "wrong-topic", "namespace"),
        (publishing(__scan="sensor_msgs/msg/LaserScan"), True, "no-publisher", "/node"),
        (trace(), True, "no-publisher", TOPIC),
    ],
)
def test_why_nothing_is_published(run: Trace, answers: bool, mistake: str, words: str) -> None:
    assert_told(told(Symptom.NO_MESSAGES, "", run=run, answers=answers, topic=TOPIC, type=TYPE), mistake, words)


OURS = TopicEndpoint("/chatter", "std_msgs/msg/String", "/ours")
LATCHED = QoS("reliable", "transient_local")


def subscribed(topic: str = OURS.topic, type_name: str = OURS.type, qos: QoS = OURS.qos) -> Trace:
    return trace(graph=Graph(("/node",), subscriptions=(TopicEndpoint(topic, type_name, "/node", qos),)))


@pytest.mark.parametrize(
    ("run", "answers", "mistake", "words"),
    [
        (CRASHED, True, "unhandled-exception", ""),
        (subscribed(qos=LATCHED), True, "incompatible-qos", "durability"),
        (subscribed("/chater"), True, "wrong-topic", "there is /chater, not /chatter"),
        (subscribed("/Chatter"), True, "wrong-topic", "upper and lower case"),
        (subscribed(type_name="std_msgs/msg/Int32"), True, "wrong-type", "Int32"),
        (subscribed(), False, "no-spin", "/node"),
        (subscribed(), True, "nothing-received", "/chatter"),
        (trace(), True, "no-subscription", "/chatter"),
    ],
)
def test_why_nothing_is_received(run: Trace, answers: bool, mistake: str, words: str) -> None:
    about: dict[str, Any] = {"ours": OURS, "topic": OURS.topic, "type": OURS.type}
    assert_told(told(Symptom.NOTHING_RECEIVED, "", run=run, answers=answers, **about), mistake, words)


PLAIN = ("reliable", "volatile")


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
def test_incompatible_qos(offered: tuple[Any, ...], asked: tuple[Any, ...], policy: str) -> None:
    ends = (TopicEndpoint("/a", "T", "/one", QoS(*offered)), TopicEndpoint("/a", "T", "/node", QoS(*asked)))
    run = trace(graph=Graph(("/one", "/node"), ends[:1], ends[1:]))
    found = told(Symptom.NOTHING_RECEIVED, "", run=run, topic="/a", type="T")
    assert_told(found, "incompatible-qos" if policy else "nothing-received", policy)


@pytest.mark.parametrize("qos", [("best_effort", "volatile"), ("reliable", "transient_local")])
def test_a_service_with_an_unusual_qos(qos: tuple[str, str]) -> None:
    usual, unusual = ServiceEndpoint("/add", "T", "/node"), ServiceEndpoint("/divide", "T", "/node", *qos)
    run = trace(graph=Graph(("/node",), servers=(usual, unusual)))
    assert_told(told(Symptom.NO_ANSWER, "", run=run, service="/divide"), "incompatible-qos-of-a-service", "/divide")
    assert_told(told(Symptom.NO_ANSWER, "", run=run, service="/add"), "no-answer")


def test_two_nodes_of_one_name() -> None:
    run = trace(graph=Graph(("/p", "/p")))
    assert_told(told(Symptom.WRONG_RATE, "", run=run), "second-node-of-the-same-name", "2 nodes called /p")


LIFECYCLE = """\
class Sensor(LifecycleNode):
    def on_activate(self, state):
        return {}


def main():
    sensor = Sensor()
    {}
"""


@pytest.mark.parametrize(
    ("returns", "main", "mistake", "words"),
    [
        ("super().on_activate(state)", "", "lifecycle-node-not-activated", "nothing does that here"),
        ("super().on_activate(state)", "sensor.trigger_configure()", "lifecycle-node-not-activated", "nothing does"),
        ("SUCCESS", "sensor.trigger_activate()", "lifecycle-node-not-activated", "its on_activate does not call"),
        ("super().on_activate(state)", "sensor.trigger_activate()", "no-publisher", ""),
    ],
)
def test_a_lifecycle_node(returns: str, main: str, mistake: str, words: str) -> None:
    asleep = trace(graph=graph(services={"/sensor/change_state": "lifecycle_msgs/srv/ChangeState"}))
    source = LIFECYCLE.format(returns, main)
    assert_told(told(Symptom.NO_MESSAGES, source, run=asleep, topic=TOPIC, type=TYPE), mistake, words)


CONSOLE = "[INFO] [1763716000.125] [node]: kx7 is up"
ROSOUT = "Failed to publish log message to rosout: publisher's context is invalid, at ./src/rcl/publisher.c:423"
RCL = "rclpy._rclpy_pybind11.RCLError: failed to shutdown: rcl_shutdown already called on the given context"
RCL_LOG = "[ERROR] [1763716000.125] [rcl.logging_rosout]: Failed to publish"


@pytest.mark.parametrize(
    ("run", "at_end", "mistake"),
    [
        (trace(out="kx7: 25"), "", "printed-not-logged"),
        (trace(err="INFO:root:kx7: 25"), "", "printed-not-logged"),
        (trace(), "kx7: 25", "output-held-back-by-buffering"),
        (trace(err=CONSOLE.replace("[node]", "[sensor]")), "", "not-the-nodes-logger"),
        (trace(err=CONSOLE, logs=[log("hello")]), "", "not-the-nodes-logger"),
        (trace(err=CONSOLE), "", "rosout-switched-off"),
        (trace(err=CONSOLE, logs=[log("kx7 is up")]), "", "not-logged"),
        (trace(out="something else"), "bye", "not-logged"),
        (trace(), ROSOUT.replace("rosout", "kx7"), "not-logged"),  # ROS itself has written it
        (trace(), f"{RCL}, kx7, at /project/src/rcl/init.c:253", "not-logged"),
        (trace(err=ROSOUT.replace("context", "kx7")), "", "not-logged"),
        (trace(err=f"{RCL_LOG} kx7"), "", "not-logged"),
    ],
)
def test_output_that_was_not_logged(run: Trace, at_end: str, mistake: str) -> None:
    about: dict[str, Any] = {
        "what": "the name",
        "recognise": re.compile("kx7").search,
        "at_end": lines(at_end, "stdout"),
    }
    assert_told(told(Symptom.NOT_LOGGED, "", run=run, **about), mistake)


PRINTS = """\
import logging
log = logging.getLogger('me')
class A(Node):
    def tick(self, total, last):
        print('other: ', last)
        {}
        print('total count:', total)
"""


@pytest.mark.parametrize(
    ("code", "out", "words"),
    [
        ("print(f'sensor {name}')", "sensor kx7", "print() (line 6)"),
        ("print('name', name)", "name kx7", "print() (line 6)"),
        ("print('is', self.get('key'))", "is kx7", "print() (line 6)"),
        ("log.info('%s up', name)", "INFO:me:kx7 up", "Python's logging (line 6)"),
        ("logging.warning(f'{name} up')", "WARNING:root:kx7 up", "Python's logging (line 6)"),
        ("log.info('%s up', name)", "", "Python's logging (line 6)"),
        ("print(name)", "kx7", "print(), which"),
        ("print(f'total: {total}, last: {last}')", "total: 7, last: kx7", "line 6"),
        ("print('total:', total, 'last:', last)", "total: 7, last: kx7", "line 6"),
        ("print('total: %d, last: %s' % (total, last))", "total: 7, last: kx7", "line 6"),
        ("print('total: {}, last: {}'.format(total, last))", "total: 7, last: kx7", "line 6"),
        ("print('total: ' + str(total) + ', last: ' + last)", "total: 7, last: kx7", "line 6"),
        ("print(f'--- kx7 ---\\ntotal: {total}\\nlast: {last}\\n')", "last: kx7", "line 6"),
        ("sys.stdout.write(f'total: {total}\\n')", "total: kx7", "line 6"),
        ("text = f'sum: {total}'; print(text)", "sum: kx7", "line 6"),
        ("last = 'end: ' + last; print(last)", "end: kx7", "line 6"),
        ("file.write('sum: ')", "sum: kx7", "print(), which"),
    ],
)
def test_the_line_that_printed(code: str, out: str, words: str) -> None:
    about: dict[str, Any] = {"what": "the name", "recognise": re.compile("kx7").search}
    assert_told(told(Symptom.NOT_LOGGED, PRINTS.format(code), run=trace(out=out), **about), "printed-not-logged", words)


def test_pythons_logging_is_blamed_for_silence_only_if_the_node_logs_nothing() -> None:
    both = PRINTS.format("log.debug('x'); self.get_logger().info(name)")
    assert_told(told(Symptom.NOT_LOGGED, both, what="the name", value="kx7"), "not-logged")


QOS_IN_A_VARIABLE = "qos = QoSProfile(depth={})\nnode.create_subscription(Bool, '/parcels', on_parcel, qos)\n"


@pytest.mark.parametrize(
    ("source", "words"),
    [
        ("node.create_subscription(Bool, '/parcels', on_parcel, 7)", "holds only 7 (line 1)"),
        (QOS_IN_A_VARIABLE.format(8), "holds only 8 (line 2)"),
        ("qos = 5\nqos = 6\nnode.create_subscription(Bool, '/parcels', on_parcel, qos)", "holds fewer"),
    ],
)
def test_the_depth_of_a_queue_that_is_too_short(source: str, words: str) -> None:
    ours = TopicEndpoint("/parcels", "std_msgs/msg/Bool", "/warehouse")
    found = told(Symptom.MESSAGES_LOST, source, ours=ours, sent=60, shown=12, newest=True)
    assert_told(found, "queue-shorter-than-a-burst", words)
