"""The learner's node, run in their own domain so that their other terminals see it."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import Enum
from pathlib import Path

from tutor import private_folders
from tutor.errors import ProcessError
from tutor.judge.trace import Exit, OutputLine
from tutor.process import LearnerProcess, log_folder

SHOW_EVERY_S = 0.1
"""The log is shown at this rate at most, however fast the node writes."""

INTERRUPT_S = 5.0
"""How long a node may take to end after Ctrl+C before it is ended, in seconds."""


@dataclass(frozen=True, slots=True)
class NodeCommand:
    """How to start one file as a node. `typed` is what a ROS user would type for it.

    `terminal`: whether it is to find a terminal at its standard input, as `ros2 launch` needs for Ctrl+C.
    """

    file: str
    argv: tuple[str, ...]
    env: dict[str, str]
    cwd: Path
    typed: str = ""
    terminal: bool = False


class Phase(Enum):
    """Where in its life a node is."""

    STARTING = "starting"
    RUNNING = "running"
    STOPPING = "stopping"
    ENDED = "ended"


@dataclass(frozen=True, slots=True)
class NodeState:
    """A node as it is to be shown. `note` says how it ended, or why it did not start; `command` is as it is typed.

    Times are seconds since the epoch.
    """

    file: str
    phase: Phase
    since: float
    note: str = ""
    failed: bool = False
    lines: tuple[OutputLine, ...] = ()
    dropped: int = 0
    command: str = ""
    ended_at: float = 0.0

    @property
    def alive(self) -> bool:
        """Whether there is a process, or soon will be."""
        return self.phase is not Phase.ENDED


class Node:
    """One run of a node. `show` is called with each new state, at most every `SHOW_EVERY_S` seconds while it writes."""

    def __init__(self, command: NodeCommand, show: Callable[[NodeState], object]) -> None:
        self._command = command
        self._show = show
        self._changed = asyncio.Event()
        self._stop = asyncio.Event()
        self.over = asyncio.Event()
        """Set when nothing of the node is left."""
        self.pid: int | None = None
        """Its process, once there is one."""
        self.state = NodeState(command.file, Phase.STARTING, time.time(), command=command.typed)

    async def run(self) -> None:
        """Start the node, follow it, and return when it has ended; it is ended for certain where this is cancelled."""
        try:
            await self._run()
        finally:
            self.over.set()

    async def _run(self) -> None:
        self._say(self.state)
        command = self._command
        try:
            process = await LearnerProcess.start(
                list(command.argv),
                env=command.env,
                cwd=command.cwd,
                terminal=command.terminal,
                on_change=self._changed.set,
            )
        except ProcessError as error:
            self._say(replace(self.state, phase=Phase.ENDED, note=str(error), failed=True, ended_at=time.time()))
            return
        async with process:
            self.pid = process.pid
            self._say(replace(self.state, phase=Phase.RUNNING, since=process.started_at))
            beside = [asyncio.create_task(self._stop_when_asked(process))]
            if (logs := command.env.get("ROS_LOG_DIR")) and private_folders.contains(Path(logs)):
                beside.append(asyncio.create_task(log_folder.limit(Path(logs))))
            try:
                await self._follow(process)
            finally:
                for task in beside:
                    task.cancel()
        self._say(replace(self._with_output(process, phase=Phase.ENDED), ended_at=time.time()))

    def stop(self) -> None:
        """Press Ctrl+C, and end the node where that does not."""
        self._stop.set()

    async def _follow(self, process: LearnerProcess) -> None:
        while process.exit is None:
            await self._changed.wait()
            self._changed.clear()
            self._say(self._with_output(process))
            await process.wait(SHOW_EVERY_S)  # a flood gathers meanwhile; an end is shown at once
        how, failed = _ending(process.exit, self.state) if not process.fault else (process.fault, True)
        self._say(replace(self._with_output(process), note=how, failed=failed))

    async def _stop_when_asked(self, process: LearnerProcess) -> None:
        await self._stop.wait()
        self._say(replace(self.state, phase=Phase.STOPPING))
        process.interrupt()
        if await process.wait(INTERRUPT_S) is None:
            self._say(replace(self.state, note=f"ignored Ctrl+C for {INTERRUPT_S:.0f} s: ended by force", failed=True))
            await process.end()

    def _with_output(self, process: LearnerProcess, phase: Phase | None = None) -> NodeState:
        lines, dropped = tuple(process.output), process.dropped_lines
        return replace(self.state, phase=phase or self.state.phase, lines=lines, dropped=dropped)

    def _say(self, state: NodeState) -> None:
        self.state = state
        self._show(state)


def _ending(exit: Exit, state: NodeState) -> tuple[str, bool]:
    """How it ended, in words, and whether that is anything to look into."""
    if state.note:
        return state.note, True
    asked = state.phase is Phase.STOPPING
    clean = exit.code in (0, 130) or exit.signal == 2
    if asked and clean:
        return "stopped", False
    return (f"stopped with {exit}" if asked else f"ended by itself with {exit}"), not clean
