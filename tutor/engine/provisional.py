"""Report preliminary findings about the nodes that a scenario waits for, while it waits."""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncIterator, Callable, Mapping
from contextlib import asynccontextmanager
from dataclasses import replace
from typing import TYPE_CHECKING

from tutor.content import LiveView
from tutor.engine.so_far import RunSnapshot, SoFar, describe
from tutor.judge.verdict import MAX_LINE_CHARACTERS
from tutor.report.plain import one_line

if TYPE_CHECKING:  # it imports rclpy, whose environment must be set by then
    from tutor.engine.run import RosRun

QUIET_WAIT_S = 1.0
"""Waits shorter than this are not commented on."""

UPDATE_INTERVAL_S = 0.5
"""Minimum interval between updates."""

NOTHING = SoFar()


class Provisional:
    """Combines the progress of one scenario with preliminary findings about its runs.

    `on_progress` gets both as (fraction, doing, so far). `requested`: names that the exercise asks for. `published`:
    topics on which any run of the check has published; a set that all scenarios of the check share and update.
    """

    def __init__(
        self, on_progress: Callable[[float, str, SoFar], None], requested: LiveView, published: set[str]
    ) -> None:
        self._on_progress, self._requested, self._published = on_progress, requested, published
        self._followed: list[_FollowedRun] = []
        self._polling: asyncio.Task[None] | None = None
        self._fraction, self._doing, self._so_far = 0.0, "", NOTHING
        self._since = time.monotonic()

    def report(self, fraction: float, doing: str) -> None:
        """Take in the scenario's progress. A new step clears the findings of the step before."""
        if doing != self._doing:
            self._doing, self._so_far, self._since = doing, NOTHING, time.monotonic()
        self._fraction = fraction
        self._on_progress(fraction, doing, self._so_far)

    @asynccontextmanager
    async def follow(self, run: RosRun, watched: Mapping[str, str]) -> AsyncIterator[None]:
        """Poll this run within the block; `watched` maps the topics whose messages are collected to their types."""
        followed = _FollowedRun(run, watched)
        self._followed.append(followed)
        if self._polling is None:
            self._polling = asyncio.ensure_future(self._poll())
        try:
            yield
        finally:
            self._followed.remove(followed)
            if not self._followed:
                polling, self._polling = self._polling, None
                polling.cancel()
                await asyncio.gather(polling, return_exceptions=True)  # an error in here changes no verdict
        if not self._followed and not self._so_far.likely:
            self._update(NOTHING)

    async def _poll(self) -> None:
        while True:
            await asyncio.sleep(max(UPDATE_INTERVAL_S, self._since + QUIET_WAIT_S - time.monotonic()))
            if time.monotonic() < self._since + QUIET_WAIT_S:
                continue
            found = [each.describe(self._requested, self._published) for each in self._followed]
            self._update(max(found, key=lambda each: each.weight, default=NOTHING))

    def _update(self, so_far: SoFar) -> None:
        # The text may contain output of the program.
        so_far = replace(so_far, text=one_line(so_far.text, MAX_LINE_CHARACTERS))
        if so_far != self._so_far:
            self._so_far = so_far
            self._on_progress(self._fraction, self._doing, so_far)


class _FollowedRun:
    """One run, with its latest state and the description of it."""

    def __init__(self, run: RosRun, watched: Mapping[str, str]) -> None:
        self._run, self._watched = run, watched
        self._state: object = None
        self._description = NOTHING

    def describe(self, requested: LiveView, published: set[str]) -> SoFar:
        """Describe the run as it is now; reuse the description if nothing relevant has changed. Updates `published`."""
        run = self._run
        if run.interrupted_at is not None:
            late = run.exit is None and run.now() - run.interrupted_at >= QUIET_WAIT_S
            return SoFar("it has not ended after Ctrl+C yet") if late else NOTHING
        published.update(topic for topic in self._watched if run.samples_on(topic))
        graph = run.peek_graph()
        state = (
            run.exit,
            graph,
            run.awaits_response,
            sum(line.stream == "stderr" for line in run.output),
            bool(run.logs),
            [topic for topic in self._watched if run.samples_on(topic)],
            published.intersection(self._watched),
        )
        if state != self._state:
            self._state = state
            snapshot = RunSnapshot(run.trace_of(graph), self._watched, run.awaits_response, frozenset(published))
            self._description = describe(snapshot, requested)
        return self._description
