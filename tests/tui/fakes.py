"""A fake course, fake verdicts, and a fake engine whose events come when the test sends them."""

from __future__ import annotations

import asyncio
import contextlib
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import IO

from textual.pilot import Pilot

from tutor.content import Checklist, Course, CriterionText, Difficulty, Lesson, LessonFile
from tutor.judge.events import CheckFinished, CheckStarted, CriterionJudged, Event, ExerciseJudged, Progress, encode
from tutor.judge.result import CriterionResult, Environment, ExerciseResult, Remark, Report
from tutor.judge.verdict import Status, Verdict, passed, skipped
from tutor.session import Session, run_options
from tutor.session.node_command import NodeCommand
from tutor.tui.app import TutorApp
from tutor.workspace import RunOptions, Workspace

BODY = """\
## Objective

Turn the minimal publisher into a **temperature sensor**. It publishes `std_msgs/msg/Float64`.

## Tasks

1. Create a publisher of `Float64` on `/sensor/temperature`.
2. Publish random values from 20.0 to 30.0.

```python
self.publisher = self.create_publisher(Float64, "/sensor/temperature", 10)
```
"""

# A node as far as the app can tell: it logs like rclpy, and exits with code 0 on Ctrl+C.
NODE = """\
import signal, sys

signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])  # until `sigwait`, which misses none
log = lambda level, text: print(f"[{level}] [1763716000.125000000] [thermometer]: {text}", file=sys.stderr, flush=True)
log("INFO", "ready")
log("WARN", "the sensor is warm")
print("a printed line", flush=True)
log("INFO", "a long line " + "x" * 200)
signal.sigwait([signal.SIGINT])
log("INFO", "bye")
"""

STUBBORN = """\
import signal, time

signal.signal(signal.SIGINT, signal.SIG_IGN)
print("deaf", flush=True)
while True:
    time.sleep(1)
"""

CRITERIA = ("publishes", "range", "rate")


def course(folder: Path) -> Course:
    """Three lessons, the second with two files. Their skeletons are nodes that run without ROS."""
    return Course(
        (
            _lesson(folder, "i1.1", "Sensor Publisher", Difficulty.EASY, "I1: Nodes and Topics", ["thermometer.py"]),
            _lesson(
                folder,
                "i1.3",
                "Calculator Service",
                Difficulty.MEDIUM,
                "I1: Nodes and Topics",
                ["server.py", "client.py"],
            ),
            _lesson(folder, "i2.3", "Multi-Threaded Service", Difficulty.CHALLENGE, "I2: rclpy", ["slow.py"]),
        ),
        Checklist(),
    )


def _lesson(folder: Path, id: str, title: str, difficulty: Difficulty, unit: str, names: Sequence[str]) -> Lesson:
    home = folder / id.replace(".", "_")
    files = []
    for name in names:
        file = LessonFile(name, name != "client.py", home / "skeleton" / name, home / "solution" / name)
        for path, text in ((file.skeleton, NODE), (file.solution, "# the solution\n" + NODE)):
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        files.append(file)
    criteria = [
        CriterionText("publishes", "Float64 messages arrive on /sensor/temperature", False, True, "Publish."),
        CriterionText("range", "Every value is from 20.0 to 30.0", False, True, "Use random.uniform."),
        CriterionText("rate", "The publishing rate can be set with a parameter", False, True, "Declare it."),
        CriterionText("shutdown", "Ctrl+C ends the node cleanly", True, True, "Catch it."),
    ]
    hints = ("Think of a timer.", "create_timer takes seconds.", "Write self.create_timer(1.0 / rate, self.tick).")
    body = BODY.replace("temperature sensor", f"temperature sensor ({id})")
    return Lesson(id, title, difficulty, unit, "Publish.", tuple(files), tuple(criteria), hints, (), body, home)


class FakeSession(Session):
    """A real session, but its engine is a script that reads its lines from a pipe, and its nodes run without ROS."""

    def __init__(self, folder: Path, *, started: bool = True, lessons: Course | None = None) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        super().__init__(lessons or course(folder / "course"), Workspace(folder / "ws"))
        self.engine = FakeEngine(folder)
        self.may_keep_engine = False
        self.first = False
        if started:
            self.start(self.lessons[0])

    def check_arguments(self, lesson: Lesson, *, first: bool = False) -> Sequence[str]:
        self.first = first
        return super().check_arguments(lesson, first=first)

    def engine_command(self, *arguments: str) -> Sequence[str]:
        return self.engine.command

    def node_command(self, file: LessonFile, options: RunOptions) -> NodeCommand:
        path = self.path(file)
        arguments = run_options.arguments(options, launch=False)
        return NodeCommand(
            file.name,
            (sys.executable, "-I", str(path), *arguments),
            {"PYTHONUNBUFFERED": "1"},
            path.parent,
            self.command_line(file, options),
        )


ENGINE = """\
import os, signal, sys, threading
from pathlib import Path

folder = Path(sys.argv[1])

def stop():
    signal.sigwait([signal.SIGINT])
    (folder / "cleaned-up").write_text("yes")
    os._exit(130)

signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
threading.Thread(target=stop, daemon=True).start()  # a handler would wait for the end of a read that has just begun
(folder / "engine.pid").write_text(str(os.getpid()))
with open(folder / "engine.fifo") as script:
    for line in script:
        if line.startswith("crash"):
            raise RuntimeError("the engine has a bug")
        if line.startswith("fault"):
            print("no domain is free. End other checks first.", file=sys.stderr)
            sys.exit(3)
        print(line, end="", flush=True)
"""


class FakeEngine:
    """A child process that prints what it is sent. `emit` blocks until the child reads, so call it in a thread."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.fifo = folder / "engine.fifo"
        os.mkfifo(self.fifo)
        script = folder / "engine.py"
        script.write_text(ENGINE)
        self.command = (sys.executable, "-I", str(script), str(folder))
        self._pipe: IO[str] | None = None
        self._detached: list[IO[str]] = []

    def emit(self, *lines: Event | str) -> None:
        """Have the child print these events. "crash" and "fault" make it end early."""
        if self._pipe is None:
            self._pipe = self.fifo.open("w")
        for line in lines:
            self._pipe.write((line if isinstance(line, str) else encode(line)) + "\n")
        self._pipe.flush()

    def close(self) -> None:
        """Close all pipes: a child exits when it reads the end of its own."""
        for pipe in self._detached:
            with contextlib.suppress(BrokenPipeError):
                pipe.close()
        if self._pipe is not None:
            self._pipe.close()
            self._pipe = None

    def detach(self) -> None:
        """Give the next child another pipe, and keep the current one open: at its end, the current child would exit."""
        assert self._pipe is not None
        self._detached.append(self._pipe)
        self._pipe = None

    @property
    def cleaned_up(self) -> bool:
        return (self.folder / "cleaned-up").exists()

    @property
    def pid(self) -> int:
        return int((self.folder / "engine.pid").read_text())


GOOD = passed("values from 20.0 to 30.0", "54 values from 20.03 to 29.87")
BAD = Verdict(
    Status.FAILED,
    "publish_rate 5.0 gives 5.0 Hz (within 20 %)",
    "0.20 Hz over 3 messages in 10.1 s",
    "rate used as a period: a period of 5.0 s is a rate of 0.2 Hz",
    "Give the timer the time between two calls, in seconds.",
    ("[INFO] [thermometer]: rate is 5.0", "line 18: self.create_timer(self.rate, self.tick)"),
    mistake="rate-used-as-a-period",
    place="thermometer.py:18",
)


def result(id: str, verdict: Verdict, *, bonus: bool = False) -> CriterionResult:
    return CriterionResult(id, f"the text of {id}", bonus, verdict, 1.25)


def started_events(exercise: str = "i1.1") -> list[Event]:
    return [CheckStarted(exercise, (*CRITERIA, "shutdown"))]


def progress_event(criterion: str, fraction: float, text: str, exercise: str = "i1.1", so_far: str = "") -> Event:
    return Progress(exercise, criterion, fraction, text, so_far)


def final_events(
    rate: Verdict,
    exercise: str = "i1.1",
    shutdown: Verdict | None = None,
    *,
    range: Verdict = GOOD,
    remarks: Sequence[Remark] = (),
) -> list[Event]:
    """The remaining events of a check in which these criteria get these verdicts, and the rest passes."""
    judged = (
        result("publishes", GOOD),
        result("range", range),
        result("rate", rate),
        result("shutdown", shutdown or (GOOD if rate.passed else skipped("rate did not pass")), bonus=True),
    )
    done = ExerciseResult(exercise, "Sensor Publisher", ("thermometer.py",), judged, 4.2, remarks=tuple(remarks))
    report = Report(Environment("jazzy", "bundled", "rmw_fastrtps_cpp", "0.1.0"), (done,), 4.2)
    return [*(CriterionJudged(exercise, c) for c in judged), ExerciseJudged(done), CheckFinished(report)]


def lesson_final_events(lesson: Lesson, middle: Verdict) -> list[Event]:
    """The final events of a check of any lesson. Its `rate`, or else its middle criterion, gets this verdict."""
    ids = [criterion.id for criterion in lesson.criteria]
    index = ids.index("rate") if "rate" in ids else len(ids) // 2
    judged = tuple(
        CriterionResult(c.id, c.text, c.bonus, middle if i == index else GOOD, 1.0 + i)
        for i, c in enumerate(lesson.criteria)
    )
    done = ExerciseResult(lesson.id, lesson.title, (lesson.files[0].name,), judged, 4.2)
    report = Report(Environment("jazzy", "bundled", "rmw_fastrtps_cpp", "0.1.0"), (done,), 4.2)
    return [*(CriterionJudged(lesson.id, c) for c in judged), ExerciseJudged(done), CheckFinished(report)]


async def wait_until_ready(app: TutorApp, pilot: Pilot[int], limit_s: float = 30.0) -> None:
    """Wait for the main screen with its lesson and the progress: the app paints before it has them."""
    async with asyncio.timeout(limit_s):
        while app.main is None or not app.main.model.progress.exercises:
            await pilot.pause(0.02)
    await pilot.pause()
