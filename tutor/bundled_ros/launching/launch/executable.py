"""The description of a process: its command, working directory, environment and name."""

from __future__ import annotations

import itertools
import os.path
import re
import shlex
from collections.abc import Iterable, Mapping
from typing import Protocol, runtime_checkable

from tutor.bundled_ros.launching.launch.base import LaunchContext, SomeSubstitutionsType, Substitution
from tutor.bundled_ros.launching.launch.entities import Action
from tutor.bundled_ros.launching.launch.lookup import LaunchConfiguration
from tutor.bundled_ros.launching.launch.values import normalize_to_list_of_substitutions, perform_substitutions

Environment = Mapping[SomeSubstitutionsType, SomeSubstitutionsType]
_process_numbers = itertools.count(1)


@runtime_checkable
class Words(Protocol):
    """A substitution that may expand to several words of a command and has a short name."""

    def perform_words(self, context: LaunchContext) -> list[str]:
        """Return the words."""

    def perform_name(self, context: LaunchContext) -> str:
        """Return the name of a process whose command starts with these words."""


class Executable:
    """The parts of a process as given; `prepare` expands them into what is started (`final_...`)."""

    def __init__(
        self,
        *,
        cmd: Iterable[SomeSubstitutionsType],
        prefix: SomeSubstitutionsType | None = None,
        name: SomeSubstitutionsType | None = None,
        cwd: SomeSubstitutionsType | None = None,
        env: Environment | None = None,
        additional_env: Environment | None = None,
        arguments: Iterable[SomeSubstitutionsType] | None = None,
    ) -> None:
        self._cmd = [normalize_to_list_of_substitutions(item) for item in (*cmd, *(arguments or ()))]
        self._prefix = normalize_to_list_of_substitutions(
            LaunchConfiguration("launch-prefix", default="") if prefix is None else prefix
        )
        filtered = LaunchConfiguration("launch-prefix-filter", default="") if prefix is None else ""
        self._prefix_filter = normalize_to_list_of_substitutions(filtered)
        self._name = None if name is None else normalize_to_list_of_substitutions(name)
        self._cwd = None if cwd is None else normalize_to_list_of_substitutions(cwd)
        self._env = None if env is None else _normalize(env)
        self._additional_env = None if additional_env is None else _normalize(additional_env)
        self._final_cmd: list[str] | None = None
        self._final_cwd: str | None = None
        self._final_env: dict[str, str] | None = None
        self._final_name: str | None = None

    @property
    def cmd(self) -> list[list[Substitution]]:
        return self._cmd

    @property
    def name(self) -> list[Substitution] | None:
        return self._name

    @property
    def cwd(self) -> list[Substitution] | None:
        return self._cwd

    @property
    def env(self) -> list[tuple[list[Substitution], list[Substitution]]] | None:
        return self._env

    @property
    def final_cmd(self) -> list[str] | None:
        return self._final_cmd

    @property
    def final_cwd(self) -> str | None:
        return self._final_cwd

    @property
    def final_env(self) -> dict[str, str] | None:
        return self._final_env

    @property
    def final_name(self) -> str | None:
        return self._final_name

    def prepare(self, context: LaunchContext, action: Action) -> None:
        """Expand all parts and number the process; the numbers keep counting up through the whole launch."""
        words = [word for item in self._cmd for word in _expand_words(context, item)]
        default_name = self._default_name(context, words)
        if re.match(perform_substitutions(context, self._prefix_filter), default_name):
            prefix = shlex.split(perform_substitutions(context, self._prefix))
            words = [*prefix, *words]
            default_name = os.path.basename(prefix[0]) if prefix else default_name
        name = default_name if self._name is None else perform_substitutions(context, self._name)
        self._final_cmd = words
        self._final_name = f"{name}-{next(_process_numbers)}"
        self._final_cwd = None if self._cwd is None else perform_substitutions(context, self._cwd)
        environment = dict(context.environment) if self._env is None else _perform(context, self._env)
        if self._additional_env is not None:
            environment.update(_perform(context, self._additional_env))
        self._final_env = environment

    def _default_name(self, context: LaunchContext, words: list[str]) -> str:
        first = self._cmd[0]
        if len(first) == 1 and isinstance(first[0], Words):
            return first[0].perform_name(context)
        return os.path.basename(words[0])


def _expand_words(context: LaunchContext, item: list[Substitution]) -> list[str]:
    if len(item) == 1 and isinstance(item[0], Words):
        return item[0].perform_words(context)
    return [perform_substitutions(context, item)]


def _normalize(variables: Environment) -> list[tuple[list[Substitution], list[Substitution]]]:
    return [
        (normalize_to_list_of_substitutions(name), normalize_to_list_of_substitutions(value))
        for name, value in variables.items()
    ]


def _perform(context: LaunchContext, variables: list[tuple[list[Substitution], list[Substitution]]]) -> dict[str, str]:
    return {perform_substitutions(context, name): perform_substitutions(context, value) for name, value in variables}
