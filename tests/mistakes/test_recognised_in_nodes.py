"""Which mistake is told for nodes that are up, but do not work, from their code; and for code that is right, none."""

from __future__ import annotations

import pytest

from tests.checks.builders import log, trace
from tests.mistakes.cases import assert_told, told
from tutor.judge.symptom import Symptom
from tutor.judge.trace import Level
from tutor.ros_model import Graph, ServiceEndpoint

CLASS = "class N(Node):\n  def __init__(self):\n    super().__init__('n')\n"
MAIN = "def main():\n  helper = rclpy.create_node('h')\n  own = N()\n  rclpy.spin({})\n"
TIMED = CLASS + "    self.create_timer(1.0, self.go)\n"
FOR_EACH = "def main():\n  for node in nodes:\n    ex = SingleThreadedExecutor()\n    ex.add_node(node)\n  ex.spin()\n"
PAIR = "class {}(Node):\n  def __init__(self):\n    super().__init__('n')\n    self.create_timer(1.0, self.go)\n".format
TWO = f"import rclpy\n{PAIR('A')}{PAIR('B')}def main():\n  one = A()\n  two = B()\n"
HELPER = TWO.replace("    self.create_timer(1.0, self.go)\n", "", 1)  # the first has nothing to serve
SPINS = "import rclpy\nx, y = A(), B()\n"
TAKEN = "e = SingleThreadedExecutor()\nn = A()\ne.add_node(n)\n{}\ne.spin()\n"

AWAITS = "async def add(self, q, r):\n  other = await self.cli.call_async(q)\nself.create_service(A, 'add', self.add)"


@pytest.mark.parametrize(
    ("source", "mistake", "words"),
    [
        (f"{CLASS}    self._services: dict = {{}}\n", "attribute-of-node-overwritten", "self._services"),
        (f"{CLASS}    self._timers = []\n", "attribute-of-node-overwritten", "line 4"),
        (f"{CLASS}    self._subscriptions = []\n", "attribute-of-node-overwritten", "line 4"),
        (f"{CLASS}    self.services_ = []\n", "no-answer", ""),
        ("class A:\n  def f(self):\n    self._timers = 1\n", "no-answer", ""),
        (f"{CLASS}    timers = []\n", "no-answer", ""),
        (TIMED + MAIN.format("helper"), "another-node-spun", "not those of own"),
        (TIMED + MAIN.format("own"), "no-answer", ""),
        (f"{TWO}  rclpy.spin(two)\n", "another-node-spun", "not those of one"),
        (f"{TWO}  rclpy.spin(one)\n", "another-node-spun", "not those of two"),
        (f"{TWO}  executor.add_node(one)\n  rclpy.spin(two)\n", "no-answer", ""),
        (f"{TWO}  rclpy.spin(one)\n  rclpy.spin(two)\n", "second-spin", "is never reached"),
        (f"{HELPER}  rclpy.spin(two)\n", "no-answer", ""),
        (FOR_EACH, "another-executor-for-each-node", "line 5 spins only the last"),
        (FOR_EACH.replace("  ex.spin", "    ex.spin"), "second-spin", ""),
        (FOR_EACH.replace("ex.spin", "other.spin"), "no-answer", ""),
        (FOR_EACH.replace("ex.add", "a.add"), "no-answer", ""),
        (f"{SPINS}rclpy.spin(x)\nrclpy.spin(y)\n", "second-spin", "line 4"),
        (f"{SPINS}a.add_node(x)\nb.add_node(y)\na.spin()\nb.spin()\n", "second-spin", "line 6"),
        (
            f"{SPINS}for n in (x, y):\n  n.greet()\n  rclpy.spin(n)\n",
            "second-spin",
            "line 5 is not reached a second time",
        ),
        (f"{SPINS}if second:\n  rclpy.spin(y)\nelse:\n  rclpy.spin(x)\n", "no-answer", ""),
        (f"{SPINS}rclpy.spin(x)\n", "no-answer", ""),
        (TAKEN.format("rclpy.spin_once(n, timeout_sec=0.3)"), "node-taken-from-its-executor", "line 4"),
        (TAKEN.format("rclpy.spin_until_future_complete(n, f)"), "node-taken-from-its-executor", "line 4"),
        (TAKEN.format("rclpy.spin_once(other)"), "no-answer", ""),
        (TAKEN.format("e.spin_once()"), "no-answer", ""),
        (AWAITS, "deadlock-by-await", "line 2"),
        (AWAITS.replace("self.add)", "self.other)"), "no-answer", ""),
        (f"{AWAITS}\ngroup = ReentrantCallbackGroup()", "no-answer", ""),
    ],
)
def test_why_nothing_answers(source: str, mistake: str, words: str) -> None:
    assert_told(told(Symptom.NO_ANSWER, source), mistake, words)


OUTER = """\
class Robot(Node):
    def __init__(self):
        super().__init__('robot')
        self.arm = Arm()


def main():
    robot = Robot()
    {}
"""
ARM = "class Arm(Node):\n    def __init__(self):\n        self.create_timer(1.0, self.move)\n"


@pytest.mark.parametrize(
    ("spin", "mistake"),
    [
        ("rclpy.spin(robot)", "another-node-spun"),
        ("executor.add_node(robot)", "another-node-spun"),
        ("executor.add_node(robot)\n    executor.add_node(robot.arm)", "no-answer"),
    ],
)
def test_a_node_inside_of_another_one(spin: str, mistake: str) -> None:
    assert_told(told(Symptom.NO_ANSWER, OUTER.format(spin), files={"arm.py": ARM}), mistake)


UNCALLED = (
    f"import rclpy\n{CLASS}    self.count = 0\n  def init(self):\n    self.create_service(Add, 'add', self.add)\n"
)
OPENS = "class N(Node):\n  def open(self):\n    self.create_service(A, 'add', f)\nn = N()\nrclpy.spin(n)\n"


@pytest.mark.parametrize(
    ("source", "mistake"),
    [
        (UNCALLED, "setup-not-called"),
        (f"{UNCALLED}rclpy.init()\n", "setup-not-called"),
        (f"{UNCALLED}node = N()\nnode.init()\n", "service-missing"),
        (f"{UNCALLED}getattr(N(), 'init')()\n", "service-missing"),
        (OPENS, "setup-not-called"),
        (f"def open(node):\n  {OPENS.splitlines()[2].strip()}\ndef main():\n  n = N()\n", "setup-not-called"),
    ],
)
def test_a_service_that_is_made_in_a_function_that_nothing_calls(source: str, mistake: str) -> None:
    assert_told(told(Symptom.SERVICE_MISSING, source, service="/add"), mistake)


@pytest.mark.parametrize(
    "loop", ["while not arm.wait_for_service(timeout_sec=1.0):", "while not arm.service_is_ready():"]
)
def test_a_wait_for_a_service_that_nobody_offers(loop: str) -> None:
    source = f"arm = node.create_client(Trigger, 'arm')\n{loop}\n    print('no arm yet')\n"
    arm = ServiceEndpoint("/arm", "std_srvs/srv/Trigger", "/n", "reliable")
    alone = trace(graph=Graph(("/n",), clients=(arm,)))
    assert_told(told(Symptom.SERVICE_MISSING, source, run=alone), "waits-for-a-service", "line 2 waits for /arm,")
    served = trace(graph=Graph(("/n",), servers=(arm,), clients=(arm,)))
    assert_told(told(Symptom.SERVICE_MISSING, source, run=served), "service-missing")


@pytest.mark.parametrize(
    ("source", "mistake", "words"),
    [
        ("os.environ['ROS_DOMAIN_ID'] = '42'\n", "another-domain", "line 1"),
        ("rclpy.init(args=args, domain_id=42)", "another-domain", "line 1"),
        ("print(os.environ['ROS_DOMAIN_ID'])", "no-node", ""),
        ("rclpy.init(args=args)", "no-node", ""),
    ],
)
def test_why_there_is_no_node(source: str, mistake: str, words: str) -> None:
    assert_told(told(Symptom.NO_MESSAGES, source, run=trace(graph=Graph())), mistake, words)


LAMBDA = """\
class Talker(Node):
    def __init__(self):
        self.create_timer(1.0, lambda: self.tick())

    async def tick(self):
        self.publish()
"""
WARNING = "/n.py:9: RuntimeWarning: coroutine '{}' was never awaited"


@pytest.mark.parametrize(
    ("out", "mistake", "words"),
    [
        (WARNING.format("Talker.tick"), "coroutine-not-awaited", "node.py:5"),
        (WARNING.format("f.<locals>.go"), "coroutine-not-awaited", "go is an async def"),
        ("", "no-messages", ""),
    ],
)
def test_a_coroutine_of_which_python_says_that_nothing_awaits_it(out: str, mistake: str, words: str) -> None:
    source = f"{LAMBDA}        self.pub.publish(String())\n"
    assert_told(told(Symptom.NO_MESSAGES, source, run=trace(out=out)), mistake, words)


@pytest.mark.parametrize(
    ("made", "wake", "mistake"),
    [
        ("asyncio.Event()", "done.set()", "event-loop-not-woken"),
        ("asyncio.get_event_loop().create_future()", "done.set_result(f.result())", "event-loop-not-woken"),
        ("asyncio.Future()", "done.set_result(7)", "event-loop-not-woken"),
        ("threading.Event()", "done.set()", "calls-missing"),
        ("rclpy.task.Future()", "done.set_result(7)", "calls-missing"),
        ("asyncio.Event()", "print('done')", "calls-missing"),
    ],
)
def test_what_wakes_the_event_loop_of_asyncio(made: str, wake: str, mistake: str) -> None:
    source = f"import asyncio\n\ndone = {made}\nfuture.add_done_callback(lambda f: {wake})\n"
    assert_told(told(Symptom.CALLS_MISSING, source), mistake, "line 4" if mistake != "calls-missing" else "")


SET_LEVEL = "x = 1\nself.get_logger().set_level(LoggingSeverity.{})\n"


@pytest.mark.parametrize(
    ("source", "lowest", "mistake"),
    [
        (SET_LEVEL.format("WARN"), Level.FATAL, "log-level-raised"),
        (
            "x = 1\nrclpy.logging.set_logger_level('n', rclpy.logging.LoggingSeverity.ERROR)",
            Level.ERROR,
            "log-level-raised",
        ),
        (SET_LEVEL.format("WARN"), Level.INFO, "not-logged"),
        (SET_LEVEL.format("DEBUG"), Level.FATAL, "not-logged"),
        ("x = 1\nself._logger = logging.getLogger('n')\n", Level.FATAL, "nodes-logger-replaced"),
        ("self.log = logging.getLogger('n')\nself._logger = self.get_logger()\n", Level.FATAL, "not-logged"),
    ],
)
def test_why_a_message_is_not_logged(source: str, lowest: Level, mistake: str) -> None:
    found = told(Symptom.NOT_LOGGED, source, lowest_level=lowest)
    assert_told(found, mistake, "line 2" if mistake != "not-logged" else "")


NEVER_NONE = """from rclpy.node import Node

class Stats(Node):
    def __init__(self):
        super().__init__('stats')
        self.start = {}
        self.last = None

    def callback(self, message):
        if self.start is None:
            self.start = self.get_clock().now()
        if self.last is None:
            self.last = 1
"""
SHARED = "class Stats:\n    def __init__(self):\n        self.first = self.last = {}\n"
JOINED = """def report(log, total):
    rate = total / 2.0
    log(f"total {total}, "
        "rate {rate:.2f}")
    log("first {}".format(total))
"""
CLOSURE = "for n, op in OPS:\n  self.create_service(T, n, lambda q, r{}: self.do(op, q, r))"


@pytest.mark.parametrize(
    ("source", "mistake", "words"),
    [
        ("t = 10^9", "caret-is-no-power", "Write 10**9"),
        ("t = ns // 10 ^ 9 >= limit", "caret-is-no-power", "10**9"),
        ("x = a ^ b\nt = 3 * 10^6", "caret-is-no-power", "line 2"),
        ("n = 2^8 - 1", "caret-is-no-power", "2**8"),
        ("x = a ^ 1", "wrong-log", ""),
        ("x = a ^ b", "wrong-log", ""),
        ("x ^= 10", "wrong-log", ""),
        ("t = 10**9", "wrong-log", ""),
        ("x = 7 ^ 3", "wrong-log", ""),
        (NEVER_NONE.format("0.0"), "never-none", "starts as 0.0"),
        (NEVER_NONE.format("None"), "wrong-log", ""),
        (NEVER_NONE.format("self.stored()"), "wrong-log", ""),
        (SHARED.format("{'text': ''}"), "one-object-two-names", "self.first and self.last"),
        (SHARED.format("None"), "wrong-log", ""),
        (JOINED, "no-f-in-front-of-the-text", "line 4"),
        (CLOSURE.format(""), "late-binding", "op"),
        (CLOSURE.format(", op=op"), "wrong-log", ""),
    ],
)
def test_slips_of_python(source: str, mistake: str, words: str) -> None:
    run = trace(logs=[log("total 10, rate {rate:.2f}")])
    assert_told(told(Symptom.WRONG_LOG, source, run=run), mistake, words)


def test_braces_that_nobody_saw_are_no_missing_f() -> None:
    assert_told(told(Symptom.WRONG_LOG, JOINED, run=trace(logs=[log("total 10, rate 5.00")])), "wrong-log")
