"""The bench on real processes and real DDS: each start has a domain of its own, watched from the first moment."""

from __future__ import annotations

import asyncio
import os
from collections.abc import AsyncIterator, Callable, Iterator, Mapping
from contextlib import AbstractAsyncContextManager, asynccontextmanager, contextmanager, nullcontext, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeVar

from tutor.bundled_ros.ros2 import overlay
from tutor.bundled_ros.ros2.starting import ros2_command
from tutor.engine.isolation import Isolation
from tutor.engine.run import CollectedFacts, RosRun
from tutor.engine.start_limiter import StartLimiter
from tutor.errors import CommandError, EngineError, NoFreeDomain, ProcessError
from tutor.judge.bench import Run, Scenario
from tutor.judge.exceptions import KnownException
from tutor.judge.submission import Submission
from tutor.judge.verdict import MOST_CHARACTERS
from tutor.process import LearnerProcess
from tutor.process.log_folder import temporary_log_folder
from tutor.ros.domain import reserve_domain
from tutor.ros.environment import RosEnvironment, learner_env
from tutor.ros.observer import Observer

T = TypeVar("T")

_MakeArgv = Callable[[dict[str, str], Path], list[str]]

UP_S = 1.5
"""A process that has no node after this long (and what the machine kept it from running) need not be waited for."""

LAUNCH_S = 3.0
"""A launch starts and ends three processes, so it has this much longer a way to go than one node."""

_WHO_KILLS = (
    "see what else runs on this machine, and whether your program itself takes much memory or kills processes; then "
    "check again"
)


@dataclass(frozen=True, slots=True)
class RosBench:
    """The `Bench` of `tutor.judge.bench` for one scenario.

    `expected_s`: how many seconds of the clock its check asks for; where several are to start, the longest goes first
    (a start may say how many it asks for itself). `exceptions`: the check's own known ones. `sigkilled`: the
    files whose process was ended by SIGKILL. `follow`: what looks on while a start runs, given its watched topics.
    `take_facts`: gets what the scenario reports before it ends.
    """

    submission: Submission
    ros: RosEnvironment
    share: Callable[[Scenario[Any]], Any]
    tell: Callable[[float, str], None]
    start_limiter: StartLimiter = field(default_factory=StartLimiter)
    expected_s: float = 0.0
    exceptions: tuple[KnownException, ...] = ()
    isolation: Isolation | None = None
    follow: Callable[[RosRun, Mapping[str, str]], AbstractAsyncContextManager[None]] = lambda run, watched: (
        nullcontext()
    )
    take_facts: Callable[[object], None] = lambda facts: None
    sigkilled: list[Path] = field(default_factory=list)

    @asynccontextmanager
    async def start(
        self,
        file: str,
        *,
        parameters: Mapping[str, Any] | None = None,
        watch: Mapping[str, str] | None = None,
        expected_s: float | None = None,
    ) -> AsyncIterator[Run]:
        path = self.submission.files[file].resolve()
        program = [str(self.ros.python), str(path), *ros_arguments(parameters or {})]

        def command(env: dict[str, str], log_dir: Path) -> list[str]:
            return program

        given = (parameters or {}, watch or {})
        async with self._start(
            path, command, *given, expected_s=self.expected_s if expected_s is None else expected_s
        ) as run:
            yield run

    @asynccontextmanager
    async def launch(self, file: str, *, arguments: Mapping[str, str] | None = None) -> AsyncIterator[Run]:
        path = self.submission.files[file].resolve()
        given = [f"{name}:={value}" for name, value in (arguments or {}).items()]

        def command(env: dict[str, str], log_dir: Path) -> list[str]:
            if self.ros.kind == "system":  # ours does this by itself
                overlay.make_overlay(log_dir / "overlay", path, env, python=str(self.ros.python))
            return [*ros2_command(self.ros, env), "launch", str(path), *given]

        async with self._start(
            path, command, {}, {}, terminal=True, nodes=2, expected_s=self.expected_s + LAUNCH_S
        ) as run:
            yield run

    @asynccontextmanager
    async def _start(
        self,
        path: Path,
        command: _MakeArgv,
        parameters: Mapping[str, Any],
        watch: Mapping[str, str],
        *,
        terminal: bool = False,
        nodes: int = 1,
        expected_s: float,
    ) -> AsyncIterator[Run]:
        """Run a command as `_run` does, when it is its turn: others may start when it has this many nodes."""
        async with (
            self.start_limiter.slot(expected_s) as up,
            self._run(path, command, parameters, watch, terminal=terminal) as run,
            _report_when_up(run, nodes, up),
            self.follow(run, watch),
        ):
            yield run

    @asynccontextmanager
    async def _run(
        self,
        path: Path,
        command: _MakeArgv,
        parameters: Mapping[str, Any],
        watch: Mapping[str, str],
        *,
        terminal: bool,
    ) -> AsyncIterator[RosRun]:
        """Run a command, made from its environment and a folder for its logs, on a domain of its own."""
        facts = CollectedFacts()
        with (
            _as_engine_errors(),
            reserve_domain() as domain_id,
            temporary_log_folder() as log_dir,
        ):
            observer = Observer(domain_id, facts.change)
            try:
                observer.watch_logs()
                for topic, type_name in watch.items():
                    observer.watch(topic, type_name)
                env = learner_env(
                    self.ros,
                    domain_id=domain_id,
                    log_dir=log_dir,
                    package_root=package_root(path),
                    isolated=True,
                    environ=os.environ,
                )
                env["TMPDIR"] = str(log_dir)  # what is left there goes with the run
                env["PYTHONFAULTHANDLER"] = "1"  # see RosRun.dump_stacks
                argv = command(env, log_dir)
                wrapper = self.isolation.wrap(package_folder(path), log_dir, env) if self.isolation else ()
                # A program may have removed its own folder: then the next start of it says so.
                cwd = path.parent if path.parent.is_dir() else log_dir
                async with await LearnerProcess.start(
                    argv, env=env, cwd=cwd, terminal=terminal, wrapper=wrapper, on_change=facts.change
                ) as process:
                    with _unless_ended_by_others(process):
                        yield RosRun(path, parameters, domain_id, process, observer, facts, self.exceptions)
                    if process.killed:
                        self.sigkilled.append(path)
            finally:
                observer.close()

    def has_file(self, file: str) -> bool:
        return file in self.submission.files

    async def facts(self, scenario: Scenario[T]) -> T:
        found: T = await self.share(scenario)
        return found

    def report_progress(self, fraction: float, text: str) -> None:
        self.tell(min(1.0, max(0.0, fraction)), text[:MOST_CHARACTERS])

    def report_facts(self, facts: object) -> None:
        self.take_facts(facts)


@asynccontextmanager
async def _report_when_up(run: Run, nodes: int, up: Callable[[], None]) -> AsyncIterator[None]:
    """Call `up` as soon as there are this many nodes, the process has ended, or it is not going to make them."""

    async def watch() -> None:
        with suppress(EngineError):  # the next use of the run raises it
            await run.until(lambda: len(run.graph.nodes) >= nodes or run.exit is not None, UP_S)
        up()

    watching = asyncio.ensure_future(watch())
    try:
        yield
    finally:
        watching.cancel()
        await asyncio.gather(watching, return_exceptions=True)


@contextmanager
def _unless_ended_by_others(process: LearnerProcess) -> Iterator[None]:
    """Whatever was seen of a process that the machine or others have ended: an EngineError says so."""
    try:
        yield
    except Exception:
        if not process.fault:
            raise
    if process.fault:
        raise EngineError(process.fault, _WHO_KILLS)


@contextmanager
def _as_engine_errors() -> Iterator[None]:
    """What the machine refuses us, as an EngineError."""
    try:
        yield
    except NoFreeDomain as error:
        raise EngineError(str(error), error.hint) from error
    except (ProcessError, CommandError) as error:
        raise EngineError(str(error)) from error


def ros_arguments(parameters: Mapping[str, Any]) -> list[str]:
    """The command-line arguments that set these parameters, as a user would type them."""
    if not parameters:
        return []
    arguments = ["--ros-args"]
    for name, value in parameters.items():
        written = str(value).lower() if isinstance(value, bool) else str(value)
        arguments += ["-p", f"{name}:={written}"]
    return arguments


def package_folder(path: Path) -> Path:
    """The folder of all that belongs to the file: its package's, where it is in one, else the one that it is in."""
    near = [path.parent, *path.parents[1:3]]
    return next((folder for folder in near if (folder / "package.xml").is_file()), package_root(path) or path.parent)


def package_root(path: Path) -> Path | None:
    """The folder from which the file's own package can be imported, where the file is a module of one."""
    return path.parent.parent if (path.parent / "__init__.py").is_file() else None
