"""The action that starts a command, and the handlers of processes' events."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from tutor.bundled_ros.launching.launch.base import LaunchContext, SomeEntitiesType, SomeSubstitutionsType
from tutor.bundled_ros.launching.launch.events import ProcessExited, ProcessIO, ProcessStarted
from tutor.bundled_ros.launching.launch.executable import Environment, Executable
from tutor.bundled_ros.launching.launch.execute_local import ExecuteLocal
from tutor.bundled_ros.launching.launch.handlers import OnActionEventBase

Listener = Callable[[ProcessIO], SomeEntitiesType | None]


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


class OnProcessStart(OnActionEventBase):
    """The target action's process (None: any process) has started."""

    def __init__(
        self,
        *,
        target_action: Callable[[Any], bool] | ExecuteProcess | None = None,
        on_start: SomeEntitiesType | Callable[[ProcessStarted, LaunchContext], SomeEntitiesType | None] | None,
        **kwargs: Any,
    ) -> None:
        super().__init__(
            action_matcher=target_action,
            on_event=on_start,
            target_event_cls=ProcessStarted,
            target_action_cls=ExecuteProcess,
            **kwargs,
        )


class OnProcessIO(OnActionEventBase):
    """The target action's process (None: any process) has printed something."""

    def __init__(
        self,
        *,
        target_action: Callable[[Any], bool] | ExecuteLocal | None = None,
        on_stdin: Listener | None = None,
        on_stdout: Listener | None = None,
        on_stderr: Listener | None = None,
        **kwargs: Any,
    ) -> None:
        def pass_on(event: ProcessIO, context: LaunchContext) -> SomeEntitiesType | None:
            listener = on_stdout if event.from_stdout else on_stderr if event.from_stderr else on_stdin
            return listener(event) if listener is not None else None

        super().__init__(
            action_matcher=target_action,
            on_event=pass_on,
            target_event_cls=ProcessIO,
            target_action_cls=ExecuteLocal,
            **kwargs,
        )


class OnProcessExit(OnActionEventBase):
    """The target action's process (None: any process) has ended."""

    def __init__(
        self,
        *,
        target_action: Callable[[Any], bool] | ExecuteLocal | None = None,
        on_exit: SomeEntitiesType | Callable[[ProcessExited, LaunchContext], SomeEntitiesType | None] | None,
        **kwargs: Any,
    ) -> None:
        super().__init__(
            action_matcher=target_action,
            on_event=on_exit,
            target_event_cls=ProcessExited,
            target_action_cls=ExecuteLocal,
            **kwargs,
        )
