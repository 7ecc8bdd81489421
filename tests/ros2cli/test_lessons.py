"""Each command of each lesson, run verbatim in `ros-tutor shell` with our solution, prints what the lesson shows.

As a learner would, the tests do one lesson after another in one shell and one workspace; each also works alone.
"""

from __future__ import annotations

import os
import shlex
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import replace
from pathlib import Path

import pytest

from tests.ros.ordinary_domain import ordinary_domain
from tests.ros2cli.bench import Bench
from tests.ros2cli.lesson_commands import Command, find_commands
from tutor.content import load_course
from tutor.content.model import Lesson
from tutor.ros.discovery import PROFILE
from tutor.workspace import Workspace

TUTOR = [sys.executable, "-P", "-c", "import sys; from tutor.cli import main; sys.exit(main())"]
LIMIT_S = 90.0
POLL_S = 0.05
NODE_POLL_S = 0.5
LESSONS = {lesson.id: lesson for lesson in load_course().lessons}


class Shell:
    """`ros-tutor shell` on a domain of its own. Command lines run in its environment, in the learner's folder."""

    def __init__(self, bench: Bench, workspace: Workspace) -> None:
        profile = bench.folder / "profile.xml"
        profile.write_bytes(PROFILE.read_bytes())
        names = ("PATH", "LANG", "ROS_DOMAIN_ID", "HOME", "TMPDIR", "ROS_AUTOMATIC_DISCOVERY_RANGE", "ROS_TUTOR_GROUP")
        user_env = {name: bench.env[name] for name in names if name in bench.env}
        user_env |= {name: str(profile) for name, value in bench.env.items() if value == str(PROFILE)}
        self.workspace = workspace
        self._user_env = {**user_env, "SHELL": shutil.which("bash") or "bash"}
        self._outputs = bench.folder / "outputs"
        self._outputs.mkdir()
        self._count = 0
        self.env: dict[str, str] = {}

    @contextmanager
    def open(self) -> Iterator[None]:
        """Run the shell itself during the block: it provides the programs that the command lines need.

        Within another block, it is a second shell, which has what the workspace has got since.
        """
        before = self.env
        words = [
            *TUTOR,
            "shell",
            "--workspace",
            str(self.workspace.root),
            "-c",
            "cat /proc/self/environ; exec sleep 600",
        ]
        with subprocess.Popen(words, env=self._user_env, stdout=subprocess.PIPE, process_group=0) as shell:
            assert shell.stdout is not None
            read = b""
            while not read.endswith(b"\0"):
                more = os.read(shell.stdout.fileno(), 65536)
                assert more, "the shell has ended"
                read += more
            pairs = (entry.partition("=") for entry in read.decode().split("\0") if entry)
            self.env = {name: value for name, _, value in pairs}
            try:
                yield
            finally:
                os.killpg(shell.pid, signal.SIGKILL)
        shutil.rmtree(Path(self.env["PATH"].partition(":")[0]).parent, ignore_errors=True)
        self.env = before

    @contextmanager
    def start(self, line: str) -> Iterator[Started]:
        """Start a command line in its own process group. After the block, press Ctrl+C if it is still running."""
        self._count += 1
        path = self._outputs / str(self._count)
        folder = self.workspace.path_of("node.py").parent
        with path.open("wb") as output:
            process = subprocess.Popen(
                ["bash", "-c", line],
                env=self.env,
                cwd=folder if folder.is_dir() else self._outputs,
                stdout=output,
                stderr=subprocess.STDOUT,
                process_group=0,
            )
        started = Started(line, process, path)
        try:
            yield started
        finally:
            started.interrupt()


class Started:
    """A command line that is running or has finished."""

    def __init__(self, line: str, process: subprocess.Popen[bytes], path: Path) -> None:
        self.line = line
        self._process = process
        self._path = path

    @property
    def output(self) -> str:
        return self._path.read_text(errors="replace")

    @property
    def code(self) -> int | None:
        return self._process.poll()

    def interrupt(self) -> None:
        """Press Ctrl+C, and kill whatever is left."""
        for number, limit_s in ((signal.SIGINT, 15.0), (signal.SIGKILL, 5.0)):
            with suppress(ProcessLookupError):
                os.killpg(self._process.pid, number)
            with suppress(subprocess.TimeoutExpired):
                self._process.wait(limit_s)

    def wait_for(self, command: Command, *, ends: bool = False, prints: bool = False) -> None:
        """Wait until the output matches the lesson; with `ends`, also for the exit; with `prints`, for any output."""
        deadline = time.monotonic() + LIMIT_S
        while (ends and self.code is None) or (prints and not self.output) or not command.matches(self.output):
            assert self.code is None or command.matches(self.output), self._mismatch(command)
            assert time.monotonic() < deadline, self._mismatch(command)
            time.sleep(POLL_S)

    def _mismatch(self, command: Command) -> str:
        shown = "\n".join(command.shown)
        return f"`{command.line}` is shown as\n{shown}\nbut printed (exit code {self.code})\n{self.output}"


@pytest.fixture(scope="module")
def bench(module_bench: Bench) -> Iterator[Bench]:
    """A bench on an ordinary ROS domain, such as users have."""
    with ordinary_domain() as domain:
        yield replace(module_bench, env={**module_bench.env, "ROS_DOMAIN_ID": str(domain)})


@pytest.fixture(scope="module")
def shell(bench: Bench) -> Iterator[Shell]:
    """An open shell with a workspace."""
    shell = Shell(bench, Workspace(bench.folder / "ws"))
    with shell.open():
        yield shell


@pytest.mark.timeout(600)
@pytest.mark.parametrize("lesson", LESSONS.values(), ids=lambda lesson: lesson.id)
def test_each_command_of_a_lesson_prints_what_the_lesson_shows(bench: Bench, shell: Shell, lesson: Lesson) -> None:
    with ExitStack() as nodes:
        running: list[Started] = []
        for command in find_commands(lesson.body):
            if is_check(command.line):
                continue  # covered by the tests of the checks
            if is_node(command.line):
                # As a learner would, end a program or launch before starting it again.
                for other in [each for each in running if program_words(each.line) == program_words(command.line)]:
                    other.interrupt()
                    running.remove(other)
                before = count_nodes(bench) if running else 0
                node = nodes.enter_context(shell.start(command.line))
                node.wait_for(command)
                await_new_node(bench, before, node)
                running.append(node)
            else:
                with shell.start(command.line) as started:
                    endless = is_endless(command.line)
                    started.wait_for(command, ends=not endless, prints=endless)
                    assert endless or started.code == 0, f"`{command.line}`: {started.code}\n{started.output}"
                    started.interrupt()
                    assert not endless or started.code in (2, -signal.SIGINT), started.output
                    assert "Traceback" not in started.output
            if command.line.startswith("ros-tutor start"):
                copy_solution(lesson, shell.workspace)
                if any("/" in file.name for file in lesson.files):  # types of the workspace's own are built and sourced
                    nodes.enter_context(shell.open())
        failed = [f"{node.line}\n{node.output}" for node in running if node.code not in (None, 0)]
        assert not failed, failed


def split_words(line: str) -> list[str]:
    """Split a command line like a shell, across continuation lines and without comments."""
    return shlex.split(line.replace("\\\n", " "), comments=True)


def is_check(line: str) -> bool:
    return line.startswith(("ros-tutor check", "ros-tutor watch"))


def is_node(line: str) -> bool:
    words = split_words(line)
    words = words[1:] if words[0] == "ros-tutor" else words
    if words[0] == "run" or words[:2] == ["ros2", "run"]:
        return True
    if words[0] == "python3":
        return True
    return words[:2] == ["ros2", "launch"] and not {"-s", "--show-args", "--show-arguments", "-p", "--print"} & {*words}


def program_words(line: str) -> tuple[str, ...]:
    """Return the words that identify a node's command: all but its arguments."""
    return tuple(split_words(line)[:4])[: 2 if "launch" in line else 4]


def is_endless(line: str) -> bool:
    words = split_words(line)
    return words[:2] == ["ros2", "topic"] and words[2] in ("echo", "hz", "bw", "delay") and "--once" not in words


def count_nodes(bench: Bench) -> int:
    return len(bench.ros2("node", "list").stdout.split())


def await_new_node(bench: Bench, before: int, node: Started) -> None:
    """Wait until there are more nodes than before, or until the program has exited with 0."""
    deadline = time.monotonic() + LIMIT_S
    while count_nodes(bench) <= before:
        if node.code is not None:
            assert node.code == 0, f"`{node.line}`: {node.code}\n{node.output}"
            return
        assert time.monotonic() < deadline, node.output
        time.sleep(NODE_POLL_S)


def copy_solution(lesson: Lesson, workspace: Workspace) -> None:
    for file in lesson.files:
        shutil.copyfile(file.solution, workspace.path_of(file.name))
