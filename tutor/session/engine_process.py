"""The engine as a child process, whose crash does not affect the app: started, kept ready, and run for a check."""

from __future__ import annotations

import asyncio
import json
import signal
from collections.abc import AsyncIterator, Callable, Coroutine, Sequence
from dataclasses import dataclass
from pathlib import Path

from tutor.judge.events import CheckFinished, Event, decode
from tutor.process import orphans, prctl
from tutor.process.line_child import LineChild

CLEAN_UP_S = 10.0
"""Timeout for a cancelled check to end the learner's processes, in seconds."""

KEEP_READY_S = 300.0
"""How long an engine is kept ready: it takes memory."""

ENGINE_FAULT = 3
"""The exit code with which the engine reports a fault that it has described on its last line."""


class EngineChild(LineChild):
    """One run of the engine, which prints one event per line."""

    @classmethod
    async def start(cls, argv: Sequence[str], cwd: Path, *, standby: bool = False) -> EngineChild:
        """Start the engine; `standby`: it reads its arguments from stdin (see `give_arguments`). Raises OSError."""
        prctl.guard()
        prctl.adopt_orphans(True)
        return await cls._start(argv, cwd, stdin=asyncio.subprocess.PIPE if standby else asyncio.subprocess.DEVNULL)

    @property
    def running(self) -> bool:
        """Whether it has not exited yet, as far as is known."""
        return self._process.returncode is None

    def give_arguments(self, arguments: Sequence[str]) -> None:
        """Give an engine on standby its arguments. If it has just exited, they are lost."""
        assert self._process.stdin is not None
        self._process.stdin.write(json.dumps(arguments).encode() + b"\n")

    async def events(self) -> AsyncIterator[Event]:
        """Yield events as they arrive, until the child closes its output.

        Raises ValueError for a line that is not an event.
        """
        async for line in self.lines():
            yield decode(line)

    async def ended(self) -> int:
        """Wait for the child to exit; return its exit code, negative for a signal."""
        code = await self._process.wait()
        await self._reader
        return code

    async def stop(self, limit_s: float = CLEAN_UP_S) -> None:
        """Interrupt the child and wait until it has cleaned up; kill it if that takes longer than `limit_s`."""
        for signum in (signal.SIGINT, signal.SIGKILL):
            if self._process.returncode is None:
                self.send_signal(signum)
                try:
                    await asyncio.wait_for(self._process.wait(), limit_s)
                except TimeoutError:
                    continue
        self._reader.cancel()
        if self._process.returncode is not None and self._process.returncode < 0:
            orphans.end_orphans()  # it was killed and could not clean up


class EngineStarter:
    """Starts engines with `command(*arguments)`. One that is kept ready begins its check most of a second sooner."""

    def __init__(self, command: Callable[..., Sequence[str]]) -> None:
        self._command = command
        self._ready: EngineChild | None = None
        self._cwd: Path | None = None
        self._over: asyncio.Event | None = None

    @property
    def keeps_one(self) -> bool:
        """Whether `keep_ready` is running."""
        return self._over is not None

    async def start(self, arguments: Sequence[str], cwd: Path) -> EngineChild:
        """Start an engine with these arguments, or use the one that is ready. Raises OSError."""
        self.release()
        ready = self._ready
        if ready is None or not ready.running or cwd != self._cwd:
            return await EngineChild.start(self._command(*arguments), cwd)
        self._ready = None  # before `keep_ready` ends it
        ready.give_arguments(arguments)
        return ready

    async def keep_ready(self, cwd: Path) -> None:
        """Start an engine, and keep it until it is used, `release` is called, or `KEEP_READY_S` have passed.

        Does nothing if one is kept already.
        """
        if self.keeps_one:
            return
        self._over = over = asyncio.Event()
        self._cwd = cwd
        try:
            self._ready = await EngineChild.start(self._command("--standby"), cwd, standby=True)
            await asyncio.wait_for(over.wait(), KEEP_READY_S)
        except (OSError, TimeoutError):
            pass  # the next check reports what is wrong
        finally:
            unused, self._ready, self._over = self._ready, None, None
            if unused is not None:
                await unused.stop()

    def release(self) -> None:
        """End `keep_ready`, and with it the engine that was not used."""
        if self._over is not None:
            self._over.set()


@dataclass(frozen=True, slots=True)
class CheckEnded:
    """The check's process has exited. `fault` says what broke, if anything; `evidence` is the tail of its output."""

    exercise: str
    cancelled: bool = False
    fault: str = ""
    evidence: tuple[str, ...] = ()


class CheckProcess:
    """A running check, by the engine that `start` starts. `tell` is called with every event."""

    def __init__(
        self, exercise: str, start: Callable[[], Coroutine[None, None, EngineChild]], tell: Callable[[Event], object]
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

    async def run(self) -> CheckEnded:
        """Run the check. None of its processes is left when this returns or is cancelled."""
        try:
            return await self._run()
        except OSError as error:
            return CheckEnded(self.exercise, fault=f"the check could not be started: {error.strerror or error}")
        except Exception as error:  # top level of the worker: a bug of ours must not crash the app
            return CheckEnded(self.exercise, fault=f"the check crashed: {type(error).__name__}: {error}")
        finally:
            if self._child is not None:
                await self._child.stop()

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
