"""The action that starts a process."""

from __future__ import annotations

import asyncio
import contextlib
import os
import traceback
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from tutor.bundled_ros.launching.launch import events, subprocesses
from tutor.bundled_ros.launching.launch.base import (
    LaunchContext,
    LaunchDescriptionEntity,
    SomeEntitiesType,
    SomeSubstitutionsType,
)
from tutor.bundled_ros.launching.launch.ending import Escalation, OnTargeted, signal_of
from tutor.bundled_ros.launching.launch.entities import Action, evaluate_condition_expression
from tutor.bundled_ros.launching.launch.executable import Executable
from tutor.bundled_ros.launching.launch.handlers import OnActionEventBase, OnShutdown
from tutor.bundled_ros.launching.launch.logs import get_logger, get_output_loggers
from tutor.bundled_ros.launching.launch.lookup import LaunchConfiguration
from tutor.bundled_ros.launching.launch.subprocesses import Lines
from tutor.bundled_ros.launching.launch.values import (
    normalize_to_list_of_substitutions,
    normalize_typed_substitution,
    perform_substitutions,
    perform_typed_substitution,
)

Output = SomeSubstitutionsType | Mapping[str, Any]
OnExit = SomeEntitiesType | Callable[[events.ProcessExited, LaunchContext], SomeEntitiesType | None] | None


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
        on_exit: OnExit = None,
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
        self._process: subprocesses.Process | None = None
        self._last_returncode: int | None = None
        self._completed: asyncio.Future[None] | None = None
        self._end_requested: asyncio.Future[None] | None = None
        self._escalation: Escalation | None = None
        self._task: asyncio.Task[None] | None = None

    @property
    def process_description(self) -> Executable:
        return self._description

    @property
    def shell(self) -> bool:
        return self._shell

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
            OnTargeted(events.ShutdownProcess, self, lambda _, context: self._terminate(context, send_sigint=True)),
            OnTargeted(events.SignalProcess, self, lambda event, _: self._send_signal(event)),
            self._handler(events.ProcessIO, self._on_output),
            OnShutdown(on_shutdown=self._on_shutdown),
            self._handler(events.ProcessExited, self._on_exit),
            self._handler(events.ProcessExited, self._flush),
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
            process = await subprocesses.start(
                details["cmd"],
                cwd=details["cwd"],
                env=details["env"],
                shell=self._shell,
                emulate_tty=self._emulates_tty(context),
                on_start=lambda process: self._on_start(context, process),
                on_stdout=lambda data: context.emit_event_sync(events.ProcessStdout(text=data, **details)),
                on_stderr=lambda data: context.emit_event_sync(events.ProcessStderr(text=data, **details)),
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
        await context.emit_event(events.ProcessExited(returncode=returncode, **details))
        return True

    def _on_start(self, context: LaunchContext, process: subprocesses.Process) -> None:
        assert self._details is not None
        self._process = process
        self._starting = False
        context._processes.add(process)
        self._logger.info(f"process started with pid [{process.pid}]")
        self._details["pid"] = process.pid
        context._queue(events.ProcessStarted(**self._details), "emitting event")

    def _emulates_tty(self, context: LaunchContext) -> bool:
        configured = context.launch_configurations.get("emulate_tty")
        if configured is None:
            return self._emulate_tty
        return evaluate_condition_expression(context, normalize_to_list_of_substitutions(configured))

    # --- event handlers

    def _handler(self, event_cls: type[events.RunningProcessEvent], on_event: Any, **kwargs: Any) -> OnActionEventBase:
        """Return a handler of this class of events of this action's own process."""
        return OnActionEventBase(
            action_matcher=self,
            on_event=on_event,
            target_event_cls=event_cls,
            target_action_cls=ExecuteLocal,
            **kwargs,
        )

    def _on_output(self, event: events.ProcessIO, context: LaunchContext) -> None:
        lines = self._stdout if event.from_stdout else self._stderr
        lines.feed(event.text, keep=self._cached_output)

    def _flush(self, event: events.ProcessExited, context: LaunchContext) -> None:
        self._stdout.flush()
        self._stderr.flush()

    def _on_shutdown(self, event: events.Shutdown, context: LaunchContext) -> SomeEntitiesType | None:
        # After Ctrl+C, the terminal has already sent SIGINT to the process.
        return self._terminate(context, send_sigint=not event.due_to_sigint or context.noninteractive)

    def _terminate(self, context: LaunchContext, *, send_sigint: bool) -> SomeEntitiesType | None:
        """Terminate the process: SIGINT, then SIGTERM, then SIGKILL."""
        if self._end_requested is None or self._end_requested.done():
            return None
        if self._starting:
            # It is not running yet, so it did not get the terminal's SIGINT.
            on_start = self._handler(
                events.ProcessStarted, lambda _, context: self._terminate(context, send_sigint=True), handle_once=True
            )
            context.register_event_handler(on_start)
            return None
        self._end_requested.set_result(None)
        if self._process is None:
            return None
        self._escalation = Escalation(self, self._logger.name, self._sigterm_timeout, self._sigkill_timeout)
        return self._escalation.actions(send_sigint=send_sigint)

    def _send_signal(self, event: events.SignalProcess) -> None:
        if self._details is None:
            raise RuntimeError("Signal event received before execution.")
        if self._process is None:
            return  # not running: ended or not started yet
        self._logger.info(f"sending signal '{event.signal_name}' to process[{self._details['name']}]")
        with contextlib.suppress(ProcessLookupError):  # it has just ended, which is fine
            self._process.send(signal_of(event))


def _normalize_timeout(name: str, given: SomeSubstitutionsType | None) -> Any:
    return normalize_to_list_of_substitutions(LaunchConfiguration(name, default=5) if given is None else given)
