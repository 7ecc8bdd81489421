"""The command line as a process: streams, terminals, signals, and what it imports."""

from __future__ import annotations

import io
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from rich.console import Console

from tests.cli.fake_engine import FAILURE
from tests.cli.terminals import LIMIT_S, run_in_terminals
from tests.failures import failure
from tutor.cli.progress_display import ProgressDisplay, _Line
from tutor.content import load_course
from tutor.judge.events import CriterionJudged
from tutor.judge.result import CriterionResult

WITH_FAKE_ENGINE = """
import asyncio, sys
import tutor.engine
from tutor.cli import main
from tests.cli.fake_engine import FAILURE, FakeEngine

class Slow(FakeEngine):
    async def __call__(self, submissions, course, *, only, on_event, first=False):
        report = await super().__call__(submissions, course, only=only, on_event=on_event, first=first)
        if "--slow" in sys.argv:
            sys.argv.remove("--slow")
            print("started", file=sys.stderr, flush=True)
            try:
                await asyncio.sleep(60)
            finally:
                await asyncio.sleep(0.3)
                print("cleaned up", file=sys.stderr, flush=True)
        return report

tutor.engine.run_check = Slow({"publishes": FAILURE})
sys.exit(main([argument for argument in sys.argv[1:] if argument != "--slow"]))
"""


def fake_engine_command(*arguments: str) -> list[str]:
    return [sys.executable, "-c", WITH_FAKE_ENGINE, *arguments]


@pytest.fixture
def env(home: Path) -> dict[str, str]:
    left_out = {"NO_COLOR", "ROS_TUTOR_WORKSPACE", "FORCE_COLOR", "TTY_COMPATIBLE", "COLUMNS", "LINES"}
    return {**{key: value for key, value in os.environ.items() if key not in left_out}, "TERM": "xterm-256color"}


# Imports from the standard library that take as much CPU time as `list`: 0.17 s on the machine where it was measured.
YARDSTICK = "import unittest.mock, http.server, xml.dom.minidom, concurrent.futures, logging.config"


def measure_cpu_s(program: str) -> tuple[float, str]:
    """Run a Python program. Returns the CPU seconds that it used, and its output."""
    process = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    output = process.stdout.read()
    process.stdout.close()
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)  # already reaped: Popen must not wait for it again
    assert process.returncode == 0
    return usage.ru_utime + usage.ru_stime, output


def test_list_needs_neither_ros_nor_the_terminal_app_and_is_quick() -> None:
    program = (
        "import sys; from tutor.cli import main; code = main(['list']); "
        "print(sorted({'rclpy', 'textual', 'rich', 'asyncio', 'tutor.ros', 'tutor.engine'} & set(sys.modules))); "
        "sys.exit(code)"
    )
    shares: list[float] = []
    while not shares or (shares[-1] >= 1.7 and len(shares) < 5):  # other load may slow down only one of the two
        took_s, output = measure_cpu_s(program)
        assert output.splitlines()[-1] == "[]"
        shares.append(took_s / measure_cpu_s(YARDSTICK)[0])
    assert min(shares) < 1.7  # a ratio, as the 0.3 s of CPU time on an idle machine double on a busy one


def test_without_a_terminal_nothing_is_coloured_or_drawn() -> None:
    result = subprocess.run(
        fake_engine_command("check", "i1.1", "--solution"), capture_output=True, text=True, timeout=LIMIT_S, check=False
    )
    assert result.returncode == 1
    assert "\x1b" not in result.stdout
    assert result.stderr == ""


def test_a_terminal_shows_live_progress_and_then_the_report(env: dict[str, str]) -> None:
    code, out, err = run_in_terminals(fake_engine_command("check", "i1.1", "--solution"), env)
    assert code == 1
    assert "\x1b[31m" in out
    assert "call rclpy.spin(node)" in out
    assert "publishes" in err
    assert err.endswith("\x1b[2K") or "\x1b[1A\x1b[2K" in err  # erased to make room for the report
    assert "\x1b[?25h" in err  # the cursor is shown again


def test_many_exercises_on_a_short_terminal_take_one_line_each(env: dict[str, str]) -> None:
    code, _, err = run_in_terminals(fake_engine_command("check", "all", "--solution"), env, rows=12)
    assert code == 1
    assert re.search(r"i1\.1.*\d of \d passed", err)


def draw(display: ProgressDisplay, width: int = 80) -> list[str]:
    """The lines that the display draws on a terminal with 24 rows."""
    output = io.StringIO()
    display._console = Console(file=output, width=width, height=24, force_terminal=True, color_system=None)
    display._console.print(display._draw())
    return output.getvalue().rstrip("\n").split("\n")


def test_all_exercises_fit_on_a_common_terminal_with_a_bar_for_each_criterion() -> None:
    course = load_course()
    display = ProgressDisplay(course, vanishing=True)
    for lesson in course.lessons:
        display._lines[lesson.id] = {each.id: _Line(0.5, "waiting for the first message") for each in lesson.criteria}
        done = CriterionResult("x", "x", False, FAILURE, 1.0)
        display._lines[lesson.id][lesson.criteria[0].id] = _Line(1.0, "", done)
    display.stopping()
    drawn = draw(display)
    assert len(drawn) <= 24
    assert max(map(len, drawn)) <= 80
    for lesson, row in zip(course.lessons, drawn, strict=False):
        assert f"{lesson.id}" in row
        assert "✗" + "▅" * (len(lesson.criteria) - 1) in row
        assert f"0 of {len(lesson.criteria)} passed" in row
    assert any("waiting for the first message" in row and "i1.1 sensor-name" in row for row in drawn)
    assert drawn[-1].startswith("Stopping")


def test_a_waiting_criterion_shows_its_findings_so_far() -> None:
    course = load_course()
    display = ProgressDisplay(course, vanishing=True)
    lesson, so_far = course.lessons[0], "/node is up, nothing published on /sensor/temperature yet"
    waiting = lesson.criteria[0].id

    def drawn(width: int) -> str:
        return next(line for line in draw(display, width) if waiting in line).rstrip()

    display._lines[lesson.id] = {each.id: _Line() for each in lesson.criteria}
    display._lines[lesson.id][waiting] = _Line(0.1, "waiting for the first message", so_far=so_far)
    assert drawn(160).endswith(f"waiting for the first message; so far: {so_far}")
    assert "so far: /node is up, nothing published" in drawn(80)
    done = CriterionResult(waiting, "x", False, FAILURE, 1.0)
    display._lines[lesson.id][waiting] = _Line(0.1, "waiting", done, so_far)
    assert "so far" not in drawn(160)
    assert "no spin: no callback ran" in drawn(160)


@pytest.mark.parametrize("exercises", [1, 6])
def test_the_first_failure_stays_on_top_with_its_cause(exercises: int) -> None:
    course = load_course()
    display = ProgressDisplay(course, vanishing=True)
    for lesson in course.lessons[:exercises]:
        display._lines[lesson.id] = {each.id: _Line(0.5, "waiting") for each in lesson.criteria}
    lesson, second = course.lessons[0], failure("a", "b", ("another", "it is another " * 50, "do that"))
    for name, verdict, bonus in (("shutdown", FAILURE, True), ("rate", FAILURE, False), ("range", second, False)):
        display.show(CriterionJudged(lesson.id, CriterionResult(name, name, bonus, verdict, 1.0)))
    drawn = draw(display)
    where = "" if exercises == 1 else "i1.1 "
    assert drawn[:3] == [
        f"┃ ✗ {where}rate failed after 1.0 s",
        "┃ no spin: no callback ran",
        "┃ next step: call rclpy.spin(node)",
    ]
    assert len(drawn) <= 24
    assert any("waiting" in row for row in drawn[3:])


def test_no_color_and_dumb_terminals_are_honoured(env: dict[str, str]) -> None:
    _, out, err = run_in_terminals(fake_engine_command("check", "i1.1", "--solution"), {**env, "NO_COLOR": "1"})
    assert "\x1b[3" not in out
    assert not re.search(r"\x1b\[3[0-9]", err)
    _, out, err = run_in_terminals(fake_engine_command("check", "i1.1", "--solution"), {**env, "TERM": "dumb"})
    assert "\x1b" not in out + err


@pytest.mark.parametrize("signum", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupt_lets_the_engine_clean_up_and_exits_130(signum: signal.Signals) -> None:
    process = subprocess.Popen(
        fake_engine_command("check", "i1.1", "--solution", "--slow"),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stderr is not None
    assert process.stdout is not None
    assert process.stderr.readline() == "started\n"
    process.send_signal(signum)
    assert process.stderr.readline() == "ros-tutor: stopping everything that was started\n"
    process.send_signal(signum)  # someone is impatient
    rest = process.stderr.read()
    assert process.wait(timeout=LIMIT_S) == 130
    assert rest == "cleaned up\nros-tutor: interrupted; nothing is left running\n"
    assert process.stdout.read() == ""
    process.stdout.close()
    process.stderr.close()


def test_a_closed_stdout_pipe_is_not_an_error() -> None:
    read, write = os.pipe()
    os.close(read)
    result = subprocess.run(
        fake_engine_command("check", "i1.1", "--solution"),
        stdout=write,
        stderr=subprocess.PIPE,
        text=True,
        timeout=LIMIT_S,
        check=False,
    )
    os.close(write)
    assert result.returncode == 1
    assert result.stderr == ""


def test_a_full_disk_is_reported(env: dict[str, str]) -> None:
    with open("/dev/full", "w") as full:
        result = subprocess.run(
            fake_engine_command("check", "i1.1", "--solution"),
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            timeout=LIMIT_S,
            check=False,
        )
    assert result.returncode == 3
    assert result.stderr == "ros-tutor: cannot write to stdout: No space left on device\n"


def test_an_ascii_only_terminal_gets_a_report(env: dict[str, str]) -> None:
    result = subprocess.run(
        fake_engine_command("check", "i1.1", "--solution"),
        capture_output=True,
        text=True,
        timeout=LIMIT_S,
        check=False,
        env={**env, "PYTHONIOENCODING": "ascii", "PYTHONUTF8": "0"},
    )
    assert result.returncode == 1
    assert "? passed" in result.stdout
