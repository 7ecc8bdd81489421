"""The course for screen readers: lines in through a pipe, lines out."""

from __future__ import annotations

import os
import pty
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from tutor.cli import main
from tutor.content import load_course
from tutor.workspace import Workspace

LIMIT_S = 60.0

PROGRAM = "import sys; from tutor.cli import main; sys.exit(main(sys.argv[1:]))"

WITH_FAKE_ENGINE = """
import asyncio, sys
import tutor.engine
from tutor.cli import main
from tests.cli.fake_engine import FAILURE, FakeEngine

class Slow(FakeEngine):
    async def __call__(self, submissions, course, *, only, on_event, first=False):
        if "--slow" in sys.argv:
            try:
                print("begun", flush=True)
                await asyncio.sleep(60)
            finally:
                print("cleaned up", flush=True)
        if first:
            print("asked to end at the first failure", flush=True)
        return await super().__call__(submissions, course, only=only, on_event=on_event)

tutor.engine.run_check = Slow({"rate": FAILURE})
sys.exit(main([argument for argument in sys.argv[1:] if argument != "--slow"]))
"""


@pytest.fixture
def env(tmp_path: Path) -> dict[str, str]:
    left_out = ("ROS_TUTOR_WORKSPACE", "NO_COLOR")
    kept = {name: value for name, value in os.environ.items() if name not in left_out}
    return {
        **kept,
        "HOME": str(tmp_path),
        "TERM": "xterm-256color",
        "ROS_DOMAIN_ID": "92",
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
    }


def as_input(*commands: str) -> str:
    return "".join(f"{command}\n" for command in commands)


def test_lesson_check_hints_and_checklist_through_a_pipe(tmp_path: Path, env: dict[str, str]) -> None:
    typed = as_input(
        *(
            "lessons",
            "read 1",
            "tick 1",
            "log",
            "stop",
            "start",
            "start",
            "criteria",
            "hint",
            "check 2",
            "check first",
            "why rate",
            "explain",
            "x rate",
            "x old-timer-kept",
            "explain bells",
            "check",
            "check",
        ),
        *("solution", "no", "2", "next", "i1.1", "chek", "99", "checklist", "tick 1 timers", "untick 2", "tick 99"),
        *("export html", "export pdf", "", "help"),
    )
    result = subprocess.run(
        [sys.executable, "-c", WITH_FAKE_ENGINE, "--plain"],
        input=typed,
        capture_output=True,
        text=True,
        timeout=LIMIT_S,
        check=False,
        env=env,
    )
    output = result.stdout
    assert (result.returncode, result.stderr) == (0, "")
    assert "\x1b" not in output
    assert not re.search("[\u2500-\u25ff\r\t]", output)  # no boxes, no blocks
    for line in (
        "Your workspace will be ~/ros_tutor_ws: start creates it.",
        "1: i1.1 Sensor Publisher, easy, not started. You are here.",
        "Section 1 of 8: Objective.",
        "Ticks are kept in your workspace, and there is none yet: say start.",
        "No node has been run yet: say run.",
        "No node is running.",
        "To edit: ~/ros_tutor_ws/src/my_package/my_package/temperature_publisher.py",
        "Already there, and not changed: ~/ros_tutor_ws/src/my_package/my_package/temperature_publisher.py",
        "shutdown (bonus): Ctrl+C ends the node cleanly.",
        "Waiting for the first message.",
        "So far: /node is up, but silent.",
        "Say check, or check first, which ends at the first failure.",
        "asked to end at the first failure",
        "publishes: passed.",
        "rate: failed.",
        "i1.1 Sensor Publisher: not passed yet. 5 of 6 passed, bonus 1 of 1, after 1.0 s.",
        "Why: no spin: no callback ran",
        "Next step: call rclpy.spin(node)",
        "a line",  # the evidence
        "why rate reads the evidence, explain reads about the mistake, with an example, hint the next hint.",
        "Bad example, 5 lines of code:",
        "old timer kept: A timer that is replaced runs on until it is cancelled.",
        "There is no mistake bells. Those of the last check are of rate.",
        "Your last 3 checks failed for this same reason: explain reads about it.",
        "Command: solution",
        "You have not passed this lesson yet. Type yes to read our solution: no",
        "You are at i1.2 Message Counter and Statistics, medium, not started.",
        "You are at i1.3 Calculator Service, medium, not started.",
        "You are at i1.1 Sensor Publisher, easy, not passed yet, 5 of 6 criteria met.",
        "There is no command chek. Did you mean check? help lists them all.",
        f"There is no lesson 99: they go from 1 to {len(load_course().lessons)}.",
        "1 of 15 ticked.",
        "There is no item 99: they go from 1 to 15. checklist lists them.",
        "Written: ~/ros_tutor_ws/checklist.html",
        "There is no format pdf: choose markdown, json or html.",
        "tick NUMBER: tick an item of the checklist.",
    ):
        assert f"{line}\n" in output, line
    assert output.count("aiting for the first message") == 3  # once for each check, though every criterion waits for it
    assert output.count("/node is up, but silent") == 3
    assert output.count("no spin: Nothing spins the node.") == 2
    assert output.count("explain reads about it") == 1
    assert (
        "rate: failed.\nWhy: no spin: no callback ran\nsensor-name: passed." in output
    )  # at once, not only at the end
    assert re.search(r"^1: not ticked: .* Evidence: i1\.1 .*passed with hints, today\.$", output, re.MULTILINE)
    assert re.search(r"^Hint 1 of 3: \w", output, re.MULTILINE)
    assert output.endswith("Command: \nThe input has ended.\nGoodbye. Your progress is kept.\n")
    progress = Workspace(tmp_path / "ros_tutor_ws").progress().read()
    assert len(progress.ticks) == 1
    assert progress.of("i1.1").hints == 1
    assert len(progress.of("i1.1").attempts) == 3
    assert "<html" in (tmp_path / "ros_tutor_ws" / "checklist.html").read_text()


@pytest.mark.timeout(300)
def test_solved_lessons_are_run_inspected_with_ros2_commands_and_checked_for_real(
    tmp_path: Path, env: dict[str, str]
) -> None:
    workspace = Workspace(tmp_path / "ws")
    course = load_course()

    def solve(lesson_id: str) -> None:
        for file in course.find(lesson_id).files:
            workspace.path_of(file.name).write_text(file.solution.read_text())

    service = "service call /add example_interfaces/srv/AddTwoInts '{a: 2, b: 40}'"
    with subprocess.Popen(
        [sys.executable, "-c", PROGRAM, "--plain", "--workspace", str(workspace.root)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env=env,
    ) as process:
        assert process.stdin is not None
        assert process.stdout is not None
        for typed, lesson_id in ((("start",), "i1.1"), (("4", "start"), "i2.1"), (("3", "start"), "i1.3")):
            process.stdin.write(as_input(*typed))
            process.stdin.flush()
            while "Edit it in your editor" not in process.stdout.readline():
                assert process.poll() is None
            solve(lesson_id)
        process.stdin.write(
            as_input(
                *("1", "run", "log"),
                *("i2.1", "run", "echo /chatter 2", "param set /parameterized_publisher message_prefix Moin"),
                *("param get /parameterized_publisher message_prefix", "topic list", "echo", "param 'set"),
                *("i1.3", "run", service),
                *("1", "check", "stop", "lessons", "quit", "never read"),
            )
        )
        process.stdin.close()
        output = process.stdout.read()
        assert process.wait(LIMIT_S) == 0
    assert "Running in ROS domain 92: ros2 run my_package temperature_publisher\n" in output
    assert re.search(r"\[INFO\].*\[temperature_publisher\]", output)
    assert "Your node temperature_publisher.py: stopped.\nRunning" in output  # before a node of another lesson runs
    first, second = output.split("Command: echo /chatter 2\n")[1].split("Command:")[0].splitlines()
    assert re.fullmatch(r"data: .Hello.*", first), output
    assert second != first
    assert "Set parameter successful\n" in output
    assert "String value is: Moin\n" in output
    assert re.search(r"^/chatter$", output, re.MULTILINE)
    assert "Which topic? As in: echo /chatter." in output
    assert "A quotation mark is missing.\n" in output
    assert "sum=42" in output, output
    assert re.search(r"^i1\.1 Sensor Publisher: passed\. 6 of 6 passed, bonus 1 of 1, after \d", output, re.MULTILINE)
    assert "Well done. next goes to the next lesson" in output
    assert "Command: stop\nYour node calculator_server.py: stopped.\n" in output
    assert "1: i1.1 Sensor Publisher, easy, passed. You are here.\n" in output
    assert output.endswith("Command: quit\nGoodbye. Your progress is kept.\n")


def test_ctrl_c_exits_130_at_the_prompt_and_during_a_check(tmp_path: Path, env: dict[str, str]) -> None:
    def interrupt(program: str, typed: str, wait_for: str, *arguments: str) -> str:
        with subprocess.Popen(
            [sys.executable, "-c", program, "--plain", *arguments],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env=env,
        ) as process:
            assert process.stdin is not None
            assert process.stdout is not None
            process.stdin.write(typed)
            process.stdin.flush()
            while wait_for not in process.stdout.readline():
                assert process.poll() is None
            process.send_signal(signal.SIGINT)
            output = process.stdout.read()
            assert process.wait(LIMIT_S) == 130
        return output

    assert interrupt(PROGRAM, "", "help says what else").endswith("Stopped; nothing is left running.\n")
    output = interrupt(WITH_FAKE_ENGINE, as_input("start", "check"), "begun", "--slow")
    assert output == "cleaned up\n\nStopped; nothing is left running.\n"


def test_a_terminal_echoes_what_is_typed_only_once(env: dict[str, str]) -> None:
    controller, terminal = pty.openpty()
    with subprocess.Popen(
        [sys.executable, "-c", PROGRAM, "--plain"], stdin=terminal, stdout=subprocess.PIPE, text=True, env=env
    ) as process:
        os.write(controller, b"next\n\x04")
        assert process.stdout is not None
        output = process.stdout.read()
        assert process.wait(LIMIT_S) == 0
    os.close(controller)
    os.close(terminal)
    assert "Command: You are at i1.2" in output
    assert output.endswith("Goodbye.\n")


def test_a_closed_stdin_counts_as_ended(env: dict[str, str]) -> None:
    result = subprocess.run(
        ["sh", "-c", f'exec "$0" -c "{PROGRAM}" --plain <&-', sys.executable],
        capture_output=True,
        text=True,
        timeout=LIMIT_S,
        check=False,
        env=env,
    )
    assert (result.returncode, result.stderr) == (0, "")
    assert result.stdout.endswith("The input has ended.\nGoodbye.\n")


def test_plain_takes_no_command(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--plain", "list"]) == 2
    message = "ros-tutor: --plain takes no command: list writes plain text anyway\n"
    assert capsys.readouterr() == ("", message)


def test_a_silent_topic_is_reported(tmp_path: Path, env: dict[str, str]) -> None:
    result = subprocess.run(
        [sys.executable, "-c", PROGRAM, "--plain"],
        input=as_input("echo /nothing", "quit"),
        capture_output=True,
        text=True,
        timeout=LIMIT_S,
        check=False,
        env={**env, "ROS_DOMAIN_ID": "90"},
    )
    assert "0 messages in 10 seconds on /nothing.\n" in result.stdout


def test_the_given_system_runs_beside_the_talk(tmp_path: Path, env: dict[str, str]) -> None:
    result = subprocess.run(
        [sys.executable, "-c", PROGRAM, "--plain"],
        input=as_input(
            *("i1.1", "partner", "b1.1", "log partner", "stop partner", "read 5", "partner", "log partner", "partner"),
            *("log", "stop partner", "help", "quit"),
        ),
        capture_output=True,
        text=True,
        timeout=LIMIT_S,
        check=False,
        env={**env, "ROS_DOMAIN_ID": "91"},
    )
    output = result.stdout
    assert (result.returncode, result.stderr) == (0, "")
    for line in (
        "This lesson has no partner: no node of ours goes with temperature_publisher.py.",
        "No partner has been run yet: say partner.",
        "No partner is running.",
        "Running in ROS domain 91: python3 warehouse.py",
        "log partner reads what it writes, stop partner ends it.",
        "The partner is already running: stop partner ends it.",
        "No node has been run yet: say run.",
        "Warehouse: stopped.",
    ):
        assert f"{line}\n" in output, line
    assert re.search(r"\[warehouse\]: Published the map hall-\d", output)
    assert re.search(r"Section 5 of \d+: In the app\.\nIts keys are the app's\. Here, run does what r does", output)
    assert re.search(r"^partner \[NUMBER\]: run our node", output, re.MULTILINE)
