"""Sources of launch descriptions: the kinds of launch files that can be read."""

from __future__ import annotations

import os.path
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from types import ModuleType

from ._entities import InvalidLaunchFileError, SomeSubstitutionsType
from ._frontend import load_launch_description, suffixes
from ._unsupported import NotSupportedError
from .launch_context import LaunchContext
from .launch_description import LaunchDescription
from .utilities import normalize_to_list_of_substitutions, perform_substitutions

__all__ = [
    "AnyLaunchDescriptionSource",
    "FrontendLaunchDescriptionSource",
    "InvalidFrontendLaunchFileError",
    "InvalidPythonLaunchFileError",
    "PythonLaunchDescriptionSource",
    "get_launch_description_from_any_launch_file",
    "get_launch_description_from_frontend_launch_file",
    "get_launch_description_from_python_launch_file",
    "load_python_launch_file_as_module",
]


unreadable: dict[str, Exception] = {}
"""The errors of files that could not be read ahead of the run, by path."""


class LaunchDescriptionSource:
    """A launch description, given directly or read from `location` on first use."""

    def __init__(
        self,
        launch_description: LaunchDescription | None = None,
        location: SomeSubstitutionsType = "<string>",
        method: str = "unspecified mechanism from a script",
    ) -> None:
        self._description = launch_description
        self._location = normalize_to_list_of_substitutions(location)
        self._expanded_location: str | None = None
        self._method = method

    @property
    def location(self) -> str:
        if self._expanded_location is not None:
            return self._expanded_location
        return " + ".join(str(part) for part in self._location)

    @property
    def method(self) -> str:
        return self._method

    def try_get_launch_description_without_context(self) -> LaunchDescription | None:
        """Return the description ahead of the run; None if its path is not known yet or the file cannot be read."""
        if self._description is not None:
            return self._description
        try:
            location = perform_substitutions(LaunchContext(), self._location)
        except Exception:
            return None
        try:
            return self._get_launch_description(location)
        except Exception as error:
            unreadable[location] = error
            return None

    def get_launch_description(self, context: LaunchContext) -> LaunchDescription:
        if self._expanded_location is None:
            self._expanded_location = perform_substitutions(context, self._location)
        if self._description is None:
            self._description = self._get_launch_description(self._expanded_location)
        return self._description

    def _get_launch_description(self, location: str) -> LaunchDescription:
        raise RuntimeError("this LaunchDescriptionSource holds no launch description and reads none")


class InvalidPythonLaunchFileError(Exception):
    """The Python file is not a launch file."""


def load_python_launch_file_as_module(python_launch_file_path: str) -> ModuleType:
    """Run the file as a module. Raises whatever the file raises."""
    loader = SourceFileLoader("python_launch_file", python_launch_file_path)
    spec = spec_from_loader(loader.name, loader)
    if spec is None:
        raise RuntimeError(f"cannot load '{python_launch_file_path}'")
    module = module_from_spec(spec)
    loader.exec_module(module)
    return module


def get_launch_description_from_python_launch_file(python_launch_file_path: str) -> LaunchDescription:
    """Return the result of the file's generate_launch_description()."""
    module = load_python_launch_file_as_module(python_launch_file_path)
    if not hasattr(module, "generate_launch_description"):
        raise InvalidPythonLaunchFileError(
            f"launch file at '{python_launch_file_path}' does not contain the required function "
            "'generate_launch_description()'"
        )
    description: LaunchDescription = module.generate_launch_description()
    return description


class PythonLaunchDescriptionSource(LaunchDescriptionSource):
    """The launch description in a Python file."""

    def __init__(self, launch_file_path: SomeSubstitutionsType) -> None:
        super().__init__(None, launch_file_path, "interpreted python launch file")

    def _get_launch_description(self, location: str) -> LaunchDescription:
        return get_launch_description_from_python_launch_file(location)


class InvalidFrontendLaunchFileError(InvalidLaunchFileError):
    """The file is not in a known launch file format."""


def get_launch_description_from_frontend_launch_file(frontend_launch_file_path: str) -> LaunchDescription:
    """Return the launch description in an XML or YAML file. Raises if it is invalid."""
    return load_launch_description(frontend_launch_file_path)


class FrontendLaunchDescriptionSource(LaunchDescriptionSource):
    """The launch description in an XML or YAML file."""

    def __init__(
        self, launch_file_path: SomeSubstitutionsType, *, method: str = "interpreted frontend launch file"
    ) -> None:
        super().__init__(None, launch_file_path, method)

    def _get_launch_description(self, location: str) -> LaunchDescription:
        return get_launch_description_from_frontend_launch_file(location)


def get_launch_description_from_any_launch_file(launch_file_path: str) -> LaunchDescription:
    """Return the launch description in a file. Raises InvalidLaunchFileError if it cannot be read."""
    suffix = os.path.splitext(launch_file_path)[1].removeprefix(".")
    if suffix == "py":
        return _from_python(launch_file_path)
    try:
        return get_launch_description_from_frontend_launch_file(launch_file_path)
    except NotSupportedError:
        raise
    except Exception as error:
        if suffixes(launch_file_path):
            raise InvalidLaunchFileError(suffix, likely_errors=[error]) from error
    try:
        return get_launch_description_from_python_launch_file(launch_file_path)
    except NotSupportedError:
        raise
    except Exception as error:
        raise InvalidLaunchFileError(likely_errors=[error]) from error


def _from_python(path: str) -> LaunchDescription:
    try:
        return get_launch_description_from_python_launch_file(path)
    except NotSupportedError:
        raise
    except Exception as error:
        # The original also tries its other formats and reports each error.
        other = InvalidFrontendLaunchFileError()
        raise InvalidLaunchFileError("py", likely_errors=[error, other]) from error


class AnyLaunchDescriptionSource(LaunchDescriptionSource):
    """The launch description in a file of any format, which the file's name determines."""

    def __init__(self, launch_file_path: SomeSubstitutionsType) -> None:
        super().__init__(None, launch_file_path, "interpreted launch file")

    def _get_launch_description(self, location: str) -> LaunchDescription:
        return get_launch_description_from_any_launch_file(location)


class XMLLaunchDescriptionSource(FrontendLaunchDescriptionSource):
    """The launch description in an XML file, read when it is included."""

    def __init__(self, launch_file_path: SomeSubstitutionsType) -> None:
        super().__init__(launch_file_path, method="interpreted XML launch file")


class YAMLLaunchDescriptionSource(FrontendLaunchDescriptionSource):
    """The launch description in a YAML file, read when it is included."""

    def __init__(self, launch_file_path: SomeSubstitutionsType) -> None:
        super().__init__(launch_file_path, method="interpreted YAML launch file")
