"""What one criterion sees of a run, and how it looks once more at a node that did not do what was waited for."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from typing import Any

from tutor.exercise.nouns import agrees
from tutor.judge.bench import Run
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.waiting_for_nodes import HARDLY_WAITED_SHARE, RESENT_S

SPIN_S = 2.0
"""A node that spins answers a parameter request within this time."""

MATCH_S = 0.4
"""Time after which both ends know of each other, once one of them does: what is sent before may be lost."""

Dump = Callable[[], Awaitable[tuple[Frame, ...]]]
"""Returns a stack dump of the node's threads, innermost frame first."""


@dataclass(frozen=True)
class Seen:
    """A run, as far as a criterion looks at it.

    `answers`: whether the node has shown that it spins, or need not. `stuck`: the stack, innermost frame first, of a
    node that does nothing. `slowed`: see `tutor.judge.bench.was_slowed`; `cpu_wait_s`: how long the node waited for a
    CPU.
    """

    trace: Trace
    answers: bool = True
    stuck: tuple[Frame, ...] = ()
    slowed: bool = False
    cpu_wait_s: float = 0.0

    def symptom(self, kind: Symptom, **about: Any) -> Observation:
        """An observation of this symptom in the run."""
        return kind.seen(self.trace, stuck=self.stuck, answers=self.answers, **about)

    def having[S: Seen](self, kind: type[S], **found: Any) -> S:
        """The same as facts of another kind, with what else was found."""
        return kind(**vars(self), **found)


def slowed_so_far(run: Run) -> bool:
    """Whether the node has waited for a CPU so much by now that the machine may be to blame for what it did or left."""
    return run.node_cpu_wait_s() >= HARDLY_WAITED_SHARE * (run.now() - run.started_at)


async def look(run: Run, *, does_nothing: bool = False, dump: Dump | None = None) -> Seen:
    """What is seen now; of a node that `does_nothing`, also whether it answers, and if not, where it is stuck.

    `dump`: returns the stack of another start; without it, the run is ended for that of its own.
    """
    answers = not does_nothing or await run.parameters(SPIN_S) is not None
    if not does_nothing:  # what it does may be seen before the node itself
        await run.until(lambda: bool(run.graph.nodes), RESENT_S, idle_s=RESENT_S)
    trace = run.trace()
    silent = not answers and trace.exit is None and bool(trace.graph.nodes)
    stuck = await (dump or run.dump_stacks)() if silent else ()
    return Seen(trace, answers, stuck, slowed_so_far(run), run.node_cpu_wait_s())


async def settle(run: Run) -> None:
    """Wait until the node knows an endpoint of ours, which is matched on our side, and spins."""
    until = run.now() + MATCH_S
    await run.parameters(SPIN_S)
    await run.until(lambda: run.now() >= until, MATCH_S)


def fits(wanted: Any, value: Any) -> bool:
    """Whether a value is the wanted one, or meets it, if it is a function."""
    return bool(wanted(value)) if callable(wanted) else agrees(value, wanted)
