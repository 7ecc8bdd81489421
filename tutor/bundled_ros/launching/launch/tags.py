"""The tags of XML and YAML launch files that become actions of `launch`."""

from __future__ import annotations

import re
from typing import Any

from tutor.bundled_ros.launching.launch.base import Substitution
from tutor.bundled_ros.launching.launch.composition import GroupAction, IncludeLaunchDescription
from tutor.bundled_ros.launching.launch.entities import Action, IfCondition, UnlessCondition
from tutor.bundled_ros.launching.launch.execute_process import ExecuteProcess
from tutor.bundled_ros.launching.launch.flow import LogInfo, Shutdown, TimerAction
from tutor.bundled_ros.launching.launch.frontend import ACTIONS, Entity, make_action, make_children
from tutor.bundled_ros.launching.launch.scope import (
    AppendEnvironmentVariable,
    DeclareLaunchArgument,
    ResetEnvironment,
    ResetLaunchConfigurations,
    SetEnvironmentVariable,
    SetLaunchConfiguration,
    UnsetEnvironmentVariable,
)
from tutor.bundled_ros.launching.launch.text import parse_substitution, parse_words
from tutor.bundled_ros.launching.launch.values import TextSubstitution

Arguments = dict[str, Any]


def condition(entity: Entity) -> Arguments:
    """Return the `condition` argument from an entity's `if` or `unless`."""
    predicate, negated = entity.find("if"), entity.find("unless")
    if predicate is not None and negated is not None:
        raise RuntimeError("if and unless conditions can't be used simultaneously")
    if predicate is not None:
        return {"condition": IfCondition(parse_substitution(predicate))}
    return {} if negated is None else {"condition": UnlessCondition(parse_substitution(negated))}


def texts(entity: Entity, **names: str) -> Arguments:
    """Return arguments from optional attributes with substitutions; `names` maps each argument to its attribute."""
    found = {argument: entity.find(attribute) for argument, attribute in names.items()}
    return {argument: parse_substitution(text) for argument, text in found.items() if text is not None}


def text(entity: Entity, attribute: str) -> list[Substitution]:
    """Return a required attribute with substitutions."""
    return parse_substitution(entity.get(attribute))


def value(given: Any) -> Any:
    """Convert a value: a text with substitutions into its parts, a list item by item; anything else stays as it is."""
    if isinstance(given, list):
        return [value(item) for item in given]
    if not isinstance(given, str):
        return given
    parts = parse_substitution(given)
    if len(parts) == 1 and isinstance(parts[0], TextSubstitution):
        return parts[0].text
    return parts


def pairs(entity: Entity, name: str, first: str, second: str) -> list[tuple[Any, Any]]:
    """Return two attributes of each child entity with this name, as pairs."""
    found = []
    for item in entity.children_named(name):
        found.append((tuple(text(item, first)), text(item, second)))
        item.reject_unknown()
    return found


def unescape(given: str) -> str:
    """Remove the escaping backslashes of a text."""
    return re.sub(r"\\(.)", r"\1", given)


def process_arguments(entity: Entity) -> Arguments:
    """Return the arguments that all processes take."""
    given = condition(entity)
    given |= texts(entity, cwd="cwd", prefix="launch-prefix", output="output", respawn="respawn")
    on_exit = entity.find("on_exit")
    if on_exit == "shutdown":
        given["on_exit"] = [Shutdown()]
    elif on_exit is not None:
        raise ValueError(f"Attribute on_exit of Entity node expected to be shutdown but got `{on_exit}`")
    for name, data_type in (("shell", bool), ("emulate_tty", bool), ("respawn_max_retries", int)):
        if (found := entity.find(name, data_type)) is not None:
            given[name] = found
    for name in ("respawn_delay", "sigterm_timeout", "sigkill_timeout"):
        if (seconds := entity.find(name, float)) is not None:
            if seconds < 0.0:
                raise ValueError(
                    f"Attribute {name} of Entity node expected to be a non-negative value but got `{seconds}`"
                )
            given[name] = seconds if name == "respawn_delay" else str(seconds)
    if env := pairs(entity, "env", "name", "value"):
        given["additional_env"] = dict(env)
    return given


def _executable(entity: Entity) -> Action:
    given = process_arguments(entity) | texts(entity, name="name")
    return ExecuteProcess(cmd=parse_words(entity.get("cmd")), **given)


def _arg(entity: Entity) -> Action:
    given = condition(entity) | texts(entity, default_value="default")
    if (description := entity.find("description")) is not None:
        given["description"] = unescape(description)
    if choices := entity.children_named("choice"):
        given["choices"] = [unescape(choice.get("value")) for choice in choices]
    return DeclareLaunchArgument(unescape(entity.get("name")), **given)


def _include(entity: Entity) -> Action:
    arguments = [*pairs(entity, "arg", "name", "value"), *pairs(entity, "let", "name", "value")]
    return IncludeLaunchDescription(text(entity, "file"), launch_arguments=arguments, **condition(entity))


def _group(entity: Entity) -> Action:
    given = condition(entity)
    for name in ("scoped", "forwarding"):
        if (found := entity.find(name, bool)) is not None:
            given[name] = found
    if keep := pairs(entity, "keep", "name", "value"):
        given["launch_configurations"] = dict(keep)
    return GroupAction([make_action(child) for child in entity.children if child.type_name != "keep"], **given)


def _timer(entity: Entity) -> Action:
    given = condition(entity)
    if (cancel := entity.find("cancel_on_shutdown", bool)) is not None:
        given["cancel_on_shutdown"] = value(cancel)
    period = value(entity.get("period", float))
    return TimerAction(period=period, actions=make_children(entity), **given)


def _append(entity: Entity) -> Action:
    given = condition(entity) | texts(entity, separator="separator")
    if (prepend := entity.find("prepend", bool)) is not None:
        given["prepend"] = value(prepend)
    return AppendEnvironmentVariable(text(entity, "name"), text(entity, "value"), **given)


def _reset(entity: Entity) -> Action:
    keep = dict(pairs(entity, "keep", "name", "value"))
    return ResetLaunchConfigurations(keep or None, **condition(entity))


def _shutdown(entity: Entity) -> Action:
    reason = entity.find("reason")
    return Shutdown(**({"reason": reason} if reason else {}), **condition(entity))


ACTIONS |= {
    "append_env": _append,
    "arg": _arg,
    "executable": _executable,
    "group": _group,
    "include": _include,
    "let": lambda entity: SetLaunchConfiguration(text(entity, "name"), text(entity, "value"), **condition(entity)),
    "log": lambda entity: LogInfo(msg=text(entity, "message"), **condition(entity)),
    "reset": _reset,
    "reset_env": lambda entity: ResetEnvironment(**condition(entity)),
    "set_env": lambda entity: SetEnvironmentVariable(text(entity, "name"), text(entity, "value"), **condition(entity)),
    "shutdown": _shutdown,
    "timer": _timer,
    "unset_env": lambda entity: UnsetEnvironmentVariable(text(entity, "name"), **condition(entity)),
}
