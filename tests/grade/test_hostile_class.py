"""A class with hostile submissions in it, graded by real checks, with isolation and without.

Without isolation, a submission runs as the user who grades. It can read and change what that user can: the submissions
of others, the results, this program, and it can end `grade` itself. No test could show that it cannot. What holds even
then: a submission that another one has changed gets no verdict, the results at the end are those that were judged, and
nothing that a submission has started is left.
"""

from __future__ import annotations

import json
import os
import subprocess
import uuid
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import pytest

from tutor.content import load_course
from tutor.interpreter import module_command
from tutor.process.isolation_support import try_isolation

FILE = "temperature_publisher.py"
SOLUTION = (load_course().find("i1.1").folder / "solution" / FILE).read_text()
SECRET = "# the idea of ada\n"
TOKEN = "s3cret-of-the-teacher"

# Each of these gets CLASS, RESULTS and MARK: the folders of the class, and what only its own processes have in their
# command lines.
WRITES = """
import json, os
from pathlib import Path
for path in sorted(CLASS.rglob("*.py")):
    if "writes" not in path.parts:
        path.write_text("print('mine')")
for path in RESULTS.rglob("*.json"):
    path.write_text(path.read_text().replace('"passed"', '"failed"'))
"""
READS = """
import os
from pathlib import Path
for folder in (CLASS, RESULTS, CLASS.parent):
    for path in folder.rglob("*"):
        if path.is_file() and "reads" not in path.parts:
            print(path.read_text(), flush=True)
for process in Path("/proc").glob("[0-9]*"):
    try:
        print((process / "environ").read_text().replace(chr(0), " "), flush=True)
    except OSError:
        pass
raise ValueError(os.environ.get("TOKEN", "no token"))
"""
KILLS = """
import os, signal
if not RESULTS.exists():  # or it would end everything on this machine
    os.kill(-1, signal.SIGKILL)
"""
LIES = """
import os, time
import rclpy
from std_msgs.msg import Float64
own = int(os.environ["ROS_DOMAIN_ID"])
nodes = []
for domain in (own - 10, own - 7, own - 3, own + 3, own + 7, own + 10, 0):
    context = rclpy.Context()
    rclpy.init(context=context, domain_id=domain)
    node = rclpy.create_node("impostor", context=context)
    nodes.append(node.create_publisher(Float64, "/sensor/temperature", 10))
for _ in range(40):
    for publisher in nodes:
        publisher.publish(Float64(data=-1000.0))
    time.sleep(0.1)
"""
STARTS_DAEMONS = """
import os
for _ in range(100):
    os.posix_spawn("/bin/sh", ["sh", "-c", "trap '' HUP INT TERM; sleep 100; true", MARK], {}, setsid=True)
"""
FILLS = """
import os
for folder in ("/tmp", "/dev/shm", os.path.dirname(__file__)):
    try:
        for number in range(40_000):
            with open(f"{folder}/{number}", "wb") as file:
                file.write(bytes((1 << 20) if number < 500 else 1))
    except OSError as error:
        print(error, flush=True)
"""
TAKES_TURNS = """
import socket, time
held = []
for name in (f"ros-tutor-{what}-{number}" for what in ("check", "domain") for number in range(1300)):
    held.append(socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM))
    try:
        held[-1].bind(chr(0) + name)
    except OSError:
        held.pop()
    if len(held) > 900:
        break
time.sleep(2)
"""


@dataclass(frozen=True)
class Graded:
    """What `grade` has made of a class."""

    exit: int
    stdout: str
    stderr: str
    results: Mapping[str, str]

    def status(self, learner: str) -> str:
        return str(json.loads(self.results[learner])["status"])

    def criteria(self, learner: str) -> Mapping[str, str]:
        (exercise,) = json.loads(self.results[learner])["report"]["exercises"]
        return {criterion["id"]: criterion["status"] for criterion in exercise["criteria"]}


class Class:
    """A class, on i1.1: programs by learner."""

    def __init__(self, folder: Path, programs: Mapping[str, str]) -> None:
        self.folder, self.results = folder / "class", folder / "results"
        self.mark = f"hostile-{uuid.uuid4().hex}"
        self._tmp, self._home = folder / "tmp", folder / "home"
        for each in (self._tmp, self._home):
            each.mkdir()
        for learner, program in programs.items():
            (self.folder / learner).mkdir(parents=True)
            (self.folder / learner / FILE).write_text(self._known() + program if program != SOLUTION else program)

    def grade(self, *options: str) -> Graded:
        ran = subprocess.run(
            [*module_command("tutor"), "grade", str(self.folder), "--output", str(self.results), *options],
            capture_output=True, text=True, timeout=300, check=False, cwd=self._home,
            env={**os.environ, "TMPDIR": str(self._tmp), "HOME": str(self._home), "TOKEN": TOKEN},
        )  # fmt: skip
        results = {path.parent.name: path.read_text() for path in self.results.glob("*/i1.1.json")}
        return Graded(ran.returncode, ran.stdout, ran.stderr, results)

    def left(self) -> list[str]:
        """Return what is left of the submissions: processes, and temporary files."""
        found = [str(path) for path in self._tmp.glob("*/*") if path.name != "log"]
        for process in Path("/proc").glob("[0-9]*"):
            try:
                command = (process / "cmdline").read_text(errors="replace")
            except OSError:
                continue
            if self.mark in command or str(self._tmp) in command:
                found.append(command)
        return found

    def _known(self) -> str:
        return (
            f"from pathlib import Path\nCLASS, RESULTS = Path({str(self.folder)!r}), Path({str(self.results)!r})\n"
            f"MARK = {self.mark!r}\n"
        )


@pytest.mark.timeout(300)
def test_isolated_hostile_submissions_change_no_verdict_but_their_own(tmp_path: Path) -> None:
    if (problem := try_isolation()) is not None:
        pytest.skip(str(problem))
    hostile = {
        "daemons": STARTS_DAEMONS, "fills": FILLS, "kills": KILLS, "lies": LIES, "reads": READS, "turns": TAKES_TURNS,
        "writes": WRITES,
    }  # fmt: skip
    a_class = Class(tmp_path, {"ada": SOLUTION + SECRET, **hostile, "zoe": SOLUTION})
    before = {path: path.read_bytes() for path in a_class.folder.rglob("*.py")}
    graded = a_class.grade()
    statuses = {learner: graded.status(learner) for learner in graded.results}
    assert statuses.pop("kills") == "error", "it ended what looks after it: twice, alone the second time"
    assert statuses.pop("turns") in ("failed", "error"), "it can take the domains that its own check needs next"
    others = hostile.keys() - {"kills", "turns"}
    assert statuses == {"ada": "passed", "zoe": "passed", **dict.fromkeys(others, "failed")}
    assert graded.exit == 3
    assert set(graded.criteria("ada").values()) == set(graded.criteria("zoe").values()) == {"passed"}
    assert {path: path.read_bytes() for path in a_class.folder.rglob("*.py")} == before
    assert len([*a_class.results.rglob("*.json")]) == len(hostile) + 2
    for text in (*graded.results.values(), graded.stdout, graded.stderr):
        assert SECRET.strip() not in text
        assert TOKEN not in text
    assert a_class.left() == []


@pytest.mark.timeout(300)
def test_without_isolation_what_was_changed_gets_no_verdict_and_the_results_are_those_that_were_judged(
    tmp_path: Path,
) -> None:
    """One after the other, so that ada is judged before the others run, and zoe after they have run."""
    a_class = Class(
        tmp_path,
        {"ada": SOLUTION, "daemons": STARTS_DAEMONS, "turns": TAKES_TURNS, "writes": WRITES, "zoe": SOLUTION},
    )
    graded = a_class.grade("--no-isolation", "--jobs", "1")
    assert (a_class.folder / "ada" / FILE).read_text() == "print('mine')", "this it can do"
    assert graded.status("ada") == "passed"
    assert set(graded.criteria("ada").values()) == {"passed"}, "its result was changed, and is as judged again"
    assert graded.status("zoe") == "error"
    assert "the files were changed while the class was graded" in graded.results["zoe"]
    assert [graded.status(learner) for learner in ("daemons", "writes")] == ["failed", "failed"]
    assert graded.status("turns") in ("failed", "error"), "it can take the domains that its own check needs"
    assert graded.exit == 3
    assert a_class.left() == []
