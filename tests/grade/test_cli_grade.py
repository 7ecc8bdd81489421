"""`ros-tutor grade` from the command line: exit codes, what goes where, and the question about isolation."""

from __future__ import annotations

import csv
import io
import json
import os
import pty
import re
import select
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.grade import made
from tests.grade.grade_process import GradeProcess
from tutor.cli import main
from tutor.content import load_course
from tutor.grade import grading
from tutor.grade.grading import LocalExecutor
from tutor.grade.unit import OnEvent, Outcome, Unit

PUBLISHER = "temperature_publisher.py"
LIMIT_S = 100.0


class MadeResults(LocalExecutor):
    """Runs no code: Ada passes, Brian fails, and what Eve hands in cannot be judged."""

    async def run(self, unit: Unit, on_event: OnEvent) -> Outcome:
        learner = unit.key.split("/")[0]
        if learner == "eve":
            return Outcome(None, fault="no ROS domain id is free\x1b[31m")
        result = (made.failing if learner == "brian" else made.passing)(made.ADA, unit.exercise)
        return Outcome(result.report, cpu_s=1.0)


@pytest.fixture
def no_checks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(grading, "LocalExecutor", MadeResults)


@pytest.fixture
def a_class(tmp_path: Path) -> Path:
    folder = tmp_path / "class"
    for learner in ("ada", "brian"):
        (folder / learner).mkdir(parents=True)
        (folder / learner / PUBLISHER).write_text(f"# {learner}\n")
    (folder / "chloe").mkdir()
    (folder / "notes.txt").write_text("")
    return folder


class Ran:
    """What a command wrote, and its exit code."""

    def __init__(self, capsys: pytest.CaptureFixture[str], *words: str | Path) -> None:
        capsys.readouterr()
        self.code = main(["grade", *map(str, words)])
        self.out, self.err = capsys.readouterr()


def test_stdout_is_the_report_and_stderr_says_how_it_goes(
    a_class: Path, no_checks: None, capsys: pytest.CaptureFixture[str]
) -> None:
    ran = Ran(capsys, a_class, "--no-isolation", "--format", "csv", "--jobs", "1")
    assert ran.code == 0
    rows = list(csv.DictReader(io.StringIO(ran.out)))
    assert [(row["learner"], row["status"], row["score"]) for row in rows] == [
        *(("ada", "passed", "10"), ("brian", "failed", rows[1]["score"]), ("chloe", "missing", "0"))
    ]
    lines = ran.err.splitlines()
    assert all(line.startswith("ros-tutor: ") for line in lines)
    assert [re.sub(r"^ros-tutor: +|\d+(?= seconds)", "", line) for line in lines] == [
        "left out, as nobody's submission: notes.txt",
        "3 learners, i1.1: 3 results, 1 without files",
        "2 checks to run: about  seconds, 1 check at once",
        "1 of 3  chloe  i1.1  missing  nothing was handed in",
        "2 of 3  ada  i1.1  passed  4.0 s",
        f"3 of 3  brian  i1.1  failed  4.0 s, not passed: {rows[1]['failed'].replace(' ', ', ')}",
    ]
    results = a_class.with_name("class-results")
    assert sorted(path.name for path in results.iterdir()) == ["ada", "brian", "chloe"]
    again = Ran(capsys, a_class, "--no-isolation", "--format", "csv")
    assert (again.code, again.out) == (0, ran.out)
    assert again.err.splitlines()[1:] == [
        "ros-tutor: 3 learners, i1.1: 3 results, 2 of them judged before, 1 without files",
        "ros-tutor:    1 of 1  chloe  i1.1  missing  nothing was handed in",
    ]


def test_a_fault_that_is_left_is_exit_code_3(
    a_class: Path, no_checks: None, capsys: pytest.CaptureFixture[str]
) -> None:
    (a_class / "eve\nvil").mkdir()
    (a_class / "eve").mkdir()
    (a_class / "eve" / PUBLISHER).write_text("#")
    ran = Ran(capsys, a_class, "--no-isolation")
    assert ran.code == 3
    lines = ran.err.splitlines()
    assert all(line.startswith("ros-tutor: ") for line in lines)
    assert "\x1b" not in ran.err + ran.out
    assert lines[-1].startswith("ros-tutor: not judged: eve, i1.1: no ROS domain id is free")
    assert sum(" eve  i1.1  error" in line for line in lines) == 2  # it was repeated
    assert "✓ 10" in ran.out
    # A second start does what is missing.
    assert sum(" i1.1  error" in line for line in Ran(capsys, a_class, "--no-isolation").err.splitlines()) == 2


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ((), "name the SUBMISSIONS of the class"),
        (("none",), "there is no none"),
        (("class", "--jobs", "0"), "--jobs 0: at least one"),
        (("class", "--jobs", "many"), "argument --jobs: invalid int value"),
        (("class", "--limit", "0"), "--limit 0.0: a number of seconds above 0"),
        (("class", "--limit", "nan"), "--limit nan"),
        (("class", "--exercise", "i9.9"), "There is no exercise 'i9.9'"),
        (("class", "--layout", "{exercise}"), "{learner} is missing"),
        (("class", "--roster", "none.csv"), "--roster none.csv: cannot be read"),
        (("class", "--points", "none.toml"), "none.toml cannot be read"),
        (("class", "--shard", "9/8"), "--shard 9/8: write it as 3/8"),
        (("class", "--output", "class/ada"), "--output class/ada: it is in class"),
        (("class", "--output", "class/notes.txt"), "this is a file"),
        (("class", "--format", "excel"), "invalid choice: 'excel'"),
        (("class", "--scheduler", "tcp://x"), "--scheduler needs --executor dask"),
        (("--collect", "class"), "--collect needs --output"),
        (("class", "--colect", "x"), "did you mean --collect"),
    ],
)
def test_wrong_usage_is_exit_code_2(
    a_class: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    words: tuple[str, ...],
    message: str,
) -> None:
    monkeypatch.chdir(a_class.parent)
    ran = Ran(capsys, *words)
    assert (ran.code, ran.out) == (2, "")
    assert message in ran.err
    assert ran.err.count("\n") == 1
    assert not a_class.with_name("class-results").exists()


def test_help_says_what_there_is(capsys: pytest.CaptureFixture[str]) -> None:
    ran = Ran(capsys, "--help")
    assert (ran.code, ran.err) == (0, "")
    for word in ("SUBMISSIONS", "--exercise", "--layout", "--roster", "--points", "--output", "--format", "--steps"):
        assert word in ran.out
    for word in ("--jobs", "--limit", "--again", "--no-isolation", "--shard", "--collect", "--executor", "--scheduler"):
        assert word in ran.out
    assert max(map(len, ran.out.splitlines())) <= 120


def test_a_result_that_cannot_be_written(a_class: Path, no_checks: None, capsys: pytest.CaptureFixture[str]) -> None:
    a_class.with_name("class-results").mkdir()
    (a_class.with_name("class-results") / "ada").write_text("in the way")
    ran = Ran(capsys, a_class, "--no-isolation")
    assert (ran.code, ran.out) == (3, "")
    assert "cannot create" in ran.err.splitlines()[-1]


# --- real processes ---


def test_a_class_is_graded_kept_and_collected(tmp_path: Path) -> None:
    lesson = load_course().find("i1.3")
    shutil.copytree(lesson.files[0].solution.parent, tmp_path / "class/ada")
    (tmp_path / "class/bob").mkdir()
    (tmp_path / "class/bob/calculator.py").write_text("print()\n")

    def grade(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
        argv = [sys.executable, "-m", "tutor", "grade", *map(str, arguments), "--format", "csv"]
        return subprocess.run(argv, capture_output=True, text=True, check=False, timeout=LIMIT_S)

    first = grade(tmp_path / "class", "--no-isolation", "--output", tmp_path / "results")
    assert first.returncode == 0, first.stderr
    rows = first.stdout.splitlines()
    assert rows[1].startswith("ada,ada,,,i1.3,passed,10,10,")
    assert rows[2].startswith("bob,bob,,,i1.3,missing,0,10,")
    document = json.loads((tmp_path / "results/ada/i1.3.json").read_text())
    assert (document["schema"], document["status"]) == ("ros-tutor/result/1", "passed")
    assert document["cpu_s"] > 0
    again = grade(tmp_path / "class", "--output", tmp_path / "results")
    assert again.stdout == first.stdout
    assert "1 of them judged before" in again.stderr
    assert grade("--collect", tmp_path / "results", "--output", tmp_path / "all").stdout == first.stdout


NEVER_READY = "import time\ntime.sleep(1000)\n"


def test_ctrl_c_ends_cleanly(tmp_path: Path) -> None:
    submissions = tmp_path / "class"
    (submissions / "ada").mkdir(parents=True)
    (submissions / "ada" / PUBLISHER).write_text(NEVER_READY)
    (submissions / "ben").mkdir()
    grade = GradeProcess([submissions, "--output", tmp_path / "results", "--exercise", "i1.1"], tmp_path / "tmp")
    try:
        deadline = time.monotonic() + LIMIT_S
        while not any("tutor.engine i1.1" in line for line in grade.left_running()):
            assert grade.process.poll() is None, grade.err.read_text()
            assert time.monotonic() < deadline
            time.sleep(0.05)
        os.kill(grade.process.pid, signal.SIGINT)
        assert grade.wait(LIMIT_S) == 130
    finally:
        grade.process.kill()
    assert grade.out.read_text() == ""
    lines = grade.err.read_text().splitlines()
    assert lines[-2] == "ros-tutor: stopping everything that was started"
    assert lines[-1].startswith(f"ros-tutor: interrupted; what was judged is in {tmp_path / 'results'}")
    assert sorted(path.name for path in (tmp_path / "results").rglob("*")) == ["ben", "i1.1.json"]
    assert grade.left_running() == []
    assert grade.left_files() == []


WITHOUT_BWRAP = {**os.environ, "PATH": "/nonexistent", "TERM": "xterm", "COLUMNS": "300"}


def test_without_isolation_and_without_anybody_to_ask_nothing_is_checked(a_class: Path) -> None:
    ran = subprocess.run(
        [sys.executable, "-m", "tutor", "grade", str(a_class)],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        env=WITHOUT_BWRAP,
        timeout=LIMIT_S,
        check=False,
    )
    assert (ran.returncode, ran.stdout) == (3, "")
    last = ran.stderr.splitlines()[-1]
    assert "submissions cannot be isolated here" in last
    assert "bubblewrap" in last
    assert "--no-isolation" in last
    assert not a_class.with_name("class-results").exists()


class Terminal:
    """A command in a terminal of its own."""

    def __init__(self, *command: str) -> None:
        self.shown = ""
        self.pid, self._fd = pty.fork()
        if self.pid == 0:
            os.execve(command[0], command, WITHOUT_BWRAP)

    def wait_for(self, text: str) -> None:
        deadline = time.monotonic() + LIMIT_S
        while text not in self.shown:
            assert time.monotonic() < deadline, self.shown
            if not self._read():
                raise AssertionError(f"it has ended: {self.shown}")

    def type(self, text: str) -> None:
        os.write(self._fd, text.encode())

    def end(self) -> int:
        while self._read():
            pass
        os.close(self._fd)
        return os.waitstatus_to_exitcode(os.waitpid(self.pid, 0)[1])

    def _read(self) -> bool:
        select.select([self._fd], [], [], 1.0)
        try:
            part = os.read(self._fd, 65536)
        except OSError:  # the end of a terminal
            return False
        self.shown += part.decode(errors="replace")
        return bool(part)


QUESTION = "Go on without isolation? [y/N] "


@pytest.mark.parametrize("answer", ["n\n", "\n", "\x04"])
def test_whoever_can_answer_is_asked(a_class: Path, answer: str) -> None:
    terminal = Terminal(sys.executable, "-m", "tutor", "grade", str(a_class))
    terminal.wait_for(QUESTION)
    terminal.type(answer)
    assert terminal.end() == 3
    assert "they can read and change your files" in terminal.shown
    assert "nothing was checked" in terminal.shown
    assert not a_class.with_name("class-results").exists()


def test_who_says_yes_gets_a_live_table_and_can_stop(a_class: Path) -> None:
    (a_class / "ada" / PUBLISHER).write_text(NEVER_READY)
    (a_class / "brian" / PUBLISHER).unlink()
    terminal = Terminal(sys.executable, "-m", "tutor", "grade", str(a_class), "--exercise", "i1.1")
    terminal.wait_for(QUESTION)
    terminal.type("y\n")
    terminal.wait_for("2 of 3")  # those of whom there is nothing to judge
    terminal.wait_for("left")
    terminal.type("\x03")
    assert terminal.end() == 130
    assert "interrupted; what was judged is in" in terminal.shown
    assert "\x1b[?25h" in terminal.shown  # the cursor is back
