"""Minimal checks, lessons and learners' programs for the engine's tests."""

from __future__ import annotations

import os
import uuid
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from tutor.content import CriterionText, Difficulty, Lesson, LiveView
from tutor.engine.machine import Machine
from tutor.engine.progress import ScenarioProgress
from tutor.judge.bench import Scenario
from tutor.judge.check import Check, Criterion
from tutor.judge.events import Event
from tutor.judge.result import ExerciseResult
from tutor.judge.submission import Submission
from tutor.judge.verdict import Status, Verdict, passed
from tutor.process.process_table import processes
from tutor.ros import domain

if TYPE_CHECKING:  # it imports rclpy, which needs a prepared environment
    from tutor.engine.bench import RosBench

FILE = "node.py"

# A learner's program that needs no ROS.
WAITS = "import time\nprint('up', flush=True)\ntime.sleep(1000)\n"

# `{}` runs once the node has been created.
NODE = """
import sys, threading, time
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64, String
from example_interfaces.srv import AddTwoInts

rclpy.init()
node = Node("learner")
{}
try:
    rclpy.spin(node)
except (KeyboardInterrupt, ExternalShutdownException):
    pass
finally:
    rclpy.try_shutdown()
"""


def node(*setup: str) -> str:
    """Return the source of a learner's node that runs `setup` before it spins."""
    return NODE.format("\n".join(setup))


PUBLISHES = """
publisher = node.create_publisher(String, "chatter", 10)
node.create_timer(0.05, lambda: publisher.publish(String(data=node.get_name())))
"""


class Scene:
    """Runs learners' scripts in a folder, and tracks their processes and domains."""

    def __init__(self, machine: Machine, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        self.machine = machine
        self.ros = machine.ros
        self.folder = folder
        self.events: list[Event] = []
        self.reserved_domains: set[int] = set()
        self.seen_domains: list[int] = []
        self.token = uuid.uuid4().hex
        monkeypatch.setenv("TEST_TOKEN", self.token)
        self._track_domains(monkeypatch)

    def _track_domains(self, monkeypatch: pytest.MonkeyPatch) -> None:
        import tutor.engine.bench as live

        @contextmanager
        def tracked() -> Iterator[int]:
            with domain.reserve_domain() as reserved:
                self.reserved_domains.add(reserved)
                self.seen_domains.append(reserved)
                try:
                    yield reserved
                finally:
                    self.reserved_domains.remove(reserved)

        monkeypatch.setattr(live, "reserve_domain", tracked)

    def submission(self, **sources: str) -> Submission:
        """Write a submission of the given files (`node="..."` becomes node.py)."""
        for name, source in sources.items():
            (self.folder / f"{name}.py").write_text(source)
        return Submission("t1", {f"{name}.py": self.folder / f"{name}.py" for name in sources})

    def bench(self, source: str) -> RosBench:
        """Return a bench with this script as node.py."""
        return self.bench_of(self.submission(node=source))

    def bench_of(self, submission: Submission) -> RosBench:
        """Return a bench with this submission."""
        from tutor.engine.bench import RosBench

        progress = ScenarioProgress(lambda fraction, doing, so_far: None, LiveView(), set())
        return RosBench(self.machine, submission, refuse_facts, lambda facts: None, progress)

    async def judge(
        self,
        *criteria: Criterion,
        source: str = WAITS,
        only: frozenset[str] | None = None,
        on_event: Callable[[Event], None] | None = None,
        first: bool = False,
    ) -> ExerciseResult:
        """Run a check of these criteria on a script; its events are appended to `events`."""
        from tutor.engine.runner import Runner

        def record(event: Event) -> None:
            self.events.append(event)
            if on_event is not None:
                on_event(event)

        check = Check("t1", criteria)
        submission = self.submission(node=source)
        return await Runner(self.machine, check, lesson(check), submission, only, record, first=first).run()

    def leftovers(self) -> list[int]:
        """Return the pids of living processes that this test has started."""
        mark = f"TEST_TOKEN={self.token}".encode()
        return sorted(pid for pid, p in processes().items() if p.alive and pid != os.getpid() and mark in _environ(pid))


async def refuse_facts(scenario: Scenario[Any]) -> Any:
    """Serve as `bench.facts` for a scenario that must not ask for another scenario's facts."""
    raise AssertionError("no other scenario")


def lesson(check: Check) -> Lesson:
    """Return a lesson for a check; every criterion but the last has a text."""
    return Lesson(
        id=check.exercise,
        title="Made",
        difficulty=Difficulty.EASY,
        unit="",
        objective="",
        files=(),
        criteria=tuple(CriterionText(c.id, f"the text of {c.id}", c.bonus, True, "") for c in check.criteria[:-1]),
        hints=(),
        checklist=(),
        body="",
        folder=Path(),
    )


def criterion(name: str, *facts: Scenario[Any], judge: Callable[..., Verdict] | None = None, **more: Any) -> Criterion:
    """Return a criterion that passes unless `judge` says otherwise."""
    return Criterion(name, judge or (lambda *facts: passed("all", str(facts))), facts, **more)


def assert_failed_for(result: ExerciseResult, mistake: str, words: str) -> None:
    """Assert that the only criterion failed for this mistake, and that the words are in what was observed, or why."""
    (judged,) = result.criteria
    assert judged.verdict.status is Status.FAILED, judged.verdict
    assert words in f"{judged.verdict.observed} | {judged.verdict.cause}", judged.verdict
    assert judged.verdict.mistake == mistake, judged.verdict


def statuses(result: ExerciseResult) -> Mapping[str, str]:
    """Return each criterion's status by id."""
    return {each.id: each.verdict.status.value for each in result.criteria}


def _environ(pid: int) -> list[bytes]:
    try:
        return Path(f"/proc/{pid}/environ").read_bytes().split(b"\0")
    except OSError:
        return []
