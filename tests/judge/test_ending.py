"""How a process ends on Ctrl+C: which endings are clean, and why the others are not."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import pytest

from tests.checks import builders
from tests.checks.builders import CRASH, FOLDER, KEYBOARD_INTERRUPT, assert_passed, ending, exited, trace
from tutor.judge.check import Check
from tutor.judge.ending import is_race, judge_ending, may_be_chance
from tutor.judge.trace import Ending, Trace
from tutor.judge.verdict import Status

assert_failed = partial(builders.assert_failed, check=Check("any", ()))
judge = partial(judge_ending, shown_by="another")
RCLPY = "/venv/lib/python3.12/site-packages/rclpy"
OWN_FRAME = f'  File "{FOLDER}/node.py", line 30, in main\n    rclpy.shutdown()'
HEADER = "Traceback (most recent call last):"
SHUTDOWN_TWICE = f"""{HEADER}
{OWN_FRAME}
  File "{RCLPY}/__init__.py", line 130, in shutdown
    _shutdown(context=context)
  File "{RCLPY}/context.py", line 120, in shutdown
    self.__context.shutdown()
rclpy._rclpy_pybind11.RCLError: failed to shutdown: rcl_shutdown already called on the given context"""
TRY_SHUTDOWN_RACE = SHUTDOWN_TWICE.replace("in shutdown", "in try_shutdown", 1)
EXTERNAL = f"""{HEADER}
{OWN_FRAME}
  File "{RCLPY}/executors.py", line 300, in spin
    raise ExternalShutdownException()
rclpy.executors.ExternalShutdownException"""
IGNORED_IN_DEL = f"""Exception ignored in: <function Node.__del__ at 0x7f0>
{HEADER}
  File "{RCLPY}/node.py", line 20, in __del__
    self.destroy()
ValueError: gone"""
IGNORED_IN_THREADING = f"""Exception ignored in: <module 'threading' from '/usr/lib/python3.12/threading.py'>
{HEADER}
  File "/usr/lib/python3.12/threading.py", line 1624, in _shutdown
    lock.acquire()
KeyboardInterrupt: """
AT_EXIT = f"""Exception ignored in atexit callback: <function shutdown at 0x7f0>
{HEADER}
  File "{RCLPY}/context.py", line 127, in shutdown
    raise RuntimeError('Context must be initialized before it can be shutdown')
RuntimeError: Context must be initialized before it can be shutdown"""
STILL_SPINNING = f"""Exception in thread Thread-1 (spin):
{HEADER}
{OWN_FRAME.replace("rclpy.shutdown()", "executor.spin()")}
  File "{RCLPY}/executors.py", line 308, in spin
    self._spin_once_impl()
rclpy._rclpy_pybind11.RCLError: failed to initialize wait set: the given context is not valid, either rcl_init() was"""
FATAL = f"""Fatal Python error: Segmentation fault

Current thread 0x00007f16a3a3e740 (most recent call first):
  File "{RCLPY}/node.py", line 1899 in destroy_node
  File "{FOLDER}/node.py", line 30 in main"""
PUBLISH_AFTER = f"""{HEADER}
{OWN_FRAME.replace("rclpy.shutdown()", "self.publisher.publish(msg)")}
rclpy._rclpy_pybind11.RCLError: Failed to publish: publisher's context is invalid, at ./rcl/publisher.c:423"""


@pytest.mark.parametrize(
    "end",
    [
        ending(0),
        ending(130),
        ending(signal=2),
        ending(0, err="[INFO] [1.5] [node]: bye"),
        ending(0, err=IGNORED_IN_DEL),
        ending(1, err=TRY_SHUTDOWN_RACE),
        ending(1, err=f"{TRY_SHUTDOWN_RACE}\n{IGNORED_IN_DEL}"),
        ending(1, err=f"{IGNORED_IN_DEL}\n{TRY_SHUTDOWN_RACE}"),
        ending(0, err=TRY_SHUTDOWN_RACE),
    ],
)
def test_clean_endings_pass(end: Ending) -> None:
    assert_passed(judge(trace(), end))


@pytest.mark.parametrize(
    ("end", "cause", "words"),
    [
        (ending(still_running=True), "does not end", "still running 5 s"),
        (ending(1, err=SHUTDOWN_TWICE), "shutdown() after Ctrl+C", "rclpy.shutdown() (node.py, line 30)"),
        (ending(signal=2, err=KEYBOARD_INTERRUPT), "traceback on exit", "KeyboardInterrupt"),
        (ending(130, err=KEYBOARD_INTERRUPT), "traceback on exit", "KeyboardInterrupt"),
        (ending(1, err=EXTERNAL), "traceback on exit", "Catch around line 30"),
        (ending(0, err=PUBLISH_AFTER), "used after shutdown", "node.py, line 30"),
        (ending(0, err=STILL_SPINNING), "used after shutdown", "node.py, line 30"),
        (ending(1, err=CRASH), "exception on exit", "line 12: self.nothing()"),
        (ending(0, err=CRASH), "exception on exit", "AttributeError"),
        (
            ending(1, err=f"{KEYBOARD_INTERRUPT}\n\nDuring handling of …\n\n{SHUTDOWN_TWICE}"),
            "shutdown() after Ctrl+C",
            "",
        ),
        (ending(0, err=AT_EXIT), "shutdown() after Ctrl+C", "a second shutdown()"),
        (ending(0, err=IGNORED_IN_DEL.replace(RCLPY, FOLDER)), "exception on exit", "line 20"),
        (ending(0, err=IGNORED_IN_THREADING), "threads waited for at exit", "main() has ended"),
        (ending(1), "non-zero exit", "exit code 1"),
        (ending(1, err=IGNORED_IN_DEL), "non-zero exit", "exit code 1"),
        (ending(2, err=TRY_SHUTDOWN_RACE), "non-zero exit", "exit code 2"),
        (ending(signal=15), "non-zero exit", "signal 15"),
        (ending(signal=11), "crash on exit", "signal 11"),
        (ending(signal=11, err=FATAL), "crash on exit", "crashes with signal 11 (node.py, line 30)"),
        (ending(143), "non-zero exit", "exit code 143"),
        (ending(signal=6), "crash on exit", "signal 6"),
        (ending(signal=6, err="terminate called without an active exception"), "thread still running", "join"),
    ],
)
def test_unclean_endings_fail(end: Ending, cause: str, words: str) -> None:
    assert_failed(judge(trace(), end), cause, words)


@pytest.mark.parametrize(("seen", "how"), [(trace(exit=exited(1), err=CRASH), ", with exit code 1: "), (trace(), ": ")])
def test_a_process_that_has_ended_before_ctrl_c_is_not_judged(seen: Trace, how: str) -> None:
    verdict = judge_ending(seen, None, shown_by="operations")
    assert verdict.status is Status.SKIPPED
    assert verdict.cause == f"not judged, because the process had ended before Ctrl+C{how}`operations` shows why"


def test_the_limit_is_named() -> None:
    assert "within 5 s" in judge(trace(), ending(0)).expected
    assert "within 2.5 s" in judge(trace(), Ending(None, 2.5, 2.5)).expected


def test_the_last_lines_of_output_are_shown() -> None:
    verdict = judge(trace(err="one\n\ntwo"), ending(still_running=True))
    assert verdict.evidence == ("one", "two")


@pytest.mark.parametrize(
    "end",
    [
        ending(signal=11),
        ending(signal=7),
        ending(signal=6),
        ending(signal=11, err=FATAL),
        ending(signal=6, err="terminate called without an active exception"),
        ending(0, err=STILL_SPINNING),
        ending(1, err=STILL_SPINNING),
        ending(1, err=STILL_SPINNING.replace("initialize wait set", "create timer")),
        ending(1, err=TRY_SHUTDOWN_RACE),
        ending(1, err=f"{STILL_SPINNING}\n{TRY_SHUTDOWN_RACE}"),
    ],
)
def test_endings_that_may_be_chance(end: Ending) -> None:
    assert may_be_chance(end)


@pytest.mark.parametrize(
    "end",
    [
        None,
        ending(0),
        ending(139),
        ending(signal=2),
        ending(signal=9),
        ending(signal=15),
        ending(still_running=True),
        ending(signal=6, err=KEYBOARD_INTERRUPT),
        ending(1, err=f"{STILL_SPINNING}\n{KEYBOARD_INTERRUPT}"),
        ending(1, err=f"{TRY_SHUTDOWN_RACE}\n{KEYBOARD_INTERRUPT}"),
        ending(1, err=SHUTDOWN_TWICE),
        ending(1, err=PUBLISH_AFTER),
        ending(1, err=STILL_SPINNING.replace("executors.py", "publisher.py")),
    ],
)
def test_endings_that_are_never_chance(end: Ending | None) -> None:
    assert not may_be_chance(end)


@pytest.mark.parametrize(("cpu_wait_share", "chance"), [(0.0, False), (0.1, False), (0.2, True), (1.5, True)])
def test_a_process_that_goes_on_may_be_chance_on_a_busy_machine_only(cpu_wait_share: float, chance: bool) -> None:
    assert may_be_chance(Ending(None, 5.0, 5.0, cpu_wait_share=cpu_wait_share)) == chance


def test_a_traceback_on_stdout_is_one_as_well() -> None:
    end = ending(0, err=KEYBOARD_INTERRUPT)
    end = replace(end, output=tuple(replace(line, stream="stdout") for line in end.output))
    assert_failed(judge(trace(), end), "traceback on exit", "KeyboardInterrupt")


def test_an_older_exception_that_is_printed_does_not_matter() -> None:
    end = ending(0, err=CRASH)
    end = replace(end, output=tuple(replace(line, stream="stdout") for line in end.output))
    assert_passed(judge(trace(), end))


@pytest.mark.parametrize(
    ("err", "race"),
    [("", False), (STILL_SPINNING, True), (TRY_SHUTDOWN_RACE, True), (PUBLISH_AFTER, False), (SHUTDOWN_TWICE, False)],
)
def test_an_exit_code_may_come_from_a_race_in_rclpy(err: str, race: bool) -> None:
    assert is_race(ending(1, err=err).output) == race
