"""`python -m tutor.engine`: what it writes, how it ends, and that it leaves no process behind."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
import uuid
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from tests.engine.helpers import WAITS
from tutor.judge.events import CheckFinished, CheckStarted, CriterionJudged, Event, ExerciseJudged, Progress, decode
from tutor.judge.verdict import Status
from tutor.process.process_table import descendants, processes

LIMIT_S = 60
SOLUTION = Path(__file__).parents[2] / "lessons" / "i1_1" / "solution"


class Engine:
    """One run of the engine, and the processes that it starts."""

    def __init__(self, *arguments: str | Path) -> None:
        self._known_pids: set[int] = set()
        self._mark = f"TEST_TOKEN={uuid.uuid4().hex}"
        self._process = subprocess.Popen(
            [sys.executable, "-m", "tutor.engine", *map(str, arguments)],
            env={**os.environ, "TEST_TOKEN": self._mark.partition("=")[2]},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )

    def give_arguments(self, *arguments: str | Path) -> None:
        """Give an engine on standby its arguments; none: just close its stdin, as the end of the app does."""
        assert self._process.stdin is not None
        with self._process.stdin as stdin:
            if arguments:
                stdin.write(json.dumps([str(each) for each in arguments]) + "\n")
        self._process.stdin = None

    def running(self) -> list[int]:
        """Return the pids of the engine and its descendants that are still alive."""
        self._known_pids |= {self._process.pid, *(each.pid for each in descendants(self._process.pid))}
        pids = []
        for pid, process in processes().items():
            try:
                mine = self._mark.encode() in Path(f"/proc/{pid}/environ").read_bytes().split(b"\0")
            except OSError:  # it has ended, or is one of ours, which not everybody may read
                mine = False
            if process.alive and (mine or pid in self._known_pids):
                pids.append(pid)
        return pids

    def wait_until(self, enough: Callable[[int], bool]) -> None:
        """Wait until the number of its living processes is as wanted."""
        deadline = time.monotonic() + 20
        while not enough(len(self.running())):
            assert time.monotonic() < deadline
            time.sleep(0.01)

    def read_until(self, kind: type[Event]) -> Event:
        """Read up to the next event of this kind, and return it."""
        assert self._process.stdout is not None
        for line in self._process.stdout:
            if isinstance(event := decode(line), kind):
                return event
        raise AssertionError(f"no {kind.__name__}: {self._process.communicate()}")

    def send_signal(self, number: int) -> None:
        self._process.send_signal(number)

    def close_stdout(self) -> None:
        """Close stdout, as a front end does when it is killed."""
        assert self._process.stdout is not None
        self._process.stdout.close()

    def wait(self) -> tuple[int, list[Event], str]:
        """Wait for the exit; return the exit code, the events not yet read, and stderr."""
        assert self._process.stdout is not None
        out, err = ("", "") if self._process.stdout.closed else self._process.communicate(timeout=LIMIT_S)
        code = self._process.wait(LIMIT_S)
        return code, [decode(line) for line in out.splitlines()], err

    def kill(self) -> None:
        for pid in self.running():
            os.kill(pid, signal.SIGKILL)
        self._process.wait()
        for stream in (self._process.stdin, self._process.stdout, self._process.stderr):
            if stream is not None:
                stream.close()


@contextmanager
def engine(*arguments: str | Path) -> Iterator[Engine]:
    started = Engine(*arguments)
    try:
        yield started
        started.wait_until(lambda running: running == 0)
    finally:
        started.kill()


# Runs the engine's `main` once for each list of arguments, and writes the exit codes to stderr as well.
RUNS_EACH = """
import json, sys
from tutor.engine.__main__ import main
for sys.argv[1:] in json.loads(sys.argv[1]):
    print("exit code", main(), file=sys.stderr)
"""


def test_stdout_has_only_events() -> None:
    with engine("i1.1", SOLUTION, "--criterion", "publishes") as started:
        code, events, err = started.wait()
    assert (code, err) == (0, "")
    assert events[0] == CheckStarted("i1.1", ("publishes",))
    (judged,) = (event for event in events if isinstance(event, CriterionJudged))
    assert judged.result.verdict.status is Status.PASSED
    exercise, finished = events[-2:]
    assert isinstance(exercise, ExerciseJudged)
    assert isinstance(finished, CheckFinished)
    assert finished.report.exercises == (exercise.result,)
    assert exercise.result.criteria == (judged.result,)


def test_an_engine_on_standby_has_imported_everything_and_checks_once_it_has_its_arguments() -> None:
    with engine("--standby") as started:
        started.wait_until(lambda running: running >= 2)  # itself and the fork server
        started.give_arguments("i1.1", SOLUTION, "--criterion", "publishes")
        code, events, err = started.wait()
    assert (code, err) == (0, "")
    assert events[0] == CheckStarted("i1.1", ("publishes",))
    assert isinstance(events[-1], CheckFinished)
    assert events[-1].report.verdict is Status.PASSED


def test_an_engine_on_standby_exits_quietly_when_the_app_ends_or_interrupts_it(tmp_path: Path) -> None:
    with engine("--standby") as unused, engine("--standby") as interrupted, engine("--standby") as misused:
        unused.give_arguments()
        assert unused.wait() == (0, [], "")
        interrupted.wait_until(lambda running: running >= 2)
        interrupted.send_signal(signal.SIGINT)
        interrupted.wait_until(lambda running: running == 0)
        assert interrupted.wait() == (130, [], "")
        misused.give_arguments("i1.1", tmp_path)
        code, events, err = misused.wait()
        assert (code, events) == (2, [])
        assert "temperature_publisher.py" in err


def test_a_failed_check_exits_with_0_reports_what_is_missing_and_with_first_ends_at_the_first_failure() -> None:
    with engine(
        "i1.1", SOLUTION.with_name("skeleton"), "--first", "--criterion", "publishes", "--criterion", "rate"
    ) as started:
        code, events, err = started.wait()
    assert (code, err) == (0, "")
    reported = [event.so_far for event in events if isinstance(event, Progress) and event.criterion == "publishes"]
    assert any("no publisher on /sensor/temperature yet, /temperature_publisher is up" in each for each in reported)
    (exercise,) = (event.result for event in events if isinstance(event, ExerciseJudged))
    statuses = {each.id: each.verdict.status for each in exercise.criteria}
    assert statuses == {"publishes": Status.FAILED, "rate": Status.SKIPPED}
    assert exercise.verdict is Status.FAILED
    finished = events[-1]
    assert isinstance(finished, CheckFinished)
    assert finished.report.verdict is Status.FAILED


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupted_engine_cleans_up(tmp_path: Path, number: int) -> None:
    (tmp_path / "temperature_publisher.py").write_text(WAITS)
    with engine("i1.1", tmp_path, "--criterion", "publishes") as started:
        started.read_until(CheckStarted)
        started.wait_until(lambda running: running >= 3)  # itself, a supervisor and a learner
        started.send_signal(number)
        code, events, err = started.wait()
        assert (code, err) == (130, "")
        assert not any(isinstance(event, CheckFinished) for event in events)


def test_a_killed_engine_leaves_no_process(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TMPDIR", str(tmp_path))  # nobody removes the log folders of a killed engine
    (tmp_path / "temperature_publisher.py").write_text(WAITS)
    with engine("i1.1", tmp_path, "--criterion", "publishes") as started:
        started.read_until(CheckStarted)
        started.wait_until(lambda running: running >= 3)
        started.send_signal(signal.SIGKILL)


def test_the_engine_ends_when_its_reader_is_gone(tmp_path: Path) -> None:
    (tmp_path / "temperature_publisher.py").write_text(WAITS)
    with engine("i1.1", tmp_path, "--criterion", "publishes") as started:
        started.read_until(CheckStarted)
        started.close_stdout()
        code, _, _ = started.wait()
    assert code != 0


def test_wrong_usage_gets_an_error_without_a_traceback(tmp_path: Path) -> None:
    cases: list[tuple[list[str | Path], str]] = [
        (["i9.9", tmp_path], "i9.9"),
        (["i1.1", tmp_path], "temperature_publisher.py"),
        (["i1.1", tmp_path / "nothing.py"], "nothing.py"),
        (["i1.1", SOLUTION, "--lessons", tmp_path], str(tmp_path)),
    ]
    with engine(*cases[0][0]) as started:
        code, *_ = started.wait()
    assert code == 2
    each = json.dumps([list(map(str, arguments)) for arguments, _ in cases])
    answer = subprocess.run(
        [sys.executable, "-c", RUNS_EACH, each], capture_output=True, text=True, check=False, timeout=LIMIT_S
    )
    assert (answer.returncode, answer.stdout) == (0, ""), answer
    errors = answer.stderr.split("exit code 2\n")
    assert errors.pop() == ""
    for (_, word), error in zip(cases, errors, strict=True):
        assert word in error
        assert "Traceback" not in error
