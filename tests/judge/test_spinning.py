"""A program that does not spin: the line at which it blocks or ends, and what to write there."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.checks.builders import FOLDER, NODE_UP, exited, trace
from tutor.judge.causes import diagnose_no_answer, diagnose_process
from tutor.judge.causes.spinning import (
    diagnose_nap_between_spins,
    diagnose_spin_in_constructor,
    diagnose_untimed_spin_once,
    diagnose_untimed_spins_in_turn,
)
from tutor.judge.causes.topics import diagnose_no_messages
from tutor.judge.rewriting.node import node_file
from tutor.judge.trace import Trace
from tutor.judge.tracebacks import Frame

NODE = """\
class Talker(Node):
    def __init__(self):
        super().__init__('talker')
        self.pub = self.create_publisher(String, 'chatter', 10)

    def tick(self):
        self.pub.publish(String(data='Hello'))


def main():
    rclpy.init()
    talker = Talker()
    {body}


main()
"""


def started(*body: str, **more: object) -> Trace:
    return replace(trace(graph=NODE_UP, **more), sources={"node.py": NODE.format(body="\n    ".join(body))})  # type: ignore[arg-type]


def stack_at(line: int, code: str, function: str = "main") -> tuple[Frame, ...]:
    path = f"{FOLDER}/node.py"
    return Frame(path, line, function, code, 1), Frame(path, 99, "<module>", "main()", 1)


@pytest.mark.parametrize(
    ("body", "stuck", "text", "step"),
    [
        (
            ["while rclpy.ok():", "    time.sleep(0.1)"],
            stack_at(14, "time.sleep(0.1)"),
            "stays at node.py, line 14: time.sleep(0.1), in the loop of line 13: while rclpy.ok():",
            "lines 13 to 14 become: rclpy.spin(talker)",
        ),
        (
            ["while True:", "    time.sleep(0.5)", "rclpy.spin(talker)"],
            stack_at(14, "time.sleep(0.5)"),
            "while True:",
            "remove lines 13 to 14",
        ),
        (
            ["while True:", "    talker.tick()", "    time.sleep(0.5)"],
            stack_at(15, "time.sleep(0.5)"),
            "line 15",
            "lines 13 to 15 become:\n    talker.create_timer(0.5, talker.tick)\n    rclpy.spin(talker)",
        ),
        (
            ["while True:", "    talker.tick()", "    time.sleep(0.5)", "rclpy.spin(talker)"],
            stack_at(15, "time.sleep(0.5)"),
            "line 15",
            "lines 13 to 15 become: talker.create_timer(0.5, talker.tick)",
        ),
        (
            ["while True:", "    m = String()", "    talker.pub.publish(m)", "    time.sleep(1)"],
            stack_at(16, "time.sleep(1)"),
            "line 16",
            "lines 13 to 16 become:\n    def on_timer():\n        m = String()\n        talker.pub.publish(m)\n"
            "    talker.create_timer(1, on_timer)\n    rclpy.spin(talker)",
        ),
        (["time.sleep(60)"], stack_at(13, "time.sleep(60)"), "line 13", "line 13 becomes: rclpy.spin(talker)"),
        (
            ["input()", "rclpy.spin(talker)"],
            stack_at(13, "input()"),
            "line 13",
            "remove line 13: input()",
        ),
    ],
)
def test_where_a_program_blocks_instead_of_spinning(
    body: list[str], stuck: tuple[Frame, ...], text: str, step: str
) -> None:
    found = diagnose_no_answer(started(*body), stuck)
    assert found.name == "no spin"
    assert text in found.text
    assert step in found.hint
    assert ("rclpy.spin" in found.hint) == ("rclpy.spin" in step)


def test_a_loop_counter_moves_into_the_timer_callback() -> None:
    body = ["n = 0", "while not talker.done:", "    n += 1", "    print(n)", "    time.sleep(0.5)"]
    found = diagnose_no_answer(started(*body), stack_at(17, "time.sleep(0.5)"))
    code = (
        "def on_timer():\n        nonlocal n\n        if not talker.done:\n            n += 1\n            print(n)\n"
    )
    assert f"lines 14 to 17 become:\n    {code}" in found.hint


def test_the_spin_goes_above_the_cleanup() -> None:
    found = diagnose_process(started("talker.tick()", "talker.destroy_node()", exit=exited(0)))
    assert found is not None
    assert found.hint == "write above line 14, with the same indentation: rclpy.spin(talker)"


def test_a_loop_in_the_constructor_becomes_a_timer() -> None:
    code = NODE.replace("\n    def tick", "        while True:\n            self.tick()\n\n    def tick", 1)
    seen = replace(started("rclpy.spin(talker)"), sources={"node.py": code.format(body="rclpy.spin(talker)")})
    found = diagnose_no_answer(seen, stack_at(6, "self.tick()", "__init__"))
    assert "lines 5 to 6 become: self.create_timer(1.0, self.tick)" in found.hint
    assert "rclpy.spin" not in found.hint


def test_a_program_that_spins_is_not_told_to_spin() -> None:
    for stuck in ((), stack_at(13, "rclpy.spin(talker)")):
        assert "stays" not in diagnose_no_answer(started("rclpy.spin(talker)"), stuck).text


@pytest.mark.parametrize(
    ("body", "step"),
    [
        (["rclpy.spin_once(talker)"], "line 13 becomes: rclpy.spin(talker)"),
        (["rclpy.spin_once(talker, timeout_sec=0.1)"], "line 13 becomes: rclpy.spin(talker)"),
        (["import rclpy as rp", "rp.spin_once(talker)"], "line 14 becomes: rp.spin(talker)"),
        (["ex = SingleThreadedExecutor()", "ex.spin_once()"], "line 14 becomes: ex.spin()"),
        (["ex = SingleThreadedExecutor()", "ex.spin_once(0.1)"], "line 14 becomes: ex.spin()"),
        (["talker.tick()"], "write below line 13, with the same indentation: rclpy.spin(talker)"),
    ],
)
def test_a_program_that_ends_is_told_where_to_spin(body: list[str], step: str) -> None:
    found = diagnose_process(started(*body, exit=exited(0)))
    assert found is not None
    assert (found.name, found.hint) == ("exit at once", step)


@pytest.mark.parametrize("body", ["rclpy.spin(talker)", "while ok():\n        rclpy.spin_once(talker)"])
def test_a_program_that_ends_despite_a_spin_is_not_told_that_it_never_spins(body: str) -> None:
    found = diagnose_process(started(body, exit=exited(0)))
    assert found is not None
    assert "never spins" not in found.text


def test_a_node_that_spins_in_its_constructor_spins_in_main_instead() -> None:
    source = (
        "import rclpy\nfrom rclpy.node import Node\n\n\nclass Base(Node):\n    def __init__(self):\n"
        "        super().__init__('n')\n        self.start()\n\n    def start(self):\n        rclpy.spin(self)\n\n\n"
        "class Calculator(Base):\n    def __init__(self):\n        super().__init__()\n        self.made = True\n\n\n"
        "def main():\n    rclpy.init()\n    node = Calculator()\n    node.destroy_node()\n"
    )
    found = diagnose_spin_in_constructor(node_file(source))
    assert found is not None
    assert found.hint == (
        "write below line 22, with the same indentation: rclpy.spin(node)\nremove line 8: self.start()"
    )
    assert diagnose_spin_in_constructor(node_file(source.replace("        self.start()\n", ""))) is None


def test_a_node_that_is_only_created_is_spun_where_it_is_created() -> None:
    source = (
        "class Talker(Node):\n    def __init__(self):\n        super().__init__('talker')\n        rclpy.spin(self)\n"
        "        self.create_timer(1.0, self.tick)\n\n\nTalker()\n"
    )
    found = diagnose_spin_in_constructor(node_file(source))
    assert found is not None
    assert found.hint == "line 8 becomes: rclpy.spin(Talker())\nremove line 4: rclpy.spin(self)"


def test_a_spin_at_the_end_of_the_constructor_hides_nothing() -> None:
    source = "class Talker(Node):\n    def __init__(self):\n        super().__init__('talker')\n{}\nnode = Talker()\n"
    spin, create = ("        " + code for code in ("rclpy.spin(self)\n", "self.create_publisher(String, 'a', 1)\n"))
    for statements, cause in ((spin + create, "no spin"), (create + spin, "no publisher")):
        started_trace = replace(trace(graph=NODE_UP), sources={"node.py": source.format(statements)})
        found = diagnose_no_messages(started_trace, "/chatter", "std_msgs/msg/String", answers=True)
        assert found.name == cause


def test_a_nap_between_two_callbacks_is_removed() -> None:
    loop = "while rclpy.ok():\n    executor.spin_once(timeout_sec=0.2)\n    time.sleep(0.2)\n"
    found = diagnose_nap_between_spins(node_file(loop))
    assert found is not None
    assert found.hint == "remove line 3: time.sleep(0.2)"
    assert diagnose_nap_between_spins(node_file(loop.replace("spin_once", "work"))) is None


@pytest.mark.parametrize(
    ("loop", "step"),
    [
        (
            ["talker.tick()", "rclpy.spin_once(talker)", "time.sleep(1 / 2)"],
            ["wake_up = time.monotonic() + 1 / 2", "rclpy.spin_once(talker, timeout_sec=left)"],
        ),
        (["rclpy.spin_once(talker)", "talker.tick()"], []),  # how often is unknown
        (["talker.tick()", "rclpy.spin_once(talker, timeout_sec=0.1)", "time.sleep(0.1)"], None),
        (["rclpy.spin_once(talker)", "time.sleep(0.1)"], None),
    ],
)
def test_a_loop_that_publishes_stops_in_a_spin_once_that_waits_for_a_callback(
    loop: list[str], step: list[str] | None
) -> None:
    file = node_file(NODE.format(body="while rclpy.ok():\n        " + "\n        ".join(loop)))
    found = diagnose_untimed_spin_once(file)
    if step is None:
        assert found is None
    else:
        assert found is not None
        assert all(part in found.hint for part in step)


def test_a_spin_once_for_each_node_in_turn_gets_a_timeout() -> None:
    loop = "while rclpy.ok():\n    for node in self.nodes:\n        rclpy.spin_once(node, executor=self.executor)\n"
    found = diagnose_untimed_spins_in_turn(node_file(loop))
    assert found is not None
    assert found.hint == "line 3 becomes: rclpy.spin_once(node, executor=self.executor, timeout_sec=0.1)"


@pytest.mark.parametrize(
    "loop",
    [
        "for node in nodes:\n    rclpy.spin_once(node, timeout_sec=0.1)",
        "for future in futures:\n    while not future.done():\n        rclpy.spin_once(talker)",
        "while rclpy.ok():\n    rclpy.spin_once(talker)",
    ],
)
def test_other_calls_of_spin_once_are_left_alone(loop: str) -> None:
    assert diagnose_untimed_spins_in_turn(node_file(loop)) is None
