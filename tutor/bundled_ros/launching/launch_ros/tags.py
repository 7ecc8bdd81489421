"""The tags of XML and YAML launch files that become actions of `launch_ros`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tutor.bundled_ros.launching.launch.entities import Action
from tutor.bundled_ros.launching.launch.frontend import ACTIONS, Entity, make_children
from tutor.bundled_ros.launching.launch.tags import condition, pairs, process_arguments, text, texts, value
from tutor.bundled_ros.launching.launch.text import parse_substitution, parse_words
from tutor.bundled_ros.launching.launch_ros.composable import (
    ComposableNode,
    ComposableNodeContainer,
    LoadComposableNodes,
)
from tutor.bundled_ros.launching.launch_ros.node import Node
from tutor.bundled_ros.launching.launch_ros.parameters import ParameterFile, ParameterValue
from tutor.bundled_ros.launching.launch_ros.settings import (
    PushROSNamespace,
    ROSTimer,
    SetParameter,
    SetParametersFromFile,
    SetRemap,
    SetROSLogDir,
    SetUseSimTime,
)

TYPES: dict[str, Any] = {
    "str": str,
    "bool": bool,
    "float": float,
    "int": int,
    "list_of_str": list[str],
    "list_of_bool": list[bool],
    "list_of_float": list[float],
    "list_of_int": list[int],
    "yaml": None,
}


def node_arguments(entity: Entity) -> dict[str, Any]:
    """Return the arguments of a Node."""
    given = process_arguments(entity)
    given |= texts(entity, package="pkg", name="name", namespace="namespace", exec_name="exec_name")
    for argument, attribute in (("arguments", "args"), ("ros_arguments", "ros_args")):
        if (words := entity.find(attribute)) is not None:
            given[argument] = parse_words(words)
    given["executable"] = text(entity, "exec")
    given |= parameters_and_remappings(entity)
    return given


def parameters_and_remappings(entity: Entity) -> dict[str, Any]:
    """Return the arguments from the <param> and <remap> child entities."""
    given: dict[str, Any] = {}
    if remappings := pairs(entity, "remap", "from", "to"):
        given["remappings"] = remappings
    if params := entity.children_named("param"):
        given["parameters"] = [_parameters(param) for param in params]
    return given


def _parameters(entity: Entity) -> Any:
    """Return a parameter file, or a dict with one parameter."""
    name, file = entity.find("name"), entity.find("from")
    allow_substs = entity.find("allow_substs", bool)
    if name is not None and file is not None:
        raise RuntimeError("name and from attributes are mutually exclusive")
    if file is not None:
        entity.reject_unknown()
        given = parse_substitution(allow_substs) if isinstance(allow_substs, str) else bool(allow_substs)
        return ParameterFile(parse_substitution(file), allow_substs=given)
    if name is None:
        raise ValueError("param Entity should have name or from attribute")
    if allow_substs is not None:
        raise RuntimeError("'allow_substs' can only be used together with 'from' attribute")
    return _values([entity])


def _values(entities: Sequence[Entity]) -> dict[Any, Any]:
    values: dict[Any, Any] = {}
    for entity in entities:
        name = tuple(text(entity, "name"))
        type_name = entity.find("type")
        if type_name is not None and type_name not in TYPES:
            raise ValueError(f"Got invalid type identifier '{type_name}'")
        data_type = TYPES[type_name or "yaml"]
        given = entity.find("value", data_type)
        nested = entity.children_named("param")
        entity.reject_unknown()
        if nested and (given is not None or type_name is not None):
            raise RuntimeError("nested parameters and value or type attributes are mutually exclusive")
        if nested:
            values[name] = _values(nested)
        elif given is not None:
            values[name] = ParameterValue(value(given), value_type=data_type)
        else:
            raise RuntimeError("either a value attribute or nested params are needed")
    return values


def _set_parameter(entity: Entity) -> Action:
    return SetParameter(text(entity, "name"), text(entity, "value"), **condition(entity))


def _node_container(entity: Entity) -> Action:
    nodes = [_composable_node(node) for node in entity.children_named("composable_node")]
    return ComposableNodeContainer(composable_node_descriptions=nodes, **node_arguments(entity))


def _load_composable_node(entity: Entity) -> Action:
    nodes = [_composable_node(node) for node in entity.children_named("composable_node")]
    target = text(entity, "target")
    return LoadComposableNodes(composable_node_descriptions=nodes, target_container=target, **condition(entity))


def _composable_node(entity: Entity) -> ComposableNode:
    given = condition(entity) | texts(entity, namespace="namespace") | parameters_and_remappings(entity)
    if extra := pairs(entity, "extra_arg", "name", "value"):
        given["extra_arguments"] = [dict([pair]) for pair in extra]
    node = ComposableNode(
        package=text(entity, "pkg"), plugin=text(entity, "plugin"), name=text(entity, "name"), **given
    )
    entity.reject_unknown()
    return node


def _push_namespace(entity: Entity) -> Action:
    return PushROSNamespace(text(entity, "namespace"), **condition(entity))


ACTIONS |= {
    "load_composable_node": _load_composable_node,
    "node": lambda entity: Node(**node_arguments(entity)),
    "node_container": _node_container,
    "push-ros-namespace": _push_namespace,
    "push_ros_namespace": _push_namespace,
    "ros_timer": lambda entity: ROSTimer(
        period=value(entity.get("period", float)), actions=make_children(entity), **condition(entity)
    ),
    "set_parameter": _set_parameter,
    "set_parameters_from_file": lambda entity: SetParametersFromFile(text(entity, "filename"), **condition(entity)),
    "set_remap": lambda entity: SetRemap(text(entity, "from"), text(entity, "to"), **condition(entity)),
    "set_ros_log_dir": lambda entity: SetROSLogDir(text(entity, "new_log_dir"), **condition(entity)),
    "set_use_sim_time": lambda entity: SetUseSimTime(value(entity.get("value", bool)), **condition(entity)),
}
