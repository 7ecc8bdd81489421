"""One check, from its start to its end: reads the child's events and passes them on."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from tutor.judge.events import CheckFinished, Event
from tutor.session.engine_child import EngineChild

ENGINE_FAULT = 3
"""The exit code with which the engine tells a fault that it knows."""


@dataclass(frozen=True, slots=True)
class CheckEnded:
    """The check's process is gone. `fault` says what broke in it, if anything; `evidence` is what it wrote last."""

    exercise: str
    cancelled: bool = False
    fault: str = ""
    evidence: tuple[str, ...] = ()


class CheckProcess:
    """A check that runs. `tell` is given every event, and last a `CheckEnded`."""

    def __init__(
        self, exercise: str, command: Sequence[str], cwd: Path, tell: Callable[[Event | CheckEnded], object]
    ) -> None:
        self.exercise = exercise
        self._command, self._cwd, self._tell = command, cwd, tell
        self._child: EngineChild | None = None
        self._cancelled = asyncio.Event()

    @property
    def cancelled(self) -> bool:
        """Whether it was asked to stop."""
        return self._cancelled.is_set()

    def cancel(self) -> None:
        """Ask it to stop; `run` returns when the child has cleaned up."""
        self._cancelled.set()

    async def run(self) -> None:
        """Check. No process of it is left when this returns, or is cancelled."""
        over = CheckEnded(self.exercise)
        try:
            over = await self._run()
        except OSError as error:
            over = CheckEnded(self.exercise, fault=f"the check could not be started: {error.strerror or error}")
        except Exception as error:  # the worker border: our fault must not take the app down
            over = CheckEnded(self.exercise, fault=f"the check broke: {type(error).__name__}: {error}")
        finally:
            if self._child is not None:
                await self._child.stop()
            self._tell(over)

    async def _run(self) -> CheckEnded:
        self._child = child = await EngineChild.start(self._command, self._cwd)
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
                fault = _why(code, child.output_tail)
            return CheckEnded(self.exercise, fault=fault, evidence=child.output_tail if fault else ())
        finally:
            reading.cancel()
            stopping.cancel()

    async def _read(self, child: EngineChild) -> tuple[bool, str]:
        """Whether the check came to its end, and what was wrong with what it said."""
        finished = False
        try:
            async for event in child.events():
                if not self.cancelled:
                    self._tell(event)
                finished = finished or isinstance(event, CheckFinished)
        except ValueError as error:
            return finished, f"the check said something unknown ({error})"
        return finished, ""


def _why(code: int, said: Sequence[str]) -> str:
    """Why a check ended early. With exit code 3 the engine says it itself, in its last line."""
    if code == ENGINE_FAULT and said:
        return said[-1]
    how = f"exit code {code}" if code >= 0 else f"signal {-code}"
    return f"the check ended before it was done ({how})"
