"""Runs one check in a child process and forwards its events."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine, Sequence
from dataclasses import dataclass

from tutor.judge.events import CheckFinished, Event
from tutor.session.engine_child import EngineChild

ENGINE_FAULT = 3
"""The exit code with which the engine reports a fault that it has described on its last line."""


@dataclass(frozen=True, slots=True)
class CheckEnded:
    """The check's process has exited. `fault` says what broke, if anything; `evidence` is the tail of its output."""

    exercise: str
    cancelled: bool = False
    fault: str = ""
    evidence: tuple[str, ...] = ()


class CheckProcess:
    """A running check, by the engine that `start` starts.

    `tell` is called with every event, and finally with a `CheckEnded`.
    """

    def __init__(
        self,
        exercise: str,
        start: Callable[[], Coroutine[None, None, EngineChild]],
        tell: Callable[[Event | CheckEnded], object],
    ) -> None:
        self.exercise = exercise
        self._start, self._tell = start, tell
        self._child: EngineChild | None = None
        self._cancelled = asyncio.Event()

    @property
    def cancelled(self) -> bool:
        """Whether the check was asked to stop."""
        return self._cancelled.is_set()

    def cancel(self) -> None:
        """Ask the check to stop; `run` returns once the child has cleaned up."""
        self._cancelled.set()

    async def run(self) -> None:
        """Run the check. None of its processes is left when this returns or is cancelled."""
        ended = CheckEnded(self.exercise)
        try:
            ended = await self._run()
        except OSError as error:
            ended = CheckEnded(self.exercise, fault=f"the check could not be started: {error.strerror or error}")
        except Exception as error:  # top level of the worker: a bug of ours must not crash the app
            ended = CheckEnded(self.exercise, fault=f"the check crashed: {type(error).__name__}: {error}")
        finally:
            if self._child is not None:
                await self._child.stop()
            self._tell(ended)

    async def _run(self) -> CheckEnded:
        self._child = child = await self._start()
        reading = asyncio.create_task(self._read(child))
        stopping = asyncio.create_task(self._cancelled.wait())
        try:
            await asyncio.wait({reading, stopping}, return_when=asyncio.FIRST_COMPLETED)
            if self.cancelled:
                await child.stop()
                return CheckEnded(self.exercise, cancelled=True)
            finished, fault = reading.result()
            if fault:
                await child.stop()
            code = await child.ended()
            if not finished and not fault:
                fault = _describe_early_exit(code, child.output_tail)
            return CheckEnded(self.exercise, fault=fault, evidence=child.output_tail if fault else ())
        finally:
            reading.cancel()
            stopping.cancel()

    async def _read(self, child: EngineChild) -> tuple[bool, str]:
        """Forward events to the end; return whether the check finished, and a fault if a line was no event."""
        finished = False
        try:
            async for event in child.events():
                if not self.cancelled:
                    self._tell(event)
                finished = finished or isinstance(event, CheckFinished)
        except ValueError as error:
            return finished, f"the check sent an unknown event ({error})"
        return finished, ""


def _describe_early_exit(code: int, output_tail: Sequence[str]) -> str:
    """Return why a check ended early. With exit code `ENGINE_FAULT`, that is the last line of the engine's output."""
    if code == ENGINE_FAULT and output_tail:
        return output_tail[-1]
    ending = f"exit code {code}" if code >= 0 else f"signal {-code}"
    return f"the check ended before it was done ({ending})"
