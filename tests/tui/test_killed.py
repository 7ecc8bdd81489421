"""Killing the app in a real terminal, with real nodes and checks: nothing is left behind, and nothing is lost."""

from __future__ import annotations

import os
import re
import signal
import sys
import time
import uuid
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from tests.benchmarks.terminal import Terminal
from tests.ros.ordinary_domain import ordinary_domain
from tests.tui import fakes
from tutor.content import load_course
from tutor.judge.events import ExerciseJudged
from tutor.process.process_table import descendants, processes
from tutor.workspace import Progress, Workspace, start

APP = "import sys; from tutor.cli import main; sys.exit(main())"
LIMIT_S = 40.0
GONE_S = 10.0
"""Time for all processes to end. A check that ran to completion would take longer."""


class KillableApp:
    """The app of a learner who has passed the first exercise, in a terminal of its own."""

    def __init__(self, folder: Path, domain: int) -> None:
        self.known: set[int] = set()
        self.token = f"KILLED_TOKEN={uuid.uuid4().hex}"
        lesson = load_course().lessons[0]
        self.workspace = Workspace(folder / "ws")
        start(lesson, self.workspace)
        self.file = self.workspace.path_of(lesson.files[0].name)
        self.file.write_bytes(lesson.files[0].solution.read_bytes())
        passed = fakes.lesson_final_events(lesson, fakes.GOOD)[-2]
        assert isinstance(passed, ExerciseJudged)
        self.before = self.workspace.progress().change(
            lambda progress: progress.with_attempt(passed.result, whole=True)
        )
        env = {**os.environ, "ROS_DOMAIN_ID": str(domain), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
        name, _, value = self.token.partition("=")
        argv = [sys.executable, "-c", APP, "--workspace", str(self.workspace.root)]
        self.app = Terminal(argv, {**env, name: value})
        self.app.wait_for_text(b"1 of 6 passed")

    def running(self) -> dict[int, str]:
        """The live processes of this app, including itself: each pid with its command line."""
        self.known |= {self.app.pid, *(process.pid for process in descendants(self.app.pid))}
        found = {}
        for pid, process in processes().items():
            try:
                if process.alive and (pid in self.known or self.has_token(pid)):
                    found[pid] = Path(f"/proc/{pid}/cmdline").read_bytes().replace(b"\0", b" ").decode()
            except OSError:
                continue
        return found

    def has_token(self, pid: int) -> bool:
        """Whether a process has our token in its environment. Some programs of ours do not let others read theirs."""
        try:
            return self.token.encode() in Path(f"/proc/{pid}/environ").read_bytes().split(b"\0")
        except PermissionError:
            return False

    def runs(self, *parts: str) -> bool:
        """Whether each of these parts occurs in the command line of a live process."""
        running = self.running().values()
        return all(any(part in line for line in running) for part in parts)

    def count(self, part: str) -> int:
        """How many live processes have this part in their command line."""
        return sum(part in line for line in self.running().values())

    def until(self, condition: Callable[[], bool], what: str) -> None:
        """Wait until the condition holds, and meanwhile read and discard what the app draws."""
        deadline = time.monotonic() + LIMIT_S
        while not condition():
            assert time.monotonic() < deadline, f"waited in vain for {what}; there are {self.running()}"
            self.app.drain(0.1)

    def kill_app(self) -> None:
        """Kill the app, and wait until none of its processes is left."""
        self.app.kill()
        deadline = time.monotonic() + GONE_S
        while left := self.running():
            assert time.monotonic() < deadline, f"left behind: {left}"
            time.sleep(0.05)

    def progress(self) -> Progress:
        """The content of the progress file. A damaged one fails the test."""
        return self.workspace.progress(pytest.fail).read()

    def close(self) -> None:
        for pid in self.running():
            os.kill(pid, signal.SIGKILL)
        self.app.detach()


@pytest.fixture
def learner(tmp_path: Path) -> Iterator[KillableApp]:
    with ordinary_domain() as domain:
        learner = KillableApp(tmp_path, domain)
        try:
            yield learner
        finally:
            learner.close()


def test_killed_while_a_node_is_watched_and_checked_after_a_save_with_another_edit_pending(
    learner: KillableApp,
) -> None:
    whole = learner.file.read_text()
    learner.app.press(b"4")
    learner.until(lambda: learner.runs("tutor.live"), "the watcher process")
    learner.app.press(b"r")
    learner.app.wait_for_text(b"publishes 2.0")
    assert learner.runs("temperature_publisher.py", "tutor.live")
    own_nodes = learner.count("temperature_publisher.py")
    learner.app.press(b"e")
    learner.app.wait_for_text(b"Commands")
    learner.app.press(b"# new\r\x13")
    learner.app.wait_for_text(b"is saved.")
    learner.app.press(b"\x1b[20~")  # F9
    learner.until(lambda: learner.runs("tutor.engine"), "the engine")
    learner.until(lambda: learner.count("temperature_publisher.py") > own_nodes, "the check's nodes")
    assert learner.runs("tutor.live")
    learner.app.press(b"# newer")
    learner.kill_app()
    saved = "# new\n" + whole
    assert learner.file.read_text() in (saved, saved.replace("\n", "\n# newer", 1))
    assert learner.progress() == learner.before


@pytest.mark.parametrize("signum", [signal.SIGHUP, signal.SIGTERM])
def test_a_termination_signal_interrupts_its_nodes_and_leaves_no_shared_memory(
    learner: KillableApp, signum: signal.Signals
) -> None:
    ended = learner.file.with_name("ended")
    text = f"import atexit, pathlib\natexit.register(pathlib.Path({str(ended)!r}).touch)\n"
    learner.file.write_text(text + learner.file.read_text().partition("\n")[2])
    learner.app.press(b"4")
    learner.until(lambda: learner.runs("tutor.live"), "the watcher process")
    learner.app.press(b"r")
    learner.app.wait_for_text(b"publishes 2.0")
    segments = [path for pid in learner.running() for path in segments_of(pid)]
    assert segments
    if signum == signal.SIGHUP:
        learner.app.detach()  # closing the terminal sends SIGHUP
    else:
        os.kill(learner.app.pid, signum)
    assert learner.app.wait_for_exit(LIMIT_S)
    assert ended.exists()
    assert not [path for path in segments if path.exists()]


def segments_of(pid: int) -> set[Path]:
    """The uniquely named shared memory segments of Fast DDS that a process has mapped."""
    maps = Path(f"/proc/{pid}/maps").read_text()
    return {Path(name) for name in re.findall(r"/dev/shm/fastrtps_[0-9a-f]{16}$", maps, re.MULTILINE)}


def test_killed_the_moment_a_save_or_a_check_begins(learner: KillableApp) -> None:
    whole = learner.file.read_text()
    learner.app.press(b"e")
    learner.app.wait_for_text(b"Commands")
    learner.app.press(b"# new\r\x13\x1b[20~")
    learner.until(lambda: learner.file.read_text() != whole, "the save")
    learner.kill_app()
    assert learner.file.read_text() == "# new\n" + whole
    assert learner.progress() == learner.before


def test_killed_with_programs_in_its_terminals(learner: KillableApp) -> None:
    learner.app.press(b"7")
    learner.app.wait_for_text(b"(ROS 2: ws)")
    learner.app.press(b"sleep 4501 & nohup setsid sleep 4502 >/dev/null & ros2 topic echo /sensor/temperature\r")
    learner.until(lambda: learner.runs("sleep 4501", "sleep 4502", "topic echo"), "the programs")
    learner.app.press(b"\x1d")
    learner.app.wait_for_text(b"1-9 shows")
    learner.app.press(b"+")
    learner.until(lambda: learner.count("--rcfile") == 2, "the second shell")
    learner.kill_app()


def test_a_closed_window_hangs_up_its_terminals(learner: KillableApp) -> None:
    told = learner.workspace.root / "told"
    learner.app.press(b"7")
    learner.app.wait_for_text(b"(ROS 2: ws)")
    learner.app.press(b"sh -c 'trap \"echo > told; exit\" HUP; while true; do sleep 0.1; done'\r")
    learner.until(lambda: learner.runs("while true"), "the program")
    learner.app.detach()
    assert learner.app.wait_for_exit(LIMIT_S)
    assert told.exists()
    assert not learner.running()
