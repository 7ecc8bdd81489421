"""A made course, made verdicts, and an engine whose events come when the test says so."""

from __future__ import annotations

import asyncio
import contextlib
import sys
from collections.abc import Sequence
from pathlib import Path

from textual.pilot import Pilot

from tutor.content import Checklist, Course, CriterionText, Difficulty, Lesson, LessonFile
from tutor.judge.events import CheckFinished, CheckStarted, CriterionJudged, Event, ExerciseJudged, Progress, encode
from tutor.judge.result import CriterionResult, Environment, ExerciseResult, Report
from tutor.judge.verdict import Cause, Verdict, failed, passed, skipped
from tutor.session import Session, run_options
from tutor.session.node import NodeCommand
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

# A node as far as the app can tell: it logs as rclpy does, and ends on Ctrl+C with exit code 0.
NODE = """\
import signal, sys, threading

done = threading.Event()
signal.signal(signal.SIGINT, lambda *_: done.set())
log = lambda level, text: print(f"[{level}] [1763716000.125000000] [thermometer]: {text}", file=sys.stderr, flush=True)
log("INFO", "ready")
log("WARN", "the sensor is warm")
print("a printed line", flush=True)
log("INFO", "a long line " + "x" * 200)
done.wait()
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
    """Three lessons, the second with two files; their skeletons are nodes that run without ROS."""
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


class FakeServices(Session):
    """The real ones, but for the engine, a script that takes its lines from a pipe, and nodes without ROS."""

    def __init__(self, folder: Path, *, started: bool = True, lessons: Course | None = None) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        super().__init__(lessons or course(folder / "course"), Workspace(folder / "ws"))
        self.engine = FakeEngine(folder)
        self.first = False
        if started:
            self.start(self.lessons[0])

    def check_command(self, lesson: Lesson, *, first: bool = False) -> Sequence[str]:
        self.first = first
        return self.engine.command

    def node_command(self, file: LessonFile, options: RunOptions) -> NodeCommand:
        path = self.path(file)
        given = run_options.arguments(options, launch=False)
        return NodeCommand(
            file.name,
            (sys.executable, "-I", str(path), *given),
            {"PYTHONUNBUFFERED": "1"},
            path.parent,
            self.command_line(file, options),
        )


ENGINE = """\
import os, signal, sys, time
from pathlib import Path

folder = Path(sys.argv[1])

def stop(*_):
    (folder / "cleaned-up").write_text("yes")
    sys.exit(130)

signal.signal(signal.SIGINT, stop)
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
    """A child that prints what it is told. `say` blocks until the child listens, so call it in a thread."""

    def __init__(self, folder: Path) -> None:
        import os

        self.folder = folder
        self.fifo = folder / "engine.fifo"
        os.mkfifo(self.fifo)
        script = folder / "engine.py"
        script.write_text(ENGINE)
        self.command = (sys.executable, "-I", str(script), str(folder))
        self._script: object = None
        self._former: list[object] = []

    def say(self, *lines: Event | str) -> None:
        """Have the child print these events; "crash" and "fault" make it end early."""
        if self._script is None:
            self._script = self.fifo.open("w")
        for line in lines:
            self._script.write((line if isinstance(line, str) else encode(line)) + "\n")  # type: ignore[attr-defined]
        self._script.flush()  # type: ignore[attr-defined]

    def close(self) -> None:
        """The end of the script: the child ends."""
        for script in self._former:
            with contextlib.suppress(BrokenPipeError):
                script.close()  # type: ignore[attr-defined]
        if self._script is not None:
            self._script.close()  # type: ignore[attr-defined]
            self._script = None

    def close_quietly(self) -> None:
        """The child ends by itself otherwise; the next one is given a script of its own."""
        self._former.append(self._script)
        self._script = None

    @property
    def cleaned_up(self) -> bool:
        return (self.folder / "cleaned-up").exists()

    @property
    def pid(self) -> int:
        return int((self.folder / "engine.pid").read_text())


GOOD = passed("values from 20.0 to 30.0", "54 values from 20.03 to 29.87")
BAD = failed(
    "publish_rate 5.0 gives 5.0 Hz (within 20 %)",
    "0.20 Hz over 3 messages in 10.1 s",
    Cause(
        "rate used as a period",
        "a period of 5.0 s is a rate of 0.2 Hz",
        "Give create_timer 1.0 / rate: it wants seconds.",
    ),
    ["[INFO] [thermometer]: rate is 5.0", "line 18: self.create_timer(self.rate, self.tick)"],
)


def result(id: str, verdict: Verdict, *, bonus: bool = False) -> CriterionResult:
    return CriterionResult(id, f"the text of {id}", bonus, verdict, 1.25)


def started(exercise: str = "i1.1") -> list[Event]:
    return [CheckStarted(exercise, (*CRITERIA, "shutdown"))]


def doing(criterion: str, fraction: float, text: str, exercise: str = "i1.1", so_far: str = "") -> Event:
    return Progress(exercise, criterion, fraction, text, so_far)


def ending(rate: Verdict, exercise: str = "i1.1", shutdown: Verdict | None = None) -> list[Event]:
    """The rest of a check in which all but `rate` and `shutdown` pass."""
    judged = (
        result("publishes", GOOD),
        result("range", GOOD),
        result("rate", rate),
        result("shutdown", shutdown or (GOOD if rate.passed else skipped("rate did not pass")), bonus=True),
    )
    whole = ExerciseResult(exercise, "Sensor Publisher", ("thermometer.py",), judged, 4.2)
    report = Report(Environment("jazzy", "bundled", "rmw_fastrtps_cpp", "0.1.0"), (whole,), 4.2)
    return [*(CriterionJudged(exercise, c) for c in judged), ExerciseJudged(whole), CheckFinished(report)]


def whole(lesson: Lesson, middle: Verdict) -> list[Event]:
    """The end of a check of any lesson, in which `rate`, else the criterion in the middle, has this verdict."""
    ids = [criterion.id for criterion in lesson.criteria]
    at = ids.index("rate") if "rate" in ids else len(ids) // 2
    judged = tuple(
        CriterionResult(c.id, c.text, c.bonus, middle if i == at else GOOD, 1.0 + i)
        for i, c in enumerate(lesson.criteria)
    )
    done = ExerciseResult(lesson.id, lesson.title, (lesson.files[0].name,), judged, 4.2)
    report = Report(Environment("jazzy", "bundled", "rmw_fastrtps_cpp", "0.1.0"), (done,), 4.2)
    return [*(CriterionJudged(lesson.id, c) for c in judged), ExerciseJudged(done), CheckFinished(report)]


async def opened(app: TutorApp, pilot: Pilot[int], limit_s: float = 30.0) -> None:
    """Wait until the main screen is there, with its lesson and the progress: the app paints before that."""
    async with asyncio.timeout(limit_s):
        while app.main is None or not app.main.model.progress.exercises:
            await pilot.pause(0.02)
    await pilot.pause()
