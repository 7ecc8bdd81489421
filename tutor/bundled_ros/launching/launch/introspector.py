"""A launch description as a text tree, as `ros2 launch --print` shows it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from tutor.bundled_ros.launching.launch.base import LaunchDescriptionEntity, SomeSubstitutionsType
from tutor.bundled_ros.launching.launch.description import LaunchDescription
from tutor.bundled_ros.launching.launch.execute_process import ExecuteProcess
from tutor.bundled_ros.launching.launch.flow import EmitEvent, LogInfo, RegisterEventHandler
from tutor.bundled_ros.launching.launch.values import normalize_to_list_of_substitutions

Tree = tuple[str, list[Any]]
"""A line and the trees below it."""


class LaunchIntrospector:
    """Describes launch descriptions without running them."""

    def format_launch_description(self, launch_description: LaunchDescription) -> str:
        """Format one line per entity, with a handler's entities below it."""
        return "\n".join([str(launch_description), *_lines(_trees(launch_description.entities), "")])


def _trees(entities: Iterable[LaunchDescriptionEntity]) -> list[Tree]:
    return [_tree(entity) for entity in entities]


def _tree(entity: LaunchDescriptionEntity) -> Tree:
    match entity:
        case LogInfo():
            return f"LogInfo({_substitutions(entity.msg)})", []
        case EmitEvent():
            return f"EmitEvent(event='{entity.event.name}')", []
        case ExecuteProcess():
            return _process(entity), []
        case RegisterEventHandler():
            description, below = entity.event_handler.describe()
            return f"RegisterEventHandler('{entity.event_handler}'):", [(description, _trees(below))]
        case _:
            return f"Action('{entity}')", []


def _process(action: ExecuteProcess) -> str:
    cmd = ", ".join(_substitutions(word) for word in action.cmd)
    cwd = None if action.cwd is None else f"'{_substitutions(action.cwd)}'"
    env = action.env
    if env is not None:
        env = "{" + ", ".join(f"{_substitutions(name)}: {_substitutions(value)}" for name, value in env) + "}"
    return f"ExecuteProcess(cmd=[{cmd}], cwd={cwd}, env={env}, shell={action.shell})"


def _substitutions(given: SomeSubstitutionsType) -> str:
    return " + ".join(part.describe() for part in normalize_to_list_of_substitutions(given))


def _lines(trees: list[Tree], indent: str) -> Iterable[str]:
    for index, (line, below) in enumerate(trees):
        is_last = index == len(trees) - 1
        yield f"{indent}{'└── ' if is_last else '├── '}{line}"
        yield from _lines(below, indent + ("    " if is_last else "│   "))
