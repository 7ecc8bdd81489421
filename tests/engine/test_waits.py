"""How long messages of a process that has ended are waited for."""

from __future__ import annotations

import asyncio
import os
from typing import Any

import pytest

from tutor.engine import waits
from tutor.engine.waits import DISCOVERY_S, MAX_LATENCY_S, Waits
from tutor.judge.trace import Exit
from tutor.process import CpuTime


class EndedProcess:
    pid = os.getpid()

    def __init__(self, exit: Exit) -> None:
        self.exit = exit


class Clock:
    """The loop's clock, and our own wait for a CPU, both in seconds."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.now, self.cpu_wait_s = 100.0, 3.0
        monkeypatch.setattr(waits, "own_cpu_time", lambda: CpuTime(waited_s=self.cpu_wait_s))

    def last_moment(self, ended: Waits, exit: Exit) -> float:
        """Return after how many seconds nothing is waited for any more."""
        began = self.now
        while ended._may_receive(exit, self.now):
            self.now += 0.01
        return round(self.now - began, 2)


def waits_for(exit: Exit, *, known: bool) -> Waits:
    process: Any = EndedProcess(exit)
    observer: Any = None
    return Waits(process, observer, asyncio.Event(), lambda: known)


@pytest.mark.parametrize(
    ("code", "known", "limit_s"),
    [
        (1, False, DISCOVERY_S),
        (1, True, MAX_LATENCY_S),
        (0, False, MAX_LATENCY_S),  # it may have done all that it wanted to
        (None, False, MAX_LATENCY_S),
    ],
)
def test_less_is_waited_for_a_failed_process_of_which_nothing_is_known(
    monkeypatch: pytest.MonkeyPatch, code: int | None, known: bool, limit_s: float
) -> None:
    exit = Exit(code, 9 if code is None else None, 0.2)
    ended = waits_for(exit, known=known)
    clock = Clock(monkeypatch)
    assert clock.last_moment(ended, exit) == pytest.approx(limit_s, abs=0.02)
    assert clock.last_moment(ended, exit) == 0.0  # only once


def test_our_own_waits_for_a_cpu_extend_it_up_to_the_usual_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    exit = Exit(1, None, 0.2)
    ended = waits_for(exit, known=False)
    clock = Clock(monkeypatch)
    assert ended._may_receive(exit, clock.now)
    clock.cpu_wait_s += 0.2
    assert clock.last_moment(ended, exit) == pytest.approx(DISCOVERY_S + 0.2, abs=0.02)
    clock.cpu_wait_s += 5.0
    assert ended._may_receive(exit, clock.now)
    assert not ended._may_receive(exit, clock.now + MAX_LATENCY_S)
