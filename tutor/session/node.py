"""Runs the learner's node in the learner's own ROS domain, so that it is visible from other terminals."""

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
from tutor.session.node_command import NodeCommand

MIN_UPDATE_INTERVAL_S = 0.1
"""Minimum time between two updates of the log, however fast the node writes."""

INTERRUPT_S = 5.0
"""How long a node may take to exit after Ctrl+C before it is killed, in seconds."""


class Phase(Enum):
    """The phase of a node's life cycle."""

    STARTING = "starting"
    RUNNING = "running"
    STOPPING = "stopping"
    ENDED = "ended"


@dataclass(frozen=True, slots=True)
class NodeState:
    """A snapshot of a node for display. `note` says how it ended or why it did not start; `command` is as typed.

    `dropped` counts the lines dropped from the middle of the output. Times are in seconds since the epoch.
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
        """Whether the process is running or about to start."""
        return self.phase is not Phase.ENDED


class Node:
    """One run of a node. `show` is called with each new state.

    While the node writes, it is called at most once per `MIN_UPDATE_INTERVAL_S`.
    """

    def __init__(self, command: NodeCommand, show: Callable[[NodeState], object]) -> None:
        self._command = command
        self._show = show
        self._changed = asyncio.Event()
        self._stop = asyncio.Event()
        self.over = asyncio.Event()
        """Set once none of the node's processes is left."""
        self.pid: int | None = None
        """The process id, once the process has started."""
        self.state = NodeState(command.file, Phase.STARTING, time.time(), command=command.typed)

    async def run(self) -> None:
        """Start the node and return once it has exited; if this is cancelled, the node is killed."""
        try:
            await self._run()
        finally:
            self.over.set()

    async def _run(self) -> None:
        self._publish_state(self.state)
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
            self._publish_state(
                replace(self.state, phase=Phase.ENDED, note=str(error), failed=True, ended_at=time.time())
            )
            return
        async with process:
            self.pid = process.pid
            self._publish_state(replace(self.state, phase=Phase.RUNNING, since=process.started_at))
            tasks = [asyncio.create_task(self._stop_on_request(process))]
            if (logs := command.env.get("ROS_LOG_DIR")) and private_folders.contains(Path(logs)):
                tasks.append(asyncio.create_task(log_folder.keep_small_until_cancelled(Path(logs))))
            try:
                await self._follow(process)
            finally:
                for task in tasks:
                    task.cancel()
        self._publish_state(replace(self._with_output(process, phase=Phase.ENDED), ended_at=time.time()))

    def stop(self) -> None:
        """Press Ctrl+C, and kill the node if it does not exit in time."""
        self._stop.set()

    async def _follow(self, process: LearnerProcess) -> None:
        while process.exit is None:
            await self._changed.wait()
            self._changed.clear()
            self._publish_state(self._with_output(process))
            await process.wait(MIN_UPDATE_INTERVAL_S)  # batches a flood of output; returns at once on exit
        note, failed = _describe_exit(process.exit, self.state) if not process.fault else (process.fault, True)
        self._publish_state(replace(self._with_output(process), note=note, failed=failed))

    async def _stop_on_request(self, process: LearnerProcess) -> None:
        await self._stop.wait()
        self._publish_state(replace(self.state, phase=Phase.STOPPING))
        process.interrupt()
        if await process.wait(INTERRUPT_S) is None:
            self._publish_state(
                replace(self.state, note=f"ignored Ctrl+C for {INTERRUPT_S:.0f} s: ended by force", failed=True)
            )
            await process.end()

    def _with_output(self, process: LearnerProcess, phase: Phase | None = None) -> NodeState:
        lines, dropped = tuple(process.output), process.dropped_lines
        return replace(self.state, phase=phase or self.state.phase, lines=lines, dropped=dropped)

    def _publish_state(self, state: NodeState) -> None:
        self.state = state
        self._show(state)


def _describe_exit(exit: Exit, state: NodeState) -> tuple[str, bool]:
    """Return how the node exited, in words, and whether that counts as a failure."""
    if state.note:
        return state.note, True
    requested = state.phase is Phase.STOPPING
    clean = exit.code in (0, 130) or exit.signal == 2
    if requested and clean:
        return "stopped", False
    return (f"stopped with {exit}" if requested else f"ended by itself with {exit}"), not clean
