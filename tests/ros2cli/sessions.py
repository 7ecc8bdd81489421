"""The environment of a record: the workspace with our solutions, the running nodes, the files in its folder."""

from __future__ import annotations

import contextlib
import os
import re
import shlex
import signal
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping
from pathlib import Path

from tutor.bundled_ros.ros2.sourced import sourced_environment
from tutor.ros.environment import detect
from tutor.workspace import Workspace, domain_of

ROOT = Path(__file__).resolve().parents[2]
TUTOR = str(Path(sys.executable).with_name("ros-tutor"))

FILES = {
    "bad.yaml": "/parameterized_publisher:\n  ros__parameters:\n    message_prefix: Half\n    publish_rate: -4.0\n",
    "wrongtype.yaml": "/parameterized_publisher:\n  ros__parameters:\n    publish_rate: fast\n",
    "other.yaml": "/other_node:\n  ros__parameters:\n    publish_rate: 3.0\n",
    "wild.yaml": "/**:\n  ros__parameters:\n    publish_rate: 3.0\n",
    "unknown.yaml": "/parameterized_publisher:\n  ros__parameters:\n    nonesuch: 1\n",
    "notparams.yaml": "hello: world\n",
    "empty.yaml": "",
}


def make_workspace(folder: Path) -> Path:
    """Create a workspace with all solutions in my_package, like that of a learner who has solved everything."""
    workspace = folder / "ws"
    subprocess.run(
        [TUTOR, "--workspace", str(workspace), "start", "i1.1"],
        cwd=ROOT, check=True, capture_output=True,
    )  # fmt: skip
    package = workspace / "src" / "my_package"
    for solution in sorted(ROOT.glob("lessons/*/solution/*")):
        target = package / ("launch" if "launch" in solution.name else "my_package") / solution.name
        if solution.is_file():
            target.write_bytes(solution.read_bytes())
    return workspace


def shell_environment(workspace: Path, tools: Path) -> dict[str, str]:
    """Return the environment of commands in `ros-tutor shell`. The folder `tools` must exist as long as it is used."""
    return sourced_environment(detect(), workspace, domain_of(Workspace(workspace)), tools)


def start_commands(running: str) -> list[str]:
    """Return the commands that start the nodes a record describes as running."""
    if running.startswith(("no nodes", "nothing")):
        return []
    found = re.search(r"ros2 (run|launch) [^()]*", running)
    if found is None:
        raise ValueError(f"no command to start: {running}")
    command = found[0].strip()
    if command.endswith(", twice") or "twice" in running:
        return [command.removesuffix(", twice")] * 2
    head, both, last = command.partition(" and ")
    if both:
        return [head, " ".join([*head.split()[:-1], last])]
    return [command]


@contextlib.contextmanager
def running(commands: list[str], env: Mapping[str, str], cwd: Path) -> Iterator[None]:
    """Keep nodes up during the block, then end each with Ctrl+C. Raise TimeoutError if they are not up within 30 s."""
    before = _count_nodes(env, cwd) if commands else 0
    started: list[subprocess.Popen[bytes]] = []
    try:
        for command in commands:
            started.append(
                subprocess.Popen(
                    shlex.split(command), env=env, cwd=cwd, start_new_session=True, stdin=subprocess.DEVNULL,
                    stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                )
            )  # fmt: skip
        expected = before + sum(2 if " launch " in command else 1 for command in commands)
        deadline = time.monotonic() + 30
        while _count_nodes(env, cwd) < expected:
            if time.monotonic() > deadline:
                raise TimeoutError(f"{commands} did not come up")
        yield
    finally:
        for process in started:
            end(process)


def _count_nodes(env: Mapping[str, str], cwd: Path) -> int:
    listed = subprocess.run(["ros2", "node", "list"], env=env, cwd=cwd, capture_output=True, check=False)
    return len(listed.stdout.split())


def end(process: subprocess.Popen[bytes]) -> None:
    """Press Ctrl+C, and kill whatever has not exited after 10 s."""
    for number in (signal.SIGINT, signal.SIGKILL):
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, number)
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(10)
            return
