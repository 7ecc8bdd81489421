"""Actions that start processes."""

from __future__ import annotations

import asyncio
import contextlib
import os
import traceback
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

from .. import _subprocess
from .._entities import Action, LaunchDescriptionEntity, SomeEntitiesType, SomeSubstitutionsType
from .._subprocess import Lines
from ..conditions import evaluate_condition_expression
from ..descriptions import Environment, Executable
from ..event_handlers import OnProcessExit, OnProcessIO, OnProcessStart, OnShutdown
from ..events import (
    ProcessExited,
    ProcessIO,
    ProcessStarted,
    ProcessStderr,
    ProcessStdout,
    ShutdownProcess,
    SignalProcess,
)
from ..events import (
    Shutdown as ShutdownEvent,
)
from ..launch_context import LaunchContext
from ..logging import get_logger, get_output_loggers
from ..substitutions._lookup import LaunchConfiguration
from ..utilities import (
    normalize_to_list_of_substitutions,
    normalize_typed_substitution,
    perform_substitutions,
    perform_typed_substitution,
)
from . import _ending

Output = SomeSubstitutionsType | Mapping[str, Any]


class ExecuteLocal(Action):
    """Starts a process, shows its output, reports its end, and terminates it when the launch shuts down.

    Timeouts and delays are in seconds. `output` says where stdout and stderr go: "log" (the default: both to the log
    file, stderr to the screen as well), "screen", "both", "own_log" or "full", or a dict with one setting per stream.
    """

    def __init__(
        self,
        *,
        process_description: Executable,
        shell: bool = False,
        sigterm_timeout: SomeSubstitutionsType | None = None,
        sigkill_timeout: SomeSubstitutionsType | None = None,
        emulate_tty: bool = False,
        output: Output = "log",
        output_format: str = "[{this.process_description.final_name}] {line}",
        cached_output: bool = False,
        log_cmd: bool = False,
        on_exit: SomeEntitiesType | Callable[[ProcessExited, LaunchContext], SomeEntitiesType | None] | None = None,
        respawn: bool | SomeSubstitutionsType = False,
        respawn_delay: float | None = None,
        respawn_max_retries: int = -1,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self._description = process_description
        self._shell = shell
        self._sigterm_timeout = _normalize_timeout("sigterm_timeout", sigterm_timeout)
        self._sigkill_timeout = _normalize_timeout("sigkill_timeout", sigkill_timeout)
        self._emulate_tty = emulate_tty
        output = os.environ.get("OVERRIDE_LAUNCH_PROCESS_OUTPUT", output)
        self._output = output if isinstance(output, Mapping) else normalize_to_list_of_substitutions(output)
        self._output_format = output_format
        self._cached_output = cached_output
        self._log_cmd = log_cmd
        self._on_exit = on_exit
        self._respawn = normalize_typed_substitution(respawn, bool)
        self._respawn_delay = respawn_delay
        self._respawn_max_retries = respawn_max_retries
        self._respawns = 0
        self._executed = False
        self._starting = False
        self._details: dict[str, Any] | None = None
        self._process: _subprocess.Process | None = None
        self._last_returncode: int | None = None
        self._completed: asyncio.Future[None] | None = None
        self._end_requested: asyncio.Future[None] | None = None
        self._escalation: _ending.Escalation | None = None
        self._task: asyncio.Task[None] | None = None

    @property
    def process_description(self) -> Executable:
        return self._description

    @property
    def shell(self) -> bool:
        return self._shell

    @property
    def emulate_tty(self) -> bool:
        return self._emulate_tty

    @property
    def output(self) -> Any:
        return self._output

    @property
    def sigterm_timeout(self) -> Any:
        return self._sigterm_timeout

    @property
    def sigkill_timeout(self) -> Any:
        return self._sigkill_timeout

    @property
    def process_details(self) -> dict[str, Any] | None:
        """The action, name, cmd, cwd and env, and the pid once it runs; None before the action is executed."""
        return self._details

    @property
    def return_code(self) -> int | None:
        """The return code of the process once it has ended (-N: killed by signal N)."""
        return self._last_returncode

    def get_stdout(self) -> str:
        """Return everything the process has printed to stdout. Raises RuntimeError without `cached_output`."""
        return self._cached(self._stdout)

    def get_stderr(self) -> str:
        """Return everything the process has printed to stderr. Raises RuntimeError without `cached_output`."""
        return self._cached(self._stderr)

    def _cached(self, lines: Lines) -> str:
        if not self._cached_output:
            raise RuntimeError("the output of a process is kept only with cached_output=True")
        return lines.text

    def get_sub_entities(self) -> Sequence[LaunchDescriptionEntity]:
        return self._on_exit if isinstance(self._on_exit, list) else []

    def get_asyncio_future(self) -> asyncio.Future[None] | None:
        return self._completed

    def prepare(self, context: LaunchContext) -> None:
        """Expand the description into the command, the environment and the rest of what is started."""
        description = self._description
        description.prepare(context, self)
        self._details = {
            "action": self,
            "name": description.final_name,
            "cmd": description.final_cmd,
            "cwd": description.final_cwd,
            "env": description.final_env,
        }
        self._respawn = perform_typed_substitution(context, self._respawn, bool)

    def execute(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity] | None:
        self.prepare(context)
        name = str(self._description.final_name)
        if self._executed:
            raise RuntimeError(f"ExecuteLocal action '{name}': executed more than once: {self.describe()}")
        self._executed = True
        if context.is_shutdown:
            return None  # start nothing during the shutdown
        output = self._output if isinstance(self._output, Mapping) else perform_substitutions(context, self._output)
        to_stdout, to_stderr = get_output_loggers(name, output)
        self._logger = get_logger(name)
        self._stdout = Lines(lambda line: to_stdout.info(self._output_format.format(line=line, this=self)))
        self._stderr = Lines(lambda line: to_stderr.info(self._output_format.format(line=line, this=self)))
        for handler in (
            _ending.OnTargeted(ShutdownProcess, self, lambda _, context: self._terminate(context, send_sigint=True)),
            _ending.OnTargeted(SignalProcess, self, lambda event, _: self._send_signal(event)),
            OnProcessIO(target_action=self, on_stdout=self._on_stdout, on_stderr=self._on_stderr),
            OnShutdown(on_shutdown=self._on_shutdown),
            OnProcessExit(target_action=self, on_exit=self._on_exit),
            OnProcessExit(target_action=self, on_exit=self._flush),
        ):
            context.register_event_handler(handler)
        self._completed = context.asyncio_loop.create_future()
        self._end_requested = context.asyncio_loop.create_future()
        # An error in an entity that is visited next must not make the launch forget this process.
        context.add_completion_future(self._completed)
        self._starting = True
        self._task = context.asyncio_loop.create_task(self._run(context, self._end_requested))
        context._start_cancellers.append(self._cancel_start)
        return None

    def _cancel_start(self) -> None:
        """Cancel the start, because another entity of the same visit failed."""
        self._starting = False
        if self._task is not None:
            self._task.cancel()
        if self._completed is not None and not self._completed.done():
            self._completed.set_result(None)

    # --- the life of the process

    async def _run(self, context: LaunchContext, end_requested: asyncio.Future[None]) -> None:
        try:
            while await self._run_once(context) and self._should_respawn(context, end_requested):
                self._respawns += 1
                if self._respawn_delay is not None and self._respawn_delay > 0.0:
                    await asyncio.wait([end_requested], timeout=self._respawn_delay)
                if end_requested.done():
                    break
                self._starting = True
        finally:
            if self._escalation is not None:
                self._escalation.cancel()
            if self._completed is not None and not self._completed.done():
                self._completed.set_result(None)

    def _should_respawn(self, context: LaunchContext, end_requested: asyncio.Future[None]) -> bool:
        if context.is_shutdown or end_requested.done() or not self._respawn:
            return False
        return self._respawn_max_retries < 0 or self._respawns < self._respawn_max_retries

    async def _run_once(self, context: LaunchContext) -> bool:
        """Start the process and wait for its end. Return False if it could not be started."""
        details = self._details
        assert details is not None
        shown = " ".join(word for word in details["cmd"] if word.strip())
        if self._log_cmd:
            self._logger.info(f"process details: cmd='{shown}', cwd='{details['cwd']}', custom_env?=True")
        try:
            process = await _subprocess.start(
                details["cmd"],
                cwd=details["cwd"],
                env=details["env"],
                shell=self._shell,
                emulate_tty=self._emulates_tty(context),
                on_start=lambda process: self._on_start(context, process),
                on_stdout=lambda data: context.emit_event_sync(ProcessStdout(text=data, **details)),
                on_stderr=lambda data: context.emit_event_sync(ProcessStderr(text=data, **details)),
            )
        except (OSError, ValueError) as error:
            self._starting = False
            reason = "".join(traceback.format_exception_only(error)).rstrip()
            self._logger.error(f"exception occurred while executing process:\n{reason}")
            return False
        returncode = self._last_returncode = await process.wait()
        self._process = None
        context._processes.discard(process)
        process.close()
        if returncode == 0:
            self._logger.info(f"process has finished cleanly [pid {process.pid}]")
        else:
            self._logger.error(f"process has died [pid {process.pid}, exit code {returncode}, cmd '{shown}'].")
        await context.emit_event(ProcessExited(returncode=returncode, **details))
        return True

    def _on_start(self, context: LaunchContext, process: _subprocess.Process) -> None:
        assert self._details is not None
        self._process = process
        self._starting = False
        context._processes.add(process)
        self._logger.info(f"process started with pid [{process.pid}]")
        self._details["pid"] = process.pid
        context._queue(ProcessStarted(**self._details), "emitting event")

    def _emulates_tty(self, context: LaunchContext) -> bool:
        configured = context.launch_configurations.get("emulate_tty")
        if configured is None:
            return self._emulate_tty
        return evaluate_condition_expression(context, normalize_to_list_of_substitutions(configured))

    # --- event handlers

    def _on_stdout(self, event: ProcessIO) -> None:
        self._stdout.feed(event.text, keep=self._cached_output)

    def _on_stderr(self, event: ProcessIO) -> None:
        self._stderr.feed(event.text, keep=self._cached_output)

    def _flush(self, event: ProcessExited, context: LaunchContext) -> None:
        self._stdout.flush()
        self._stderr.flush()

    def _on_shutdown(self, event: ShutdownEvent, context: LaunchContext) -> SomeEntitiesType | None:
        # After Ctrl+C, the terminal has already sent SIGINT to the process.
        return self._terminate(context, send_sigint=not event.due_to_sigint or context.noninteractive)

    def _terminate(self, context: LaunchContext, *, send_sigint: bool) -> SomeEntitiesType | None:
        """Terminate the process: SIGINT, then SIGTERM, then SIGKILL."""
        if self._end_requested is None or self._end_requested.done():
            return None
        if self._starting:
            # It is not running yet, so it did not get the terminal's SIGINT.
            context.register_event_handler(
                OnProcessStart(
                    target_action=lambda action: action is self,
                    on_start=lambda _, context: self._terminate(context, send_sigint=True),
                    handle_once=True,
                )
            )
            return None
        self._end_requested.set_result(None)
        if self._process is None:
            return None
        self._escalation = _ending.Escalation(self, self._logger, self._sigterm_timeout, self._sigkill_timeout)
        return self._escalation.actions(send_sigint=send_sigint)

    def _send_signal(self, event: SignalProcess) -> None:
        if self._details is None:
            raise RuntimeError("Signal event received before execution.")
        if self._process is None:
            return  # not running: ended or not started yet
        self._logger.info(f"sending signal '{event.signal_name}' to process[{self._details['name']}]")
        with contextlib.suppress(ProcessLookupError):  # it has just ended, which is fine
            self._process.send(_ending.signal_of(event))


def _normalize_timeout(name: str, given: SomeSubstitutionsType | None) -> Any:
    return normalize_to_list_of_substitutions(LaunchConfiguration(name, default=5) if given is None else given)


class ExecuteProcess(ExecuteLocal):
    """Starts a command: a list of words, each a text, a substitution or several of these, which are concatenated.

    `env` is the whole environment; `additional_env` is added to it, or to the launch's own environment. `name` is the
    name of the process in messages, where a number is appended.
    """

    def __init__(
        self,
        *,
        cmd: Iterable[SomeSubstitutionsType],
        prefix: SomeSubstitutionsType | None = None,
        name: SomeSubstitutionsType | None = None,
        cwd: SomeSubstitutionsType | None = None,
        env: Environment | None = None,
        additional_env: Environment | None = None,
        **kwargs: Any,
    ) -> None:
        executable = Executable(cmd=cmd, prefix=prefix, name=name, cwd=cwd, env=env, additional_env=additional_env)
        super().__init__(process_description=executable, **kwargs)

    @property
    def name(self) -> Any:
        """The numbered name once the action is executed; before that, the name as given."""
        return self._description.final_name or self._description.name

    @property
    def cmd(self) -> Any:
        """The expanded words once the action is executed; before that, the command as given."""
        return self._description.final_cmd or self._description.cmd

    @property
    def cwd(self) -> Any:
        return self._description.final_cwd or self._description.cwd

    @property
    def env(self) -> Any:
        return self._description.final_env or self._description.env

    @property
    def additional_env(self) -> Any:
        return self._description.additional_env
