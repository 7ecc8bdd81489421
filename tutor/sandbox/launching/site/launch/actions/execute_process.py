"""A command."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ..descriptions.executable import Environment, Executable
from ..some_substitutions_type import SomeSubstitutionsType
from .execute_local import ExecuteLocal


class ExecuteProcess(ExecuteLocal):
    """Starts a command: a list of words, each a text, a substitution or several of them joined.

    `env` is the whole environment, `additional_env` is added to it, or to that of the launch. `name` is what the
    process is called in messages; a number is added.
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
        """The name with its number, once it is executed; what was given, before."""
        return self._description.final_name or self._description.name

    @property
    def cmd(self) -> Any:
        """The words, once it is executed; what was given, before."""
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
