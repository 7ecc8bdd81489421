"""A test bench: real nodes on a reserved domain, and our `ros2` run as a process."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

from tests.fork_server import Forked, ForkServer, fork_server
from tutor.ros.domain import reserve_domain
from tutor.ros.environment import detect, learner_env

LIMIT_S = 60.0

# rclpy itself is not among them: loading its C library starts threads, which a fork would lose.
_PRELOAD = """
import asyncio, difflib, inspect, numpy, yaml
import ament_index_python, rpyutils
import example_interfaces.srv, rcl_interfaces.msg, rcl_interfaces.srv, rosgraph_msgs.msg, sensor_msgs.msg, std_msgs.msg
import tutor.bundled_ros.ros2.command
"""

_PREAMBLE = """
import rclpy
from rclpy.executors import ExternalShutdownException

def spin(*nodes):
    print("ready", flush=True)
    executor = rclpy.executors.SingleThreadedExecutor()
    for node in nodes:
        executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass

rclpy.init()
"""

TALKER = """
from std_msgs.msg import String
node = rclpy.create_node("talker")
publisher = node.create_publisher(String, "chatter", 10)
count = 0
def talk():
    global count
    count += 1
    publisher.publish(String(data=f"Hello World: {count}"))
node.create_timer(0.05, talk)
spin(node)
"""


@dataclass(frozen=True)
class Ran:
    """The output and exit code of a finished command."""

    stdout: str
    stderr: str
    code: int


class Running:
    """A process in its own process group, whose output is read line by line."""

    def __init__(
        self, words: list[str], env: Mapping[str, str], cwd: Path, server: ForkServer | None, stdin: str | None = None
    ) -> None:
        (read_input, write_input), (read_output, output), (read_errors, errors) = (os.pipe() for _ in range(3))
        ends = (read_input, output, errors)
        self.process: subprocess.Popen[bytes] | Forked
        try:
            if server is None:
                self.process = subprocess.Popen(
                    [sys.executable, "-P", *words],
                    env=env, cwd=cwd, stdin=read_input, stdout=output, stderr=errors, process_group=0,
                )  # fmt: skip
            else:
                self.process = server.start(words, env=env, cwd=cwd, stdin=read_input, stdout=output, stderr=errors)
        finally:
            for each in ends:
                os.close(each)
        with open(write_input, "w") as pipe:
            pipe.write(stdin or "")
        self._stdout, self._stderr = os.fdopen(read_output), os.fdopen(read_errors)

    def line(self) -> str:
        """Read the next line of stdout, without the newline."""
        return self._stdout.readline().rstrip("\n")

    def error(self) -> str:
        """Read the next line of stderr, without the newline."""
        return self._stderr.readline().rstrip("\n")

    def interrupt(self) -> Ran:
        """Press Ctrl+C. Return the output not yet read, and the exit code."""
        if self.process.poll() is None:
            os.kill(self.process.pid, signal.SIGINT)
        return self.end()

    def end(self) -> Ran:
        """Wait for the process to exit. Return the output not yet read, and the exit code."""
        watchdog = threading.Timer(LIMIT_S, self._kill_group)
        watchdog.start()
        try:
            with ThreadPoolExecutor(1) as other:
                errors = other.submit(self._stderr.read)
                output = self._stdout.read()
            return Ran(output, errors.result(), self.process.wait(LIMIT_S))
        finally:
            watchdog.cancel()

    def kill(self) -> None:
        """Kill the process group, so that no process is left."""
        self._kill_group()
        self.process.wait(LIMIT_S)
        self._stdout.close()
        self._stderr.close()

    def _kill_group(self) -> None:
        with suppress(ProcessLookupError):
            os.killpg(self.process.pid, signal.SIGKILL)


@dataclass
class Bench:
    """A domain, which `env` joins, and a folder for all files. `server` forks the processes; if None, all are new."""

    env: dict[str, str]
    folder: Path
    server: ForkServer | None = None

    def ros2(self, *words: str, stdin: str | None = None, env: Mapping[str, str] | None = None) -> Ran:
        """Run a `ros2` command until it exits. `env`: more variables."""
        return self.python(*_module(*words), stdin=stdin, env=env)

    def python(self, *words: str, stdin: str | None = None, env: Mapping[str, str] | None = None) -> Ran:
        """Run `python WORDS...` until it exits."""
        with self._start([*words], stdin, env) as running:
            return running.end()

    @contextmanager
    def running(self, *words: str) -> Iterator[Running]:
        """Run a `ros2` command during the block. It is killed if the block does not end it."""
        with self._start(_module(*words)) as running:
            yield running

    @contextmanager
    def node(self, code: str) -> Iterator[Running]:
        """Run nodes in one process during the block.

        `code` creates them and calls `spin(node, ...)`, at which point the block starts.
        """
        script = self.folder / f"node_{time.monotonic_ns()}.py"
        script.write_text(_PREAMBLE + code)
        with self._start([str(script)]) as running:
            assert running.line() == "ready"
            yield running

    @contextmanager
    def _start(
        self, words: list[str], stdin: str | None = None, more_env: Mapping[str, str] | None = None
    ) -> Iterator[Running]:
        running = Running(words, {**self.env, **(more_env or {})}, self.folder, self.server, stdin)
        try:
            yield running
        finally:
            running.kill()


def command(*words: str) -> list[str]:
    """Return the command line of our `ros2` with these words."""
    return [sys.executable, "-P", *_module(*words)]


def _module(*words: str) -> list[str]:
    return ["-m", "tutor.bundled_ros.ros2", *words]


@contextmanager
def ros2_server(folder: Path) -> Iterator[ForkServer]:
    """Run a server that forks commands and nodes during the block."""
    with fork_server(_PRELOAD, _environment(folder, domain_id=0)) as server:
        yield server


@contextmanager
def bench(folder: Path, server: ForkServer | None = None) -> Iterator[Bench]:
    """Provide a bench on a domain that nothing else uses."""
    logs = folder / "log"
    logs.mkdir()
    with reserve_domain() as domain_id:
        yield Bench(_environment(folder, domain_id), folder, server)


def _environment(folder: Path, domain_id: int) -> dict[str, str]:
    logs = folder / "log"
    env = learner_env(detect(), domain_id=domain_id, log_dir=logs, package_root=None, isolated=True)
    return env | {"HOME": str(folder), "TMPDIR": str(logs), "ROS_TUTOR_WORKSPACE": str(folder / "ws"), "COLUMNS": "80"}
