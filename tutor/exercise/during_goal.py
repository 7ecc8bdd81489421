"""A start that ends with Ctrl+C while a goal is being executed."""

from __future__ import annotations

from dataclasses import dataclass, field

from tutor.exercise.ends_cleanly import EndedRun
from tutor.exercise.goal_run import Goal, drawn, is_over, send, wait_for_server
from tutor.exercise.nouns import Action, Program
from tutor.judge.bench import Bench
from tutor.judge.ending import repeat_chance_failures

UNDER_WAY_S = 0.6
"""How long a goal runs before Ctrl+C."""


@dataclass(frozen=True)
class DuringGoal:
    """Start without parameters, send a goal that takes long, and press Ctrl+C while it runs.

    To be given to `EndsCleanly` as its `start`, with the criterion that shows that goals are handled:

        EndsCleanly("shutdown-busy", DuringGoal(SERVER, COUNT, {"order": 50}), counts, after=counts, bonus=True)
    """

    program: Program
    action: Action
    goal: Goal = field(hash=False)

    async def __call__(self, bench: Bench) -> EndedRun:
        return await repeat_chance_failures(self._run)(bench)

    async def _run(self, bench: Bench) -> EndedRun:
        action = self.action
        async with (
            bench.start(self.program.file) as run,
            run.goal_client(action.name, action.type) as client,
        ):
            if await wait_for_server(run, action, client) and await send(run, client, drawn(self.goal)):
                await run.until(lambda: is_over(client), UNDER_WAY_S)
            trace = run.trace()
            bench.report_progress(0.8, "pressing Ctrl+C while a goal runs")
            return EndedRun(trace, await run.interrupt())
