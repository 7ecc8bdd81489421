"""A test bench: real nodes on a reserved domain, and our `ros2` run as a process."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO

from tutor.ros.domain import reserve_domain
from tutor.ros.environment import detect, learner_env

LIMIT_S = 60.0

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

    def __init__(self, command: list[str], env: Mapping[str, str], cwd: Path) -> None:
        self.process = subprocess.Popen(
            command, env=env, cwd=cwd, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, process_group=0
        )

    def line(self) -> str:
        """Read the next line of stdout, without the newline."""
        return _pipe(self.process.stdout).readline().rstrip("\n")

    def error(self) -> str:
        """Read the next line of stderr, without the newline."""
        return _pipe(self.process.stderr).readline().rstrip("\n")

    def interrupt(self) -> Ran:
        """Press Ctrl+C. Return the output not yet read, and the exit code."""
        self.process.send_signal(signal.SIGINT)
        return self.end()

    def end(self) -> Ran:
        """Wait for the process to exit. Return the output not yet read, and the exit code."""
        stdout, stderr = self.process.communicate(timeout=LIMIT_S)
        return Ran(stdout, stderr, self.process.returncode)

    def kill(self) -> None:
        """Kill the process group, so that no process is left."""
        with suppress(ProcessLookupError):
            os.killpg(self.process.pid, signal.SIGKILL)
        self.process.communicate()


@dataclass
class Bench:
    """A domain, which `env` joins, and a folder for all files."""

    env: dict[str, str]
    folder: Path

    def ros2(self, *words: str, stdin: str | None = None) -> Ran:
        """Run a `ros2` command until it exits."""
        ran = subprocess.run(
            command(*words), env=self.env, cwd=self.folder, input=stdin, capture_output=True, text=True, timeout=LIMIT_S
        )
        return Ran(ran.stdout, ran.stderr, ran.returncode)

    @contextmanager
    def running(self, *words: str) -> Iterator[Running]:
        """Run a `ros2` command during the block. It is killed if the block does not end it."""
        with self._start(command(*words)) as running:
            yield running

    @contextmanager
    def node(self, code: str) -> Iterator[Running]:
        """Run nodes in one process during the block.

        `code` creates them and calls `spin(node, ...)`, at which point the block starts.
        """
        script = self.folder / f"node_{time.monotonic_ns()}.py"
        script.write_text(_PREAMBLE + code)
        with self._start([sys.executable, str(script)]) as running:
            assert running.line() == "ready"
            yield running

    @contextmanager
    def _start(self, words: list[str]) -> Iterator[Running]:
        running = Running(words, self.env, self.folder)
        try:
            yield running
        finally:
            running.kill()


def command(*words: str) -> list[str]:
    """Return the command line of our `ros2` with these words."""
    return [sys.executable, "-P", "-m", "tutor.bundled_ros.ros2", *words]


@contextmanager
def bench(folder: Path) -> Iterator[Bench]:
    """Provide a bench on a domain that nothing else uses."""
    logs = folder / "log"
    logs.mkdir()
    with reserve_domain() as domain_id:
        env = learner_env(detect(), domain_id=domain_id, log_dir=logs, package_root=None, isolated=True)
        env |= {"HOME": str(folder), "TMPDIR": str(logs), "ROS_TUTOR_WORKSPACE": str(folder / "ws"), "COLUMNS": "80"}
        yield Bench(env, folder)


def _pipe(stream: IO[str] | None) -> IO[str]:
    assert stream is not None
    return stream
