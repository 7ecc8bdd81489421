"""Tiny checks, tiny lessons and tiny learners."""

from __future__ import annotations

import os
import uuid
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from tutor.content import CriterionText, Difficulty, Lesson
from tutor.judge.bench import Scenario
from tutor.judge.check import Check, Criterion
from tutor.judge.events import Event
from tutor.judge.result import ExerciseResult
from tutor.judge.submission import Submission
from tutor.judge.verdict import Verdict, passed
from tutor.process.supervisor import processes
from tutor.ros import domain
from tutor.ros.environment import RosEnvironment

if TYPE_CHECKING:  # they bring in rclpy, which must find its environment chosen
    from tutor.engine.bench import RosBench

FILE = "node.py"

# A learner that needs no ROS.
WAITS = "import time\nprint('up', flush=True)\ntime.sleep(1000)\n"

# `{}` is what the node does when it has been made.
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


def node(*does: str) -> str:
    """A learner's node."""
    return NODE.format("\n".join(does))


PUBLISHES = """
publisher = node.create_publisher(String, "chatter", 10)
node.create_timer(0.05, lambda: publisher.publish(String(data=node.get_name())))
"""


class Scene:
    """Learners' scripts in a folder, and what is left of them."""

    def __init__(self, ros: RosEnvironment, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        self.ros = ros
        self.folder = folder
        self.events: list[Event] = []
        self.held: set[int] = set()
        self.domains: list[int] = []
        self.token = uuid.uuid4().hex
        monkeypatch.setenv("TEST_TOKEN", self.token)
        self._watch_domains(monkeypatch)

    def _watch_domains(self, monkeypatch: pytest.MonkeyPatch) -> None:
        import tutor.engine.bench as live

        @contextmanager
        def watched() -> Iterator[int]:
            with domain.reserve_domain() as reserved:
                self.held.add(reserved)
                self.domains.append(reserved)
                try:
                    yield reserved
                finally:
                    self.held.remove(reserved)

        monkeypatch.setattr(live, "reserve_domain", watched)

    def submission(self, **sources: str) -> Submission:
        """A submission of the given files (`node="..."` is node.py)."""
        for name, source in sources.items():
            (self.folder / f"{name}.py").write_text(source)
        return Submission("t1", {f"{name}.py": self.folder / f"{name}.py" for name in sources})

    def bench(self, source: str) -> RosBench:
        """A bench on which this script is node.py."""
        from tutor.engine.bench import RosBench

        return RosBench(self.submission(node=source), self.ros, nothing_shared, lambda fraction, text: None)

    async def judge(
        self,
        *criteria: Criterion,
        source: str = WAITS,
        only: frozenset[str] | None = None,
        on_event: Callable[[Event], None] | None = None,
        first: bool = False,
    ) -> ExerciseResult:
        """Run a check of these criteria on a script; its events are kept in `events`."""
        from tutor.engine.runner import Runner

        def hear(event: Event) -> None:
            self.events.append(event)
            if on_event is not None:
                on_event(event)

        check = Check("t1", criteria)
        submission = self.submission(node=source)
        return await Runner(check, lesson(check), submission, self.ros, only, hear, first=first).run()

    def left(self) -> list[int]:
        """The living processes that were started by this test."""
        mark = f"TEST_TOKEN={self.token}".encode()
        return sorted(pid for pid, p in processes().items() if p.alive and pid != os.getpid() and mark in _environ(pid))


async def nothing_shared(scenario: Scenario[Any]) -> Any:
    """For a bench whose scenario asks for the facts of no other one."""
    raise AssertionError("no other scenario")


def lesson(check: Check) -> Lesson:
    """A lesson for a check; every criterion has a text but the last."""
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
    """A criterion that passes, unless `judge` says otherwise."""
    return Criterion(name, judge or (lambda *facts: passed("all", str(facts))), facts, **more)


def plain(result: ExerciseResult) -> Mapping[str, str]:
    """Each criterion's status."""
    return {each.id: each.verdict.status.value for each in result.criteria}


def _environ(pid: int) -> list[bytes]:
    try:
        return Path(f"/proc/{pid}/environ").read_bytes().split(b"\0")
    except OSError:
        return []
