"""I1.3: edits of the client's code that make it wait for each service and each answer."""

from __future__ import annotations

import textwrap
from collections.abc import Callable

import pytest

from checks.i1_3 import client_requests, steps
from checks.i1_3.code import Code
from tests.checks.builders import trace
from tutor.judge.step_parsing import apply_step

HEAD = """\
import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.node import Node


"""


def follow_step(text: str, find_step: Callable[[Code], str | None]) -> str | None:
    """The file after following the step, without HEAD; None if there is no step."""
    step = find_step(Code(HEAD + text, "node.py"))
    return None if step is None else apply_step(step, {"node.py": HEAD + text})["node.py"].removeprefix(HEAD)


def wait_for_answers_step(code: Code) -> str | None:
    return client_requests.wait_for_answers(code, trace(sources={code.file: code.text}))


SPINNING = """\
def spin():
    rclpy.spin(node)


Thread(target=spin).start()
print(client.call_async(request).result().sum)
"""


def test_an_answer_is_waited_for_without_a_spin_if_a_thread_spins() -> None:
    print_answer = "print(client.call_async(request).result().sum)"
    waits = "future = client.call_async(request)\nwhile not future.done():\n    time.sleep(0.01)\n"
    assert follow_step(SPINNING, wait_for_answers_step) == (
        f"import time\n{HEAD}{SPINNING.replace(print_answer, f'{waits}print(future.result().sum)')}"
    )
    assert "spin_until_future_complete(" in str(
        follow_step(SPINNING.replace("target=spin", "target=log"), wait_for_answers_step)
    )


ASK = """\
class Client(Node):
    def ask(self, client, request):
        {}
"""


@pytest.mark.parametrize(
    ("asks", "answers"),
    [
        (
            "future = client.call_async(request)\n        return future.result()",
            "future = client.call_async(request)\n        rclpy.spin_until_future_complete(self, future)\n"
            "        return future.result()",
        ),
        (
            "return client.call(request).sum",
            "future = client.call_async(request)\n        rclpy.spin_until_future_complete(self, future)\n"
            "        return future.result().sum",
        ),
        (
            "return client.call_async(request)",
            "future = client.call_async(request)\n        rclpy.spin_until_future_complete(self, future)\n"
            "        return future.result()",
        ),
        (
            "future = client.call_async(request)\n        return future",
            "future = client.call_async(request)\n        rclpy.spin_until_future_complete(self, future)\n"
            "        return future.result()",
        ),
        (
            "self.future = client.call_async(request)\n        while not self.future.done():\n            sleep(1)",
            "self.future = client.call_async(request)\n        rclpy.spin_until_future_complete(self, self.future)",
        ),
        (
            "future = client.call_async(request)\n        rclpy.spin_once(self)\n        print(future.result())",
            "future = client.call_async(request)\n        rclpy.spin_until_future_complete(self, future)\n"
            "        print(future.result())",
        ),
        (
            "print(client.call_async(request).result().sum)",
            "future = client.call_async(request)\n        rclpy.spin_until_future_complete(self, future)\n"
            "        print(future.result().sum)",
        ),
        (
            "client.call_async(request)",
            "future = client.call_async(request)\n        rclpy.spin_until_future_complete(self, future)\n"
            "        future.result()",
        ),
    ],
)
def test_the_client_waits_for_the_answer(asks: str, answers: str) -> None:
    assert follow_step(ASK.format(asks), wait_for_answers_step) == ASK.format(answers)


@pytest.mark.parametrize("use", ["answer = wait_for('add', future)", "print(future.result())", "spinner.spin(future)"])
def test_a_future_is_still_returned_to_a_caller_that_waits_for_it(use: str) -> None:
    caller = f"\n\ndef main(node):\n    future = node.ask(1, 2)\n    {use}\n"
    wait = "rclpy.spin_until_future_complete(self, future)"
    asks = f"future = client.call_async(request)\n        {wait}\n        return future"
    before = ASK.format("return client.call_async(request)") + caller
    assert follow_step(before, wait_for_answers_step) == ASK.format(asks) + caller


@pytest.mark.parametrize(
    "asks",
    [
        "future = client.call_async(request)\n        rclpy.spin_until_future_complete(self, future)",
        "future = client.call_async(request)\n        while not future.done():\n            rclpy.spin_once(self)",
        "future = client.call_async(request)\n        future.add_done_callback(self.got)",
        "client.call_async(request).add_done_callback(self.got)",
    ],
)
def test_a_client_that_already_waits_for_the_answer_is_left_alone(asks: str) -> None:
    assert follow_step(ASK.format(asks), wait_for_answers_step) is None


TIMER = """\
class Client(Node):
    def __init__(self):
        super().__init__("client")
        self.mine = {n: self.create_client(AddTwoInts, n) for n in ("add", "divide")}
        self.timer = self.create_timer(0.5, self.tick)

    def tick(self):
        self.timer.cancel()
        for name in self.mine:
            print(self.ask(name))

    def ask(self, name):
        return self.mine[name].call(AddTwoInts.Request(a=1, b=2)).sum
"""


@pytest.mark.parametrize("made", ["MutuallyExclusiveCallbackGroup()", "ReentrantCallbackGroup()"])
def test_answers_that_are_awaited_need_a_reentrant_group(made: str) -> None:
    own = f"        self.group = {made}\n        self.mine"
    text = TIMER.replace("        self.mine", own).replace(
        "AddTwoInts, n)", "AddTwoInts, n, callback_group=self.group)"
    )
    after = follow_step(text, wait_for_answers_step)
    group = "ReentrantCallbackGroup()" if "Exclusive" in made else "self.group"
    assert f"self.create_client(AddTwoInts, n, callback_group={group})" in str(after)


def test_a_timer_awaits_its_answers() -> None:
    after = follow_step(TIMER, wait_for_answers_step)
    assert after is not None
    assert "from rclpy.callback_groups import ReentrantCallbackGroup" in after
    assert "self.create_client(AddTwoInts, n, callback_group=ReentrantCallbackGroup())" in after
    assert "async def tick(self):" in after
    assert "print((await self.ask(name)))" in after
    assert "async def ask(self, name):" in after
    assert "return (await self.mine[name].call_async(AddTwoInts.Request(a=1, b=2))).sum" in after


@pytest.mark.parametrize(
    ("asks", "waits"),
    [
        (
            "print(client.call(request))",
            "client.wait_for_service(timeout_sec=10.0)\n        print(client.call(request))",
        ),
        (
            "for each in self.mine:\n            self.mine[each].call_async(request)",
            "for each in self.mine:\n            self.mine[each].wait_for_service(timeout_sec=10.0)\n"
            "            self.mine[each].call_async(request)",
        ),
    ],
)
def test_the_wait_for_a_service_goes_above_the_request(asks: str, waits: str) -> None:
    assert follow_step(ASK.format(asks), client_requests.wait_for_services) == ASK.format(waits)


def test_the_wait_for_a_service_goes_around_create_client_if_there_is_no_other_place() -> None:
    text = "node = rclpy.create_node('c')\nasked = [node.create_client(T, n).call_async(R) for n in NAMES]\n"
    after = follow_step(text, client_requests.wait_for_services)
    assert after is not None
    assert "asked = [waited(node.create_client(T, n)).call_async(R) for n in NAMES]" in after
    assert "def waited(client):\n    client.wait_for_service(timeout_sec=10.0)\n    return client" in after


def test_a_short_wait_is_lengthened() -> None:
    text = "if not client.wait_for_service(0.5) or not other.service_is_ready(): pass\n"
    long = "wait_for_service(timeout_sec=10.0)"
    assert follow_step(text, client_requests.lengthen_waits) == f"if not client.{long} or not other.{long}: pass\n"


ASYNC = """\
class Client(Node):
    async def ask(self, client):
        print(await client.call_async(AddTwoInts.Request()))
"""


def test_a_coroutine_that_is_never_run_becomes_a_function() -> None:
    after = follow_step(ASYNC, lambda code: client_requests.make_synchronous(code, "ask"))
    assert after == textwrap.dedent("""\
        class Client(Node):
            def ask(self, client):
                future = client.call_async(AddTwoInts.Request())
                rclpy.spin_until_future_complete(self, future)
                print(future.result())
        """)


@pytest.mark.parametrize(
    ("text", "after"),
    [
        ("NAMES = ('add', 'subtract', 'divide')\n", "NAMES = ('add', 'subtract', 'divide', 'multiply')\n"),
        ("C = [('/add', 1, 2), ('/divide', 8, 2)]\n", "C = [('/add', 1, 2), ('/divide', 8, 2), ('/multiply', 8, 2)]\n"),
        ("NAMES = ('add', 'modulo')\n", None),
    ],
)
def test_a_service_that_is_not_called_is_added_to_the_list(text: str, after: str | None) -> None:
    assert follow_step(text, lambda code: steps.add_to_list(code, ["/multiply"])) == after


@pytest.mark.parametrize(
    ("text", "after"),
    [
        ("def main(): return True\nsys.exit(main())\n", "def main(): return True\nmain()\n"),
        ("def main(): return True\nraise SystemExit(main())\n", "def main(): return True\nmain()\n"),
        ("sys.exit(1)\n", "sys.exit(0)\n"),
        (
            "def run():\n    print()\ndef main():\n    done = run()\n    if not done:\n        sys.exit(1)\n",
            "def run():\n    print()\n    return True\n"
            "def main():\n    done = run()\n    if not done:\n        sys.exit(1)\n",
        ),
        ("sys.exit(0)\n", None),
    ],
)
def test_a_program_that_did_all_its_work_exits_with_0(text: str, after: str | None) -> None:
    assert follow_step(text, steps.end_with_zero) == after


@pytest.mark.parametrize(
    ("text", "after"),
    [
        (
            "if len(sys.argv) != 3:\n    print('usage')\n    sys.exit(1)\ncall(int(sys.argv[1]), int(sys.argv[2]))\n",
            "call(12, 4)\n",
        ),
        (
            "if len(sys.argv) == 3:\n    call()\nelse:\n    sys.exit(1)\n",
            "call()\n",
        ),
        ("if len(sys.argv) < 4:\n    sys.exit(1)\ncall(sys.argv[1], int(sys.argv[2]))\n", None),
        ("call(1, 2)\n", None),
    ],
)
def test_a_client_that_wants_arguments_gets_fixed_numbers(text: str, after: str | None) -> None:
    assert follow_step(text, steps.remove_arguments) == after


def test_a_wait_that_goes_on_while_the_service_is_there() -> None:
    text = "while client.wait_for_service(1.0):\n    print('waiting')\n"
    assert follow_step(text, client_requests.negate_waits) == text.replace("while client", "while not client")
    assert follow_step(text.replace("while client", "while not client"), client_requests.negate_waits) is None


WAITS = """\
node = rclpy.create_node("client")
{spins}client = node.create_client(AddTwoInts, "add")
{before}for a in (1, 2):
{within}    future = client.call_async(AddTwoInts.Request(a=a))
{wait}    print(future.result())
"""
SPINS = "threading.Thread(target=rclpy.spin, args=(node,)).start()\n"
MADE = "answered = threading.Event()\n"
CALLBACK = "    future.add_done_callback(lambda _: answered.set())\n"
WAIT = "    answered.wait()\n"


def set_event_step(text: str) -> str | None:
    line = (HEAD + text).splitlines().index(WAIT.rstrip()) + 1
    return follow_step(text, lambda code: client_requests.set_event(code, line))


@pytest.mark.parametrize(
    ("spins", "before", "within", "instead"),
    [
        pytest.param(SPINS, "", f"    {MADE}", CALLBACK + WAIT, id="an event for each answer"),
        pytest.param(SPINS, MADE, "", f"    answered.clear()\n{CALLBACK}{WAIT}", id="one event for all"),
        pytest.param("", MADE, "", "    rclpy.spin_until_future_complete(node, future)\n", id="nothing spins"),
    ],
)
def test_an_event_that_nothing_sets_is_set_by_the_answer(spins: str, before: str, within: str, instead: str) -> None:
    text = WAITS.format(spins=spins, before=before, within=within, wait=WAIT)
    assert set_event_step(text) == WAITS.format(spins=spins, before=before, within=within, wait=instead)


@pytest.mark.parametrize("sets", ["answered.set()\n", "node.on_answer = answered.set\n"])
def test_an_event_that_something_sets_is_left_alone(sets: str) -> None:
    assert set_event_step(WAITS.format(spins=SPINS, before=MADE + sets, within="", wait=WAIT)) is None


POLLS = """\
class Calculator:
    def __init__(self, node):
        self._node = node
        self._add = node.create_client(AddTwoInts, "add")

    def add(self, request):
        future = self._add.call_async(request)
        while not future.done():
            {}
        return future.result().sum
"""


def test_a_loop_that_polls_a_future_spins_instead_of_sleeping() -> None:
    polled = POLLS.format("rclpy.spin_once(self._node, timeout_sec=0.1)")
    assert follow_step(POLLS.format("time.sleep(0.01)"), client_requests.spin_while_polling) == polled
    assert follow_step(polled, client_requests.spin_while_polling) is None


STATES = """\
import time

import rclpy
from example_interfaces.srv import AddTwoInts

rclpy.init()
node = rclpy.create_node("calculator_client")
add = node.create_client(AddTwoInts, "add")
future, state = None, "send"
while state != "done":
    if state == "send":
        future, state = add.call_async(AddTwoInts.Request(a=1, b=2)), "wait"
    elif future.done():
        state = "done"
    {}
"""


def test_a_state_machine_that_polls_a_future_spins_instead_of_sleeping() -> None:
    spins = STATES.format("rclpy.spin_once(node, timeout_sec=0.1)")
    assert follow_step(STATES.format("time.sleep(0.02)"), client_requests.spin_while_polling) == spins


def test_a_thread_that_outlives_the_client_becomes_a_daemon() -> None:
    def step(code: Code) -> str | None:
        return steps.make_thread_daemon(code, "beat")

    kept = "threading.Thread(target=self.beat, daemon=False).start()\nthreading.Thread(target=self.spin).start()\n"
    daemon = kept.replace("daemon=False", "daemon=True")
    assert follow_step(kept, step) == daemon
    assert follow_step(daemon, step) is None


LOOP = """\
def run(node):
    got = 0
    while rclpy.ok() and got {} len(NAMES):
        rclpy.spin_once(node)
        got += 1
"""


def test_a_loop_that_waits_for_one_answer_too_many() -> None:
    code = Code(LOOP.format("<="), "client.py")
    step = steps.shorten_loop(code, 4)
    assert step is not None
    assert step.endswith("line 3 becomes: while rclpy.ok() and got < len(NAMES):")
    assert steps.shorten_loop(code, 2) is None
    assert steps.shorten_loop(Code(LOOP.format("<"), "client.py"), 4) is None
