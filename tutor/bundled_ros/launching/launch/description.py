"""Launch descriptions, and their sources: the kinds of launch files that can be read."""

from __future__ import annotations

import os.path
from collections.abc import Iterable, Sequence
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from types import ModuleType

from tutor.bundled_ros.launching.launch import frontend
from tutor.bundled_ros.launching.launch.base import LaunchContext, LaunchDescriptionEntity, SomeSubstitutionsType
from tutor.bundled_ros.launching.launch.entities import Action
from tutor.bundled_ros.launching.launch.errors import NotSupportedError
from tutor.bundled_ros.launching.launch.logs import get_logger
from tutor.bundled_ros.launching.launch.scope import DeclareLaunchArgument, ResetLaunchConfigurations
from tutor.bundled_ros.launching.launch.values import normalize_to_list_of_substitutions, perform_substitutions


class Include(Action):
    """An action that visits another launch description."""

    def argument_names_without_context(self) -> list[str]:
        """Return the names of the launch arguments that it gives, as far as they are known ahead of the run."""
        raise NotImplementedError


ArgumentAndIncludes = tuple[DeclareLaunchArgument, list[Include] | None]


class LaunchDescription(LaunchDescriptionEntity):
    """A list of entities, which are visited in order."""

    def __init__(
        self,
        initial_entities: Iterable[LaunchDescriptionEntity] | None = None,
        *,
        deprecated_reason: str | None = None,
    ) -> None:
        self._entities = list(initial_entities) if initial_entities is not None else []
        self._deprecated_reason = deprecated_reason

    @property
    def entities(self) -> list[LaunchDescriptionEntity]:
        return self._entities

    def add_entity(self, entity: LaunchDescriptionEntity) -> None:
        self._entities.append(entity)

    def add_action(self, action: Action) -> None:
        self.add_entity(action)

    def visit(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity]:
        if self._deprecated_reason is not None:
            where = context.get_locals_as_dict().get("current_launch_file_path")
            start = f"launch file [{where}] is deprecated" if where else "deprecated launch description"
            get_logger().warning(f"{start}: {self._deprecated_reason}")
        return self._entities

    def describe_sub_entities(self) -> Sequence[LaunchDescriptionEntity]:
        return self._entities

    def get_launch_arguments(self, conditional_inclusion: bool = False) -> list[DeclareLaunchArgument]:
        """Return the arguments declared here and in included files that can be read without running the launch."""
        found = self.arguments_and_includes(conditional_inclusion)
        return [argument for argument, _ in found]

    def arguments_and_includes(self, conditional_inclusion: bool = False) -> list[ArgumentAndIncludes]:
        """Return each argument (the first of its name) and the includes that lead to it (None: declared at the top)."""
        found: dict[str, ArgumentAndIncludes] = {}

        def search(
            entities: Iterable[LaunchDescriptionEntity],
            conditional: bool,
            includes: list[Include] | None,
        ) -> None:
            for entity in entities:
                if isinstance(entity, DeclareLaunchArgument):
                    if entity.name in found:
                        continue
                    entity._conditionally_included = conditional or entity.condition is not None
                    found[entity.name] = (entity, includes)
                if isinstance(entity, ResetLaunchConfigurations):
                    return  # later arguments cannot be set from outside
                inner = includes
                if isinstance(entity, Include):
                    # The list is shared along the path, as in the original.
                    inner = inner if inner is not None else []
                    inner.append(entity)
                search(entity.describe_sub_entities(), False, inner)
                for _, sub_entities in entity.describe_conditional_sub_entities():
                    search(sub_entities, True, inner)

        search(self._entities, conditional_inclusion, None)
        return list(found.values())


class InvalidLaunchFileError(Exception):
    """The file could not be read in any format; `likely_errors` holds one error per attempt."""

    def __init__(self, extension: str = "", *, likely_errors: Sequence[Exception] = ()) -> None:
        super().__init__(extension)
        if not extension or not likely_errors:
            self._message = "The launch file may have a syntax error, or its format is unknown"
            return
        count = "multiple exceptions" if len(likely_errors) > 1 else "exception"
        lines = [f"Caught {count} when trying to load file of format [{extension}]:"]
        lines += [f" - {type(error).__name__}: {error}" for error in likely_errors]
        self._message = "\n".join(lines)
        self.__cause__ = likely_errors[0]

    def __str__(self) -> str:
        return self._message


unreadable: dict[str, Exception] = {}
"""The errors of files that could not be read ahead of the run, by path."""


class LaunchDescriptionSource:
    """A launch description, given directly or read from `location` on first use."""

    def __init__(
        self,
        launch_description: LaunchDescription | None = None,
        location: SomeSubstitutionsType = "<string>",
    ) -> None:
        self._description = launch_description
        self._location = normalize_to_list_of_substitutions(location)
        self._expanded_location: str | None = None

    @property
    def location(self) -> str:
        if self._expanded_location is not None:
            return self._expanded_location
        return " + ".join(str(part) for part in self._location)

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
        super().__init__(None, launch_file_path)

    def _get_launch_description(self, location: str) -> LaunchDescription:
        return get_launch_description_from_python_launch_file(location)


class InvalidFrontendLaunchFileError(InvalidLaunchFileError):
    """The file is not in a known launch file format."""


def get_launch_description_from_frontend_launch_file(frontend_launch_file_path: str) -> LaunchDescription:
    """Return the launch description in an XML or YAML file. Raises if it is invalid."""
    root = frontend.read(frontend_launch_file_path)
    deprecated = root.find("deprecated")
    return LaunchDescription(frontend.make_children(root), deprecated_reason=deprecated)


class FrontendLaunchDescriptionSource(LaunchDescriptionSource):
    """The launch description in an XML or YAML file."""

    def __init__(self, launch_file_path: SomeSubstitutionsType) -> None:
        super().__init__(None, launch_file_path)

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
        if frontend.suffixes(launch_file_path):
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
        super().__init__(None, launch_file_path)

    def _get_launch_description(self, location: str) -> LaunchDescription:
        return get_launch_description_from_any_launch_file(location)


class XMLLaunchDescriptionSource(FrontendLaunchDescriptionSource):
    """The launch description in an XML file."""


class YAMLLaunchDescriptionSource(FrontendLaunchDescriptionSource):
    """The launch description in a YAML file."""
