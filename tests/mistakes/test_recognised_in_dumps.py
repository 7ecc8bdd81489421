"""Which mistake is told from a dump of the threads' stacks: where a node that answers nothing is stuck."""

from __future__ import annotations

import pytest

from tests.checks.builders import CRASHED, FOLDER, lines
from tests.mistakes.cases import assert_told, told
from tutor.judge.symptom import Symptom
from tutor.judge.tracebacks import Frame, dumped_frames, frames_by_thread

NODE = """\
class Talker(Node):
    def __init__(self):
        super().__init__('talker')

    def tick(self):
        self.pub.publish(String(data='Hello'))


def main():
    talker = Talker()
    {}


main()
"""


def own(line: int, code: str, function: str = "tick", thread: int = 1) -> Frame:
    return Frame(f"{FOLDER}/node.py", line, function, code, thread)


def rclpy(function: str, file: str = "executors", thread: int = 1) -> Frame:
    return Frame(f"/lib/rclpy/{file}.py", 90, function, "", thread)


def main(line: int, code: str, function: str = "main") -> tuple[Frame, ...]:
    return own(line, code, function), own(99, "main()", "<module>")


@pytest.mark.parametrize(
    ("body", "stuck", "mistake", "words"),
    [
        ("while rclpy.ok():\n        time.sleep(0.1)", main(12, "time.sleep(0.1)"), "no-spin", "stays at line 12 of"),
        ("time.sleep(60)", main(11, "time.sleep(60)"), "no-spin", "line 11 of node.py, time.sleep(60)"),
        ("input()\n    rclpy.spin(talker)", main(11, "input()"), "no-spin", "node.py:11"),
        ("rclpy.spin(talker)", main(4, "self.tick()", "__init__"), "no-spin", "line 4"),
        ("rclpy.spin(talker)", main(11, "rclpy.spin(talker)"), "no-spin", "are never run"),
        ("rclpy.spin(talker)", (), "no-answer", ""),
        ("", (), "no-spin", "are never run"),
        ("rclpy.spin(talker)", (rclpy("spin"), *main(11, "rclpy.spin(talker)")), "no-answer", ""),
    ],
)
def test_where_a_program_stays_instead_of_spinning(
    body: str, stuck: tuple[Frame, ...], mistake: str, words: str
) -> None:
    found = told(Symptom.NO_ANSWER, NODE.format(body), stuck=stuck, answers=False)
    assert_told(found, mistake, words)
    assert not stuck or "rclpy.spin(talker)" not in found.cause


SPINS = """\
class Base(Node):
    def __init__(self):
        super().__init__('n')
        self.start()

    def start(self):
        rclpy.spin(self)


class Calculator(Base):
    def __init__(self):
        super().__init__()
        self.made = True


node = Calculator()
"""
AT_END = "class Talker(Node):\n    def __init__(self):\n        super().__init__('talker')\n{}\nnode = Talker()\n"
SPIN, MAKE = "        rclpy.spin(self)\n", "        self.create_service(Trigger, 'ring', self.ring)\n"


@pytest.mark.parametrize(
    ("source", "mistake", "words"),
    [
        (SPINS, "spins-in-the-constructor", "line 4"),
        (SPINS.replace("        self.start()\n", ""), "service-missing", ""),
        (AT_END.format(SPIN + MAKE), "spins-in-the-constructor", "line 4"),
        (AT_END.format(MAKE + SPIN), "service-missing", ""),  # it hides nothing
    ],
)
def test_a_node_that_spins_in_its_constructor(source: str, mistake: str, words: str) -> None:
    assert_told(told(Symptom.SERVICE_MISSING, source), mistake, words)


WORKER = (rclpy("await_or_execute"), Frame("/lib/concurrent/futures/thread.py", 58, "run", "", 1))
EXECUTOR = (rclpy("spin", thread=2), own(42, "executor.spin()", "main", 2))
SLEEPS = (own(20, "time.sleep(3.0)", thread=3), rclpy("await_or_execute", thread=3))


@pytest.mark.parametrize(
    ("source", "stuck", "mistake", "words"),
    [
        ("", (own(12, "time.sleep(9)"), rclpy("spin"), own(30, "rclpy.spin(node)", "main")), "blocked-executor", "12"),
        ("", (rclpy("call", "client"), own(31, "self.cli.call(q)"), *WORKER, *EXECUTOR), "deadlock-by-call", "line 31"),
        (
            "",
            (rclpy("call", "client"), own(12, "self.cli.call(q)"), rclpy("spin"), own(30, "rclpy.spin(node)", "main")),
            "deadlock-by-call",
            "keeps the executor busy",
        ),
        (
            "",
            (rclpy("spin_once"), own(9, "rclpy.spin_until_future_complete(self, f)"), *WORKER, *EXECUTOR),
            "spin-inside-a-callback",
            "line 9",
        ),
        ("", (rclpy("spin_once"), own(9, "rclpy.spin_once(self)"), *WORKER, *EXECUTOR), "spin-inside-a-callback", "9"),
        ("", (own(8, "with self.lock:"), *WORKER, *EXECUTOR), "waits-for-a-lock", "nothing will release it"),
        (
            "",
            (*SLEEPS, own(8, "with self.lock:"), *WORKER, *EXECUTOR),
            "waits-for-a-lock",
            "which another callback holds at line 20",
        ),
        (
            "while not future.done():\n    time.sleep(0.1)",
            (own(2, "time.sleep(0.1)"), *WORKER, *EXECUTOR),
            "polls-a-future",
            "waits for future",
        ),
        (
            "",
            (Frame("/lib/threading.py", 3, "wait", "", 1), own(8, "self.event.wait()"), *WORKER, *EXECUTOR),
            "blocked-executor",
            "nothing has ended this wait",
        ),
        ("", (own(8, "while True:"), *WORKER, *EXECUTOR), "blocked-executor", "line 8"),
        ("x = 1", EXECUTOR, "no-answer", ""),
    ],
)
def test_where_a_callback_is_stuck(source: str, stuck: tuple[Frame, ...], mistake: str, words: str) -> None:
    found = told(Symptom.NO_ANSWER, source, stuck=stuck)
    assert_told(found, mistake, words)
    assert "line 42" not in found.cause  # main() is where it should be


def test_a_callback_that_spins_although_no_dump_shows_it() -> None:
    source = (
        "class N(Node):\n  def __init__(self):\n    self.create_timer(1.0, self.tick)\n\n"
        "  def tick(self):\n    rclpy.spin_until_future_complete(self, future)\n"
    )
    assert_told(told(Symptom.NO_ANSWER, source, stuck=EXECUTOR), "spin-inside-a-callback", "line 6")


def test_an_exception_comes_before_what_a_dump_shows() -> None:
    stuck = (own(12, "time.sleep(9)"), *WORKER)
    assert_told(told(Symptom.NO_ANSWER, "", run=CRASHED, stuck=stuck), "unhandled-exception")


def test_the_threads_of_a_dump_are_kept_apart() -> None:
    text = """Fatal Python error: Aborted

Thread 0x00007f16a3a3e740 (most recent call first):
  File "/home/me/ws/node.py", line 8 in tick
  File "/lib/rclpy/executors.py", line 9 in handler

Current thread 0x00007f16a3a3e741 (most recent call first):
  File "/lib/rclpy/executors.py", line 3 in spin
  File "/home/me/ws/node.py", line 42 in main"""
    threads = frames_by_thread(dumped_frames(lines(text)))
    assert [[frame.line for frame in thread] for thread in threads] == [[8, 9], [3, 42]]
