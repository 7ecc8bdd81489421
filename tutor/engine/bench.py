"""The bench on real processes and real DDS: each run gets a private domain, observed from the first moment."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, asynccontextmanager, closing, contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeVar

from tutor.bundled_ros.ros2 import overlay, sourced
from tutor.bundled_ros.ros2.starting import ros2_command
from tutor.engine.environment import node_env, package_root, source_workspace
from tutor.engine.interfaces import root_of, seen_builds
from tutor.engine.isolation import restrict_environment
from tutor.engine.machine import Machine
from tutor.engine.progress import ScenarioProgress
from tutor.engine.run import RosRun
from tutor.engine.waits import CollectedFacts
from tutor.errors import CommandError, EngineError, NoFreeDomain, ProcessError
from tutor.interfaces import Build
from tutor.judge.bench import Run, Scenario
from tutor.judge.interface_build import InterfaceBuild
from tutor.judge.peers import Offer
from tutor.judge.submission import Submission
from tutor.judge.verdict import MAX_CHARACTERS
from tutor.process import LearnerProcess, run_limits
from tutor.process.log_folder import temporary_log_folder
from tutor.ros import workspace_interfaces
from tutor.ros.domain import reserve_domain
from tutor.ros.observer import Observer
from tutor.ros.talker import Talker
from tutor.workspace.regular import read_regular

T = TypeVar("T")

_MakeArgv = Callable[[dict[str, str], Path], list[str]]

NODE_UP_LIMIT_S = 1.5
"""A process without a node after this time, plus any wait for a CPU, no longer holds up other starts."""

MAX_TEXT_BYTES = 100_000
"""A file of data that is larger is not read."""

LAUNCH_OVERHEAD_S = 3.0
"""How much longer a launch takes than a node, since it starts and ends three processes."""

_KILLED_HINT = (
    "see what else runs on this machine, and whether your program itself uses a lot of memory or kills processes; then "
    "check again"
)


@dataclass(frozen=True, slots=True)
class RosBench:
    """The `Bench` of `tutor.judge.bench` for one scenario.

    `get_facts` returns the facts of another scenario; `on_facts` gets what this one reports before it ends.
    `expected_s`: the check's; of several waiting starts, the one with the longest goes first (a start may give its
    own). `interfaces`: what became of the submission's interface packages. `sigkilled`: the files whose process was
    ended by SIGKILL.
    """

    machine: Machine
    submission: Submission
    get_facts: Callable[[Scenario[Any]], Any]
    on_facts: Callable[[object], None]
    progress: ScenarioProgress
    expected_s: float = 0.0
    interfaces: Sequence[Build] = ()
    sigkilled: list[Path] = field(default_factory=list)

    @asynccontextmanager
    async def start(
        self,
        file: str,
        *,
        parameters: Mapping[str, Any] | None = None,
        watch: Mapping[str, str] | None = None,
        log_level: str = "",
        offers: Sequence[Offer] = (),
        expected_s: float | None = None,
    ) -> AsyncIterator[Run]:
        path = self.submission.files[file].resolve()
        argv = [str(self.machine.ros.python), str(path), *ros_arguments(parameters or {}, log_level)]

        def make_argv(env: dict[str, str], folder: Path) -> list[str]:
            return argv

        expected_s = self.expected_s if expected_s is None else expected_s
        async with self._start(
            path, make_argv, parameters or {}, watch or {}, offers=offers, expected_s=expected_s
        ) as run:
            yield run

    @asynccontextmanager
    async def launch(self, file: str, *, arguments: Mapping[str, str] | None = None) -> AsyncIterator[Run]:
        path = self.submission.files[file].resolve()
        given = [f"{name}:={value}" for name, value in (arguments or {}).items()]

        def make_argv(env: dict[str, str], folder: Path) -> list[str]:
            if self.machine.ros.kind == "system":  # our own launch does this by itself
                overlay.make_overlay(folder / "overlay", path, env, python=str(self.machine.ros.python))
            return [*ros2_command(self.machine.ros, env), "launch", str(path), *given]

        async with self._start(
            path, make_argv, {}, {}, terminal=True, nodes=2, expected_s=self.expected_s + LAUNCH_OVERHEAD_S
        ) as run:
            yield run

    @asynccontextmanager
    async def _start(
        self,
        path: Path,
        make_argv: _MakeArgv,
        parameters: Mapping[str, Any],
        watch: Mapping[str, str],
        *,
        offers: Sequence[Offer] = (),
        terminal: bool = False,
        nodes: int = 1,
        expected_s: float,
    ) -> AsyncIterator[Run]:
        """Run a command as `_run` does once it has a start slot; free the slot once the run has this many nodes."""
        async with (
            self.machine.starts.slot(expected_s) as up,
            self._run(path, make_argv, parameters, watch, offers, terminal=terminal) as run,
            _report_when_up(run, nodes, up),
            self.progress.follow(run, watch),
        ):
            yield run

    @asynccontextmanager
    async def _run(
        self,
        path: Path,
        make_argv: _MakeArgv,
        parameters: Mapping[str, Any],
        watch: Mapping[str, str],
        offers: Sequence[Offer],
        *,
        terminal: bool,
    ) -> AsyncIterator[RosRun]:
        """Run a command on a private domain; `make_argv` builds it from its environment and a folder for files."""
        facts, machine = CollectedFacts(), self.machine
        sandbox = machine.sandbox_of(path)
        with (
            _as_engine_errors(),
            reserve_domain() as domain_id,
            sandbox.folders() if sandbox else _folders() as (log_dir, ours),
            ExitStack() as talking,
        ):
            observer = Observer(domain_id, facts.notify)
            try:
                observer.watch_logs()
                for topic, type_name in watch.items():
                    observer.watch(topic, type_name)
                talkers = {offer.topic: _talk(talking, domain_id, offer) for offer in offers}
                env = node_env(machine.ros, domain_id, log_dir, package_root(path))
                if sandbox is None:  # else it would see the folders of its workspace
                    source_workspace(env, machine.ros, path, machine.tools)
                elif machine.tools is not None:
                    sourced.add_programs(env, machine.tools)
                env.pop(workspace_interfaces.REASONS, None)  # the report says it
                workspace_interfaces.add_prefixes(env, [build.prefix for build in self.interfaces if build.prefix])
                argv = make_argv(env, ours)
                if sandbox is not None:
                    restrict_environment(env)
                # A program may have deleted its own folder: its next start then reports that.
                cwd = path.parent if path.parent.is_dir() else log_dir
                unbuilt = {build.package: build.problems[0] for build in self.interface_builds() if build.problems}
                async with await LearnerProcess.start(
                    argv,
                    env=env,
                    cwd=cwd,
                    terminal=terminal,
                    spawner=sandbox.spawner if sandbox else machine.spawner,
                    on_change=facts.notify,
                ) as process:
                    with _raise_if_killed(process), _limited(process):
                        yield RosRun(path, parameters, domain_id, process, observer, facts, unbuilt, talkers)
                    if process.killed:
                        self.sigkilled.append(path)
            finally:
                observer.close()

    def interface_builds(self) -> Sequence[InterfaceBuild]:
        return seen_builds(self.interfaces, root_of(next(iter(self.submission.files.values()))))

    def has_file(self, file: str) -> bool:
        return file in self.submission.files

    def read(self, file: str) -> str:
        try:
            content = read_regular(self.submission.files[file], MAX_TEXT_BYTES)
        except (KeyError, OSError):
            return ""
        return (content or b"").decode("utf-8", "replace")

    async def facts(self, scenario: Scenario[T]) -> T:
        found: T = await self.get_facts(scenario)
        return found

    def report_progress(self, fraction: float, text: str) -> None:
        self.progress.report(min(1.0, max(0.0, fraction)), text[:MAX_CHARACTERS])

    def report_facts(self, facts: object) -> None:
        self.on_facts(facts)


@contextmanager
def _folders() -> Iterator[tuple[Path, Path]]:
    """Create the log folder of a run that is not isolated, which is also for files of ours."""
    with temporary_log_folder() as log_dir:
        yield log_dir, log_dir


def _talk(talking: ExitStack, domain_id: int, offer: Offer) -> Talker:
    """Create a publisher, which leaves the graph with `talking`, and publish what it has published before a start."""
    talker = talking.enter_context(closing(Talker(domain_id, offer.topic, offer.type, offer.qos, offer.depth)))
    for message in offer.messages:
        talker.publish(message)
    return talker


@asynccontextmanager
async def _report_when_up(run: Run, nodes: int, up: Callable[[], None]) -> AsyncIterator[None]:
    """Call `up` once the run has this many nodes or has ended, or after `NODE_UP_LIMIT_S`."""

    async def watch() -> None:
        with suppress(EngineError):  # the next use of the run raises it again
            await run.until(lambda: len(run.graph.nodes) >= nodes or run.exit is not None, NODE_UP_LIMIT_S)
        up()

    watching = asyncio.ensure_future(watch())
    try:
        yield
    finally:
        watching.cancel()
        await asyncio.gather(watching, return_exceptions=True)


@contextmanager
def _limited(process: LearnerProcess) -> Iterator[None]:
    """End the process within the block if it takes too much of the machine."""
    enforcing = asyncio.ensure_future(run_limits.enforce(process))
    try:
        yield
    finally:
        enforcing.cancel()


@contextmanager
def _raise_if_killed(process: LearnerProcess) -> Iterator[None]:
    """Raise EngineError if the machine or another process ended this one, whatever the block did or raised."""
    try:
        yield
    except Exception:
        if not process.fault:
            raise
    if process.fault:
        raise EngineError(process.fault, _KILLED_HINT)


@contextmanager
def _as_engine_errors() -> Iterator[None]:
    """Turn what the machine refuses us into an EngineError."""
    try:
        yield
    except NoFreeDomain as error:
        raise EngineError(str(error), error.hint) from error
    except (ProcessError, CommandError) as error:
        raise EngineError(str(error)) from error


def ros_arguments(parameters: Mapping[str, Any], log_level: str = "") -> list[str]:
    """Return the command-line arguments that set these parameters and this log level, as a user would type them."""
    if not parameters and not log_level:
        return []
    arguments = ["--ros-args"]
    for name, value in parameters.items():
        text = str(value).lower() if isinstance(value, bool) else str(value)
        arguments += ["-p", f"{name}:={text}"]
    if log_level:
        arguments += ["--log-level", log_level]
    return arguments
