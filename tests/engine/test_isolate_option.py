"""`check --isolate`: what an isolated submission can reach, and the error if isolation is not possible."""

from __future__ import annotations

import json
import os
import re
import shutil
import socket
import subprocess
import sys
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from tests.report.shape import assert_report_shape
from tests.ros.own_network import OWN_NETWORK, needs_own_network
from tutor import private_folders
from tutor.content import load_course
from tutor.interpreter import module_command
from tutor.judge.events import WAITING

FILE = "temperature_publisher.py"

# Runs PROBE in isolation, as the engine runs a submission.
ISOLATOR = """
import asyncio, json, os, sys
from pathlib import Path
from tutor.engine.environment import node_env
from tutor.engine.isolation import Isolation, Sandboxes, restrict_environment
from tutor.judge.submission import Submission
from tutor.process import LearnerProcess, run_limits
from tutor.process.spawner import Spawner
from tutor.ros.environment import detect
submission, tools, way = Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3]

async def main():
    isolation, ros = Isolation.set_up(), detect()
    probe = submission / "probe.py"
    with Sandboxes(isolation, [Submission("t1", {probe.name: probe})]) as sandboxes:
        sandboxes.start(ros, tools, [])
        sandbox = sandboxes.of(probe)
        env = node_env(ros, 250, Path("/tmp"), None)
        restrict_environment(env)
        argv = [str(ros.python), str(probe), *sys.argv[4:]]
        spawner = sandbox.spawner if way == "forked" else Spawner(wrapper=sandbox.spawner.wrapper)
        async with await LearnerProcess.start(argv, env=env, cwd=submission, spawner=spawner) as process:
            enforcing = asyncio.ensure_future(run_limits.enforce(process))
            await process.wait(120)
            enforcing.cancel()
            print(json.dumps([process.exit.code, [line.text for line in process.output]]))
asyncio.run(main())
"""

PROBE = """
import ctypes, json, mmap, os, socket, sys
from pathlib import Path
secret, submission, port, outsider = sys.argv[1:]

def tried(what):
    try:
        return what() or "done"
    except MemoryError:
        return "MemoryError"
    except OSError as error:
        return type(error).__name__

def connect():
    with socket.socket() as one:
        one.settimeout(5)
        one.connect(("127.0.0.1", int(port)))

def fill(folder):
    with open(folder + "/large", "wb") as file:
        for _ in range(100):
            file.write(bytes(1 << 20))

def fill_with_files(folder):
    for number in range(20_000):
        Path(folder, str(number)).touch()

def make_namespace():
    if ctypes.CDLL(None, use_errno=True).unshare(0x10000000):
        raise OSError(ctypes.get_errno(), "unshare")

def environments():
    for process in filter(str.isdecimal, os.listdir("/proc")):
        try:
            yield Path("/proc", process, "environ").read_text()
        except PermissionError:
            pass

import signal
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
print(json.dumps({
    "secret": tried(lambda: Path(secret).read_text()),
    "home": tried(lambda: os.listdir(Path(secret).parent)),
    "shadow": tried(lambda: Path("/etc/shadow").read_text()),
    "submission": tried(lambda: Path(submission, "made").write_text("x") and None),
    "code": tried(lambda: Path(sys.executable).parent.joinpath("made").write_text("x") and None),
    "root": tried(lambda: Path("/made").write_text("x") and None),
    "outside": tried(connect),
    "kill": tried(lambda: os.kill(int(outsider), 0)),
    "token": any("hunter2" in text for text in environments()),
    "user": [name for name in os.environ if name in ("USER", "LOGNAME")],
    "namespace": tried(make_namespace),
    "processes": [name for name in os.listdir("/proc") if name.isdecimal() and int(name) > 20],
    "large": tried(lambda: fill(submission)),
    "tmp": tried(lambda: fill("/tmp")),
    "shm": tried(lambda: fill("/dev/shm")),
    "files": tried(lambda: fill_with_files("/tmp")),
    "memory": tried(lambda: bytearray(3 << 30) and None),
}))
"""


@cache
def _why_unavailable() -> str:
    """Return why isolation is impossible on this machine; empty if it is possible."""
    code = "from tutor.engine.isolation import Isolation; print(Isolation.set_up())"
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    return ran.stderr.strip().rpartition("\n")[2]


@pytest.fixture
def isolation() -> None:
    """Skip the test if isolation is impossible here."""
    if _why_unavailable():
        pytest.skip(_why_unavailable())


def check(*arguments: str, **variables: str) -> tuple[int, Any, str]:
    """Check from the command line; return the exit code, the report and stderr."""
    ran = subprocess.run(
        [*module_command("tutor"), "check", "i1.1", *arguments, "--format", "json"],
        capture_output=True, text=True, timeout=120, check=False, env={**os.environ, **variables},
    )  # fmt: skip
    return ran.returncode, json.loads(ran.stdout) if ran.stdout else None, ran.stderr


def run_probe(tmp_path: Path, probe: str, *arguments: object, way: str = "forked") -> tuple[int | None, list[str]]:
    """Run a program as an isolated submission; return its exit code and its output."""
    submission, tools = tmp_path / "submission", tmp_path / "tools"
    for folder in (submission, tools):
        folder.mkdir()
    (submission / "probe.py").write_text(probe)
    ran = subprocess.run(
        [sys.executable, "-c", ISOLATOR, submission, tools, way, *map(str, arguments)],
        capture_output=True, text=True, timeout=120, check=False,
        env={**os.environ, "PYTHONPATH": os.getcwd(), "TOKEN": "hunter2"},
    )  # fmt: skip
    assert not ran.returncode, ran.stderr
    assert [each.name for each in submission.iterdir()] == ["probe.py"]
    code, output = json.loads(ran.stdout)
    return code, output


@pytest.mark.usefixtures("isolation")
@pytest.mark.parametrize("way", ["forked", "wrapped"])
def test_a_submission_reaches_only_what_it_needs(way: str, tmp_path: Path) -> None:
    secret = tmp_path / "home" / "secret"
    secret.parent.mkdir()
    secret.write_text("the grades")
    with socket.create_server(("127.0.0.1", 0)) as outside:
        arguments = (secret, tmp_path / "submission", outside.getsockname()[1], os.getpid())
        code, output = run_probe(tmp_path, PROBE, *arguments, way=way)
    assert code == 0, output
    assert json.loads(output[-1]) == {
        "secret": "FileNotFoundError",
        "home": "FileNotFoundError",
        "shadow": "FileNotFoundError",
        "submission": "done",  # it is a copy
        "code": "OSError",  # read-only
        "root": "OSError",
        "outside": "ConnectionRefusedError",
        "kill": "ProcessLookupError",
        "token": False,
        "user": [],
        "namespace": "OSError",
        "processes": [],
        "large": "OSError",
        "tmp": "OSError",
        "shm": "OSError",
        "files": "OSError",
        "memory": "MemoryError",
    }


MANY_PROCESSES = """
import os, time
started = 0
try:
    while started < 3000:
        os.posix_spawn("/bin/sleep", ["sleep", "100"], {})
        started += 1
finally:
    time.sleep(100)
"""


@pytest.mark.usefixtures("isolation")
def test_a_run_with_too_many_processes_is_ended_also_that_of_root(tmp_path: Path) -> None:
    code, output = run_probe(tmp_path, MANY_PROCESSES)
    assert code is None
    assert output[-1] == "Killed: it had more than 1000 processes and threads"


NO_USER_NAMESPACES = "echo 0 > /proc/sys/user/max_user_namespaces && exec " + " ".join(
    module_command("tutor.engine", "--try-isolation")
)


def test_where_user_namespaces_are_disabled_it_is_said(tmp_path: Path) -> None:
    unshare = ["unshare", "--user", "--map-root-user", "sh", "-c"]
    if subprocess.run([*unshare, "echo 0 > /proc/sys/user/max_user_namespaces"], check=False).returncode:
        pytest.skip("this machine has no user namespaces that could be disabled")
    ran = subprocess.run([*unshare, NO_USER_NAMESPACES], capture_output=True, text=True, timeout=60, check=False)
    assert (ran.returncode, ran.stderr) == (3, "")
    problem = json.loads(ran.stdout)
    assert "disabled (user.max_user_namespaces is 0)" in problem["what"]
    assert "sudo sysctl user.max_user_namespaces" in problem["hint"]


@pytest.mark.usefixtures("isolation")
def test_our_solution_passes_in_isolation_and_the_report_lists_the_walls() -> None:
    code, report, stderr = check("--solution", "--isolate")
    assert code == 0, (report, stderr)
    assert_report_shape(report)
    stands = {each["name"]: each["stands"] for each in report["walls"]}
    assert stands.pop("namespaces") or "disable-userns" not in help_of_bubblewrap()
    limits = ("disk limit", "memory limit", "process limit")
    assert stands == dict.fromkeys(("user", "network", "processes", "files", *limits), True)


def help_of_bubblewrap() -> str:
    return subprocess.run(["bwrap", "--help"], capture_output=True, text=True, check=False).stdout


@pytest.mark.usefixtures("isolation")
def test_a_submissions_changes_to_its_own_files_are_undone(tmp_path: Path) -> None:
    solution = load_course().find("i1.1").folder / "solution" / FILE
    source = f"import pathlib\npathlib.Path(__file__).write_text('gone')\n{solution.read_text()}"
    (tmp_path / FILE).write_text(source)
    code, report, stderr = check(str(tmp_path), "--isolate", "--criterion", "publishes")
    assert code == 0, (report, stderr)
    assert (tmp_path / FILE).read_text() == source


@pytest.mark.usefixtures("isolation")
def test_a_launch_file_in_a_private_folder_is_not_swept_away_by_the_launch() -> None:
    """Where `grade` unpacks submissions. Programs of ours remove what is in such folders, and not in use."""
    with private_folders.temporary("grade") as folder:
        shutil.copytree(load_course().find("i2.2").folder / "solution", folder / "submission")
        words = ["check", "i2.2", str(folder / "submission"), "--isolate", "--criterion", "starts"]
        ran = subprocess.run(
            [*module_command("tutor"), *words], capture_output=True, text=True, timeout=120, check=False
        )
    assert ran.returncode == 0, ran.stdout


@pytest.mark.usefixtures("isolation")
def test_crashes_and_hangs_are_reported_as_without_isolation(tmp_path: Path) -> None:
    (tmp_path / FILE).write_text("import os, signal\nos.kill(os.getpid(), signal.SIGSEGV)\n")
    crashes = [check(str(tmp_path), *options, "--criterion", "publishes") for options in ([], ["--isolate"])]
    (tmp_path / FILE).write_text(
        "import rclpy, time\nrclpy.init()\nn = rclpy.create_node('n')\nwhile True: time.sleep(1)\n"
    )
    hangs = [check(str(tmp_path), *options, "--criterion", "publishes") for options in ([], ["--isolate"])]
    for (code, one, _), (isolated_code, isolated, stderr) in (crashes, hangs):
        assert code == isolated_code == 1, stderr
        assert cause(one) == cause(isolated)


def cause(report: Any) -> str:
    return re.sub(r"\d+\.\d+ s", "some time", report["exercises"][0]["criteria"][0]["cause"])


@pytest.mark.usefixtures("isolation")
def test_a_folder_too_large_to_copy_is_not_the_learners_fault(tmp_path: Path) -> None:
    (tmp_path / FILE).write_text("print('hello')\n")
    with (tmp_path / "large").open("wb") as file:
        file.truncate(65 << 20)
    code, report, _ = check(str(tmp_path), "--isolate", "--criterion", "publishes")
    assert code == 3
    assert "a folder of its own" in report["exercises"][0]["criteria"][0]["step"]


HOLDS_ALL_TURNS = (
    OWN_NETWORK
    + """
import json, signal, socket, subprocess, sys
from tutor.interpreter import module_command
from tutor.judge.events import WAITING
held = [socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) for _ in range(2 * len(os.sched_getaffinity(0)))]
for number, each in enumerate(held):
    each.bind(chr(0) + f"ros-tutor-check-{number}")
with subprocess.Popen(module_command("tutor.engine", *sys.argv[1:]), stdout=subprocess.PIPE, text=True) as check:
    started, progress = (json.loads(check.stdout.readline()) for _ in range(2))
    check.send_signal(signal.SIGINT)
print(progress["doing"])
"""
)


@pytest.mark.usefixtures("isolation")
@needs_own_network
@pytest.mark.parametrize("sourced", [{}, {"LD_LIBRARY_PATH": "/opt/ros/humble/lib"}], ids=["no ROS", "another ROS"])
def test_an_isolated_check_waits_for_its_turn_among_all(sourced: Mapping[str, str], tmp_path: Path) -> None:
    """Where another ROS is sourced, the check restarts itself without it, when it is isolated already."""
    (tmp_path / FILE).write_text("print('hello')\n")
    env = {**os.environ, "PYTHONPATH": os.getcwd(), **sourced}
    argv = [sys.executable, "-c", HOLDS_ALL_TURNS, "i1.1", str(tmp_path), "--isolate", "--criterion", "publishes"]
    ran = subprocess.run(argv, capture_output=True, text=True, timeout=60, check=False, env=env)
    assert ran.stdout.strip() == WAITING, ran.stderr


def test_without_bubblewrap_nothing_is_checked(tmp_path: Path) -> None:
    code, report, stderr = check("--solution", "--isolate", PATH=str(tmp_path))
    assert (code, report["exercises"]) == (3, [])
    assert report["message"] in stderr
    assert "bubblewrap" in stderr
    assert "sudo apt install bubblewrap" in stderr


def test_if_bubblewrap_fails_nothing_is_checked(tmp_path: Path) -> None:
    prlimit = shutil.which("prlimit")
    if prlimit is None:
        pytest.skip("there is no prlimit")
    (tmp_path / "prlimit").symlink_to(prlimit)
    (tmp_path / "bwrap").write_text("#!/bin/sh\necho 'bwrap: Creating new namespace failed' >&2\nexit 1\n")
    (tmp_path / "bwrap").chmod(0o755)
    code, report, stderr = check("--solution", "--isolate", PATH=str(tmp_path))
    assert (code, report["exercises"]) == (3, [])
    assert "Creating new namespace failed" in stderr or "no private network namespace" in stderr
