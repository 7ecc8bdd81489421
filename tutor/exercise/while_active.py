"""A start that ends with Ctrl+C while a lifecycle node is active."""

from __future__ import annotations

from dataclasses import dataclass

from tutor.exercise.ends_cleanly import EndedRun
from tutor.exercise.lifecycle_walk import Move, make_move, wait_for_services
from tutor.exercise.nouns import Lifecycle, Program
from tutor.judge.bench import Bench
from tutor.judge.ending import repeat_chance_failures
from tutor.judge.waiting_for_nodes import IDLE_S

_MOVES = Move("start", "configure", "inactive"), Move("start", "activate", "active")


@dataclass(frozen=True)
class WhileActive:
    """Start without parameters, configure and activate the node, and press Ctrl+C right after its first message.

    To be given to `EndsCleanly` as its `start`, with the criterion that shows that the node can be activated:

        EndsCleanly("shutdown-active", WhileActive(PROGRAM, CAMERA), activates, after=activates, bonus=True)
    """

    program: Program
    lifecycle: Lifecycle

    async def __call__(self, bench: Bench) -> EndedRun:
        return await repeat_chance_failures(self._run)(bench)

    async def _run(self, bench: Bench) -> EndedRun:
        lifecycle = self.lifecycle
        topic, period_s = lifecycle.topic, 1 / lifecycle.default_hz
        async with bench.start(self.program.file, watch=topic.watched) as run:
            state = "unconfigured" if await wait_for_services(run, lifecycle) else ""
            for move in _MOVES if state else ():
                step = await make_move(run, lifecycle, move, state, period_s)
                state = step.state
                if not step.is_right:
                    break
            if state == "active":
                # The next message is a period away, so a thread that sends them has the time to be told of the end.
                await run.until(lambda: bool(run.samples_on(topic.name)), 2 * period_s + 2, idle_s=IDLE_S)
            trace = run.trace()
            bench.report_progress(0.8, "pressing Ctrl+C while the node is active")
            return EndedRun(trace, await run.interrupt())
