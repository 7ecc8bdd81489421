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
from tutor.content import load_course
from tutor.interpreter import module_command

FILE = "temperature_publisher.py"

# Runs PROBE in isolation, as the engine runs a submission.
ISOLATOR = """
import os, subprocess, sys
from pathlib import Path
from tutor.engine.isolation import Isolation
submission, logs, probe = map(Path, sys.argv[1:4])
environ = dict(os.environ)
command = Isolation.set_up().wrap(submission, logs, environ)
ran = subprocess.run([*command, sys.executable, "-S", str(submission / probe), *sys.argv[4:]], env=environ)
sys.exit(ran.returncode)
"""

PROBE = """
import json, mmap, os, socket, sys
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
    "processes": [name for name in os.listdir("/proc") if name.isdecimal() and int(name) > 20],
    "large": tried(lambda: fill(submission)),
    "tmp": tried(lambda: fill("/tmp")),
    "shm": tried(lambda: fill("/dev/shm")),
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


def run_probe(tmp_path: Path, outsider: int, port: int) -> Mapping[str, Any]:
    """Run PROBE as an isolated submission and return what it could do."""
    secret, submission, logs = tmp_path / "home" / "secret", tmp_path / "submission", tmp_path / "logs"
    for folder in (secret.parent, submission, logs):
        folder.mkdir()
    secret.write_text("the grades")
    (submission / "probe.py").write_text(PROBE)
    ran = subprocess.run(
        [sys.executable, "-c", ISOLATOR, submission, logs, "probe.py", secret, submission, str(port), str(outsider)],
        capture_output=True, text=True, timeout=60, check=False, env={**os.environ, "PYTHONPATH": os.getcwd()},
    )  # fmt: skip
    assert not ran.returncode, ran.stderr
    assert [each.name for each in submission.iterdir()] == ["probe.py"]
    found: Mapping[str, Any] = json.loads(ran.stdout)
    return found


@pytest.mark.usefixtures("isolation")
def test_a_submission_reaches_only_what_it_needs(tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as outside:
        found = run_probe(tmp_path, os.getpid(), outside.getsockname()[1])
    assert found == {
        "secret": "FileNotFoundError",
        "home": "FileNotFoundError",
        "shadow": "FileNotFoundError",
        "submission": "done",  # it is a copy
        "code": "OSError",  # read-only
        "root": "OSError",
        "outside": "ConnectionRefusedError",
        "kill": "ProcessLookupError",
        "processes": [],
        "large": "OSError",
        "tmp": "OSError",
        "shm": "OSError",
        "memory": "MemoryError",
    }


@pytest.mark.usefixtures("isolation")
def test_our_solution_passes_in_isolation_and_the_report_lists_the_walls() -> None:
    code, report, stderr = check("--solution", "--isolate")
    assert code == 0, (report, stderr)
    assert_report_shape(report)
    stands = {each["name"]: each["stands"] for each in report["walls"]}
    process_limit = stands.pop("process limit")  # the kernel does not apply this limit to root
    assert process_limit or os.geteuid() == 0
    assert stands == dict.fromkeys(("user", "network", "processes", "files", "memory limit", "file limit"), True)


@pytest.mark.usefixtures("isolation")
def test_a_submissions_changes_to_its_own_files_are_undone(tmp_path: Path) -> None:
    solution = load_course().find("i1.1").folder / "solution" / FILE
    source = f"import pathlib\npathlib.Path(__file__).write_text('gone')\n{solution.read_text()}"
    (tmp_path / FILE).write_text(source)
    code, report, stderr = check(str(tmp_path), "--isolate", "--criterion", "publishes")
    assert code == 0, (report, stderr)
    assert (tmp_path / FILE).read_text() == source


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
