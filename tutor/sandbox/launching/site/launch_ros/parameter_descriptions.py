"""Parameters with a type, a name, or in a file."""

from __future__ import annotations

import atexit
import contextlib
import os
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import yaml
from launch._frontend import parse_substitution
from launch.launch_context import LaunchContext
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.substitution import Substitution
from launch.utilities import ensure_argument_type, normalize_to_list_of_substitutions, perform_substitutions
from launch.utilities.type_utils import normalize_typed_substitution, perform_typed_substitution


class ParameterValue:
    """A value of a given type; without a type, of the type that its text has as YAML."""

    def __init__(self, value: Any, *, value_type: Any = None) -> None:
        self._value = normalize_typed_substitution(value, value_type)
        self._value_type = value_type

    @property
    def value(self) -> Any:
        return self._value

    @property
    def value_type(self) -> Any:
        return self._value_type

    def evaluate(self, context: LaunchContext) -> Any:
        """The value; ValueError where it is none of that type."""
        return perform_typed_substitution(context, self._value, self._value_type)


class Parameter:
    """A name with a value, given to the node with `-p`."""

    def __init__(self, name: SomeSubstitutionsType, value: Any, *, value_type: Any = None) -> None:
        self._name = normalize_to_list_of_substitutions(name)
        self._value = ParameterValue(value, value_type=value_type)

    @property
    def name(self) -> list[Substitution]:
        return self._name

    @property
    def value(self) -> Any:
        return self._value.value

    @property
    def value_type(self) -> Any:
        return self._value.value_type

    def evaluate(self, context: LaunchContext) -> tuple[str, Any]:
        """The name and the value."""
        return perform_substitutions(context, self._name), self._value.evaluate(context)


class ParameterFile:
    """A YAML file of parameters; with `allow_substs` those of launch, such as $(var x), are performed in it."""

    def __init__(
        self,
        param_file: str | os.PathLike[str] | SomeSubstitutionsType,
        *,
        allow_substs: bool | SomeSubstitutionsType = False,
    ) -> None:
        ensure_argument_type(allow_substs, (bool, str, Substitution, Iterable), "allow_substs", "ParameterFile()")
        self._allow_substs = normalize_typed_substitution(allow_substs, bool)
        self._file = (
            os.fspath(param_file)
            if isinstance(param_file, os.PathLike)
            else normalize_to_list_of_substitutions(param_file)
        )

    @property
    def allow_substs(self) -> Any:
        return self._allow_substs

    @property
    def param_file(self) -> Any:
        return self._file

    def evaluate(self, context: LaunchContext) -> Path:
        """The file's path, or that of a copy with the substitutions performed, which goes when the launch ends."""
        path = Path(self._file if isinstance(self._file, str) else perform_substitutions(context, self._file))
        if not perform_typed_substitution(context, self._allow_substs, bool):
            return path
        text = perform_substitutions(context, parse_substitution(path.read_text(encoding="utf-8")))
        try:
            yaml.safe_load(text)
        except yaml.YAMLError as error:
            raise ValueError(f"the parameter file '{path}' is no YAML once its substitutions are performed") from error
        return temporary_file(text)


def temporary_file(text: str) -> Path:
    """A file of parameters with this text, which is there as long as the launch runs."""
    with tempfile.NamedTemporaryFile(mode="w", prefix="launch_params_", delete=False, dir=_folder()) as file:
        file.write(text)
    atexit.register(_remove, file.name)
    return Path(file.name)


def _folder() -> str | None:
    """That of the `ros2` around us, which goes with it however it ends."""
    overlay = os.environ.get("ROS_TUTOR_OVERLAY", "")
    return os.path.dirname(overlay) if os.path.isdir(overlay) else None


def _remove(path: str) -> None:
    with contextlib.suppress(OSError):
        os.unlink(path)
