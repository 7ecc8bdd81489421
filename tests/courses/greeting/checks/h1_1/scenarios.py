"""The scenario: start the greeter and listen to it."""

from __future__ import annotations

from checks.h1_1.facts import Greeting
from tutor.judge.bench import Bench

LIMIT_S = 15.0


async def first_greeting(bench: Bench) -> Greeting:
    """Start the node and wait for its first message."""
    async with bench.start("greeter.py") as run:
        run.watch("/greeting", "std_msgs/msg/String")
        await run.until(lambda: bool(run.samples_on("/greeting")) or run.exit is not None, LIMIT_S)
        heard = run.samples_on("/greeting")
        return Greeting(heard[0].message["data"] if heard else None, LIMIT_S, run.trace())
