"""Run the scenarios of a check for their facts: all at once, each for whichever criteria ask, and again if slowed."""

from __future__ import annotations

import asyncio
import math
import time
from collections import Counter
from collections.abc import Callable, Sequence
from typing import Any

from tutor.content import LiveView
from tutor.engine.bench import RosBench
from tutor.engine.machine import Machine
from tutor.engine.progress import NOTHING, ScenarioProgress, SoFar
from tutor.engine.waits import TOO_BUSY
from tutor.errors import MachineTooBusy
from tutor.interfaces import Build
from tutor.judge.bench import Scenario
from tutor.judge.submission import Submission

MAX_REPEATS = 2
"""Maximum repetitions of a scenario that the machine slowed (see `tutor.judge.bench.was_slowed`)."""

REPEAT_WITHIN_S = 60.0
"""No repetition starts after this much of the check: the machine, or the node itself, is not going to calm down."""


class Scenarios:
    """The scenarios of one check of one submission.

    `requested`: names that the exercise asks for. `on_facts` gets what a scenario found, also before it has ended;
    `on_progress` is called after each change of a scenario's progress.
    """

    def __init__(
        self,
        machine: Machine,
        submission: Submission,
        expected_s: float,
        requested: LiveView,
        on_facts: Callable[[Scenario[Any], object], None],
        on_progress: Callable[[Scenario[Any]], None],
    ) -> None:
        self._machine = machine
        self._submission = submission
        self._expected_s = expected_s
        self._requested = requested
        self._on_facts = on_facts
        self._on_progress = on_progress
        self._tasks: dict[Scenario[Any], asyncio.Task[Any]] = {}
        self._repeats: Counter[Scenario[Any]] = Counter()
        self._progress: dict[Scenario[Any], tuple[float, str, SoFar]] = {}
        self._published: set[str] = set()
        self._started = math.inf
        self.interfaces: Sequence[Build] = ()
        """What became of the submission's interface packages; to be set before the first scenario."""

    def task_of(self, scenario: Scenario[Any]) -> asyncio.Task[Any]:
        """Return the task that gathers a scenario's facts, the last one if it was repeated; start it on first use."""
        if not self._tasks:
            self._started = time.monotonic()
        if scenario not in self._tasks:
            self._tasks[scenario] = asyncio.ensure_future(self._gather_facts(scenario))
        return self._tasks[scenario]

    def repeat(self, scenario: Scenario[Any], last: asyncio.Task[Any], *, alone: bool) -> bool:
        """Start the scenario again, unless its `last` run already was repeated. Return False if out of repetitions."""
        if self._tasks[scenario] is last:
            if self._repeats[scenario] >= MAX_REPEATS or self._is_too_late():
                return False
            self._repeats[scenario] += 1
            self._tasks[scenario] = asyncio.ensure_future(self._gather_facts(scenario, alone=alone))
        return True

    @property
    def tasks(self) -> Sequence[asyncio.Task[Any]]:
        """The tasks of all scenarios. When one has ended, no process of the learner's is left of it."""
        return list(self._tasks.values())

    def progress_of(self, scenarios: Sequence[Scenario[Any]], latest: Scenario[Any]) -> tuple[float, str, str]:
        """Return the progress of scenarios together, what the `latest` one to report does, and what is known so far."""
        progress = [self._progress.get(scenario, (0.0, "", NOTHING)) for scenario in scenarios]
        doing = self._progress[latest][1] or next((text for _, text, _ in progress if text), "")
        known = max((so_far for _, _, so_far in progress), key=lambda so_far: so_far.weight)
        return sum(fraction for fraction, _, _ in progress) / len(progress), doing, known.text

    def _is_too_late(self) -> bool:
        return time.monotonic() - self._started > REPEAT_WITHIN_S

    async def _facts_for_scenario(self, scenario: Scenario[Any]) -> Any:
        """Return the facts of a scenario that another scenario asks for."""
        with self._machine.starts.scenarios.waiting():
            # Shielded: the cancellation of one waiter must not cancel a scenario that others are waiting for, too.
            return await asyncio.shield(self.task_of(scenario))

    async def _gather_facts(self, scenario: Scenario[Any], *, alone: bool = False) -> Any:
        """Run a scenario for its facts, and repeat it alone if it raises MachineTooBusy."""
        for _ in range(MAX_REPEATS):
            try:
                return await self._run(scenario, alone=alone)
            except MachineTooBusy:
                if self._is_too_late():
                    raise
                alone = True
        return await self._run(scenario, alone=alone)

    async def _run(self, scenario: Scenario[Any], *, alone: bool) -> Any:
        def on_progress(fraction: float, text: str, so_far: SoFar) -> None:
            if self._progress.get(scenario) != (fraction, text, so_far):
                self._progress[scenario] = (fraction, text, so_far)
                self._on_progress(scenario)

        bench = RosBench(
            self._machine,
            self._submission,
            self._facts_for_scenario,
            lambda facts: self._on_facts(scenario, facts),
            ScenarioProgress(on_progress, self._requested, self._published),
            self._expected_s,
            self.interfaces,
        )
        async with self._machine.starts.scenarios.running(alone=alone):
            if alone and self._is_too_late():
                raise MachineTooBusy(TOO_BUSY)
            facts = await scenario(bench)
            if bench.sigkilled:  # one run does not show who sent the signal
                facts = await scenario(bench)
        self._on_facts(scenario, facts)
        return facts
