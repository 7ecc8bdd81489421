"""Tells what is known so far of the nodes that a scenario waits for, while it waits."""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncIterator, Callable, Mapping
from contextlib import asynccontextmanager
from dataclasses import replace
from typing import TYPE_CHECKING

from tutor.content import LiveView
from tutor.engine.so_far import Moment, SoFar, describe
from tutor.judge.verdict import MOST_OF_A_LINE
from tutor.report.plain import one_line

if TYPE_CHECKING:  # it brings in rclpy, which must find its environment chosen
    from tutor.engine.run import RosRun

WAIT_S = 1.0
"""What takes less time than this is waited for in silence."""

EVERY_S = 0.5
"""The words are looked for once in this time at most."""

NOTHING = SoFar()


class Provisional:
    """Of one scenario: takes in its progress, follows its starts, and tells both as (fraction, doing, so far).

    `published`: the topics on which some start of the check has published; shared among its scenarios.
    """

    def __init__(self, tell: Callable[[float, str, SoFar], None], asked: LiveView, published: set[str]) -> None:
        self._tell, self._asked, self._published = tell, asked, published
        self._followed: list[_Followed] = []
        self._looking: asyncio.Task[None] | None = None
        self._fraction, self._doing, self._so_far = 0.0, "", NOTHING
        self._since = time.monotonic()

    def report(self, fraction: float, doing: str) -> None:
        """The scenario goes on: what was known so far was of the step before."""
        if doing != self._doing:
            self._doing, self._so_far, self._since = doing, NOTHING, time.monotonic()
        self._fraction = fraction
        self._tell(fraction, doing, self._so_far)

    @asynccontextmanager
    async def follow(self, run: RosRun, watched: Mapping[str, str]) -> AsyncIterator[None]:
        """Look at this start from time to time; `watched`: the topics whose messages are collected, and their types."""
        mine = _Followed(run, watched)
        self._followed.append(mine)
        if self._looking is None:
            self._looking = asyncio.ensure_future(self._look())
        try:
            yield
        finally:
            self._followed.remove(mine)
            if not self._followed:
                looking, self._looking = self._looking, None
                looking.cancel()
                await asyncio.gather(looking, return_exceptions=True)  # what breaks in here changes no verdict
        if not self._followed and not self._so_far.likely:
            self._say(NOTHING)

    async def _look(self) -> None:
        while True:
            await asyncio.sleep(max(EVERY_S, self._since + WAIT_S - time.monotonic()))
            if time.monotonic() < self._since + WAIT_S:
                continue
            found = [each.describe(self._asked, self._published) for each in self._followed]
            self._say(max(found, key=lambda each: each.weight, default=NOTHING))

    def _say(self, so_far: SoFar) -> None:
        so_far = replace(so_far, text=one_line(so_far.text, MOST_OF_A_LINE))  # it may hold what a program has written
        if so_far != self._so_far:
            self._so_far = so_far
            self._tell(self._fraction, self._doing, so_far)


class _Followed:
    """One start, with the words for what was seen of it last."""

    def __init__(self, run: RosRun, watched: Mapping[str, str]) -> None:
        self._run, self._watched = run, watched
        self._seen: object = None
        self._said = NOTHING

    def describe(self, asked: LiveView, published: set[str]) -> SoFar:
        """The words for now; the same ones where nothing has changed that they could be about."""
        run = self._run
        if run.interrupted_at is not None:
            late = run.exit is None and run.now() - run.interrupted_at >= WAIT_S
            return SoFar("it has not ended after Ctrl+C yet") if late else NOTHING
        published.update(topic for topic in self._watched if run.samples_on(topic))
        graph = run.peek_graph()
        seen = (
            run.exit,
            graph,
            run.unanswered,
            sum(line.stream == "stderr" for line in run.output),
            bool(run.logs),
            [topic for topic in self._watched if run.samples_on(topic)],
            published.intersection(self._watched),
        )
        if seen != self._seen:
            self._seen = seen
            moment = Moment(run.trace_of(graph), self._watched, run.unanswered, frozenset(published))
            self._said = describe(moment, asked)
        return self._said
