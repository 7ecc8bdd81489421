"""What `run_until_stopped` does when a stop signal arrives, at any moment."""

from __future__ import annotations

import asyncio
import os
import signal
import threading
from collections.abc import Coroutine

import pytest

from tutor.stop_signals import STOP_SIGNALS, Stopped, run_until_stopped


def press(number: signal.Signals = signal.SIGINT) -> None:
    os.kill(os.getpid(), number)


def test_the_result_of_the_work_is_returned() -> None:
    async def work() -> str:
        return "done"

    assert run_until_stopped(work) == "done"


@pytest.mark.parametrize("number", STOP_SIGNALS)
def test_a_signal_cancels_the_work_which_cleans_up_undisturbed(number: signal.Signals) -> None:
    events: list[str] = []

    async def work() -> None:
        try:
            press(number)
            await asyncio.sleep(30)
        finally:
            press(number)  # an impatient second one
            await asyncio.sleep(0.01)
            events.append("cleaned up")

    with pytest.raises(Stopped):
        run_until_stopped(work, lambda: events.append("stopping"))
    assert events == ["stopping", "cleaned up"]


def test_a_signal_during_the_setup_of_the_loop_waits_for_it() -> None:
    """It would raise a KeyboardInterrupt here, whichever thread the kernel gives the signal to."""
    events: list[str] = []
    handlers = [signal.getsignal(number) for number in STOP_SIGNALS]

    def start() -> Coroutine[None, None, None]:
        press()
        return asyncio.sleep(30)

    end = threading.Event()
    other = threading.Thread(target=end.wait)
    other.start()
    try:
        with pytest.raises(Stopped):
            run_until_stopped(start, lambda: events.append("stopping"))
    finally:
        end.set()
        other.join()
    assert events == ["stopping"]
    assert [signal.getsignal(number) for number in STOP_SIGNALS] == handlers


def test_a_cancellation_without_a_signal_is_a_fault() -> None:
    async def work() -> None:
        raise asyncio.CancelledError

    with pytest.raises(RuntimeError, match="without a stop signal"):
        run_until_stopped(work)
