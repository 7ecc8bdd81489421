"""The action that starts a ROS node."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import yaml

from tutor.bundled_ros.launching.launch.base import LaunchContext, LaunchDescriptionEntity, SomeSubstitutionsType
from tutor.bundled_ros.launching.launch.execute_process import ExecuteProcess
from tutor.bundled_ros.launching.launch.logs import get_logger
from tutor.bundled_ros.launching.launch.values import (
    ensure_argument_type,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from tutor.bundled_ros.launching.launch_ros.names import (
    SomeRemapRule,
    make_namespace_absolute,
    normalize_remap_rules,
    prefix_namespace,
    validate_namespace,
    validate_node_name,
)
from tutor.bundled_ros.launching.launch_ros.parameters import (
    Parameter,
    ParameterFile,
    evaluate_parameter_dict,
    normalize_parameters,
    temporary_file,
)
from tutor.bundled_ros.launching.launch_ros.substitutions import ExecutableInPackage


class Node(ExecuteProcess):
    """Starts a node's executable, with its name, namespace, parameters and remappings as `--ros-args`.

    `arguments` precede these and are for the node itself. Unless it starts with a slash, `namespace` is relative to the
    one of PushROSNamespace. Parameters and remappings set by SetParameter and SetRemap come before the node's own.
    `exec_name` is the name of the process in messages. All other arguments of ExecuteProcess are accepted as well,
    except `cmd` and its `name`.
    """

    UNSPECIFIED_NODE_NAME = "<node_name_unspecified>"
    UNSPECIFIED_NODE_NAMESPACE = "<node_namespace_unspecified>"

    def __init__(
        self,
        *,
        executable: SomeSubstitutionsType,
        package: SomeSubstitutionsType | None = None,
        name: SomeSubstitutionsType | None = None,
        namespace: SomeSubstitutionsType | None = None,
        exec_name: SomeSubstitutionsType | None = None,
        parameters: Sequence[Any] | None = None,
        remappings: Iterable[SomeRemapRule] | None = None,
        ros_arguments: Iterable[SomeSubstitutionsType] | None = None,
        arguments: Iterable[SomeSubstitutionsType] | None = None,
        **kwargs: Any,
    ) -> None:
        command = executable if package is None else ExecutableInPackage(executable=executable, package=package)
        cmd = [command, *(arguments or ())]
        if ros_arguments is not None:
            cmd += ["--ros-args", *ros_arguments]
        super().__init__(cmd=[*cmd, "--ros-args"], name=exec_name, **kwargs)
        if parameters is not None:
            ensure_argument_type(parameters, list, "parameters", "Node")
        self._package = package
        self._executable = executable
        self._node_name = name
        self._node_namespace = namespace
        self._parameters = normalize_parameters(parameters or [])
        self._remappings = list(normalize_remap_rules(remappings or ()))
        self._final_node_name: str | None = None
        self._final_namespace: str | None = None

    @property
    def node_package(self) -> SomeSubstitutionsType | None:
        return self._package

    @property
    def node_name(self) -> str:
        """The node's fully qualified name. Raises RuntimeError before the action is executed."""
        if self._final_node_name is None:
            raise RuntimeError("cannot access 'node_name' before executing action")
        return self._final_node_name

    @property
    def expanded_node_namespace(self) -> str:
        return self._final_namespace or self.UNSPECIFIED_NODE_NAMESPACE

    def is_node_name_fully_specified(self) -> bool:
        """Return whether the name and the namespace are both given here rather than left to the executable."""
        return (
            self.UNSPECIFIED_NODE_NAME not in self.node_name and self.UNSPECIFIED_NODE_NAMESPACE not in self.node_name
        )

    def execute(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity] | None:
        self._complete_command(context)
        entities = super().execute(context)
        if self.is_node_name_fully_specified():
            self._warn_about_duplicate_name(context)
        return entities

    def _complete_command(self, context: LaunchContext) -> None:
        """Append the ROS arguments to the command. From then on, the node's name and namespace are known."""
        if self._final_node_name is None:
            for word in self._ros_arguments(context):
                self._description.cmd.append(normalize_to_list_of_substitutions(word))

    def _ros_arguments(self, context: LaunchContext) -> list[str]:
        """Return the words after `--ros-args`, in the order of the original."""
        words = []
        try:
            name = self._expand_name(context)
            if name is not None:
                words += ["-r", f"__node:={name}"]
            if self._final_namespace is not None:
                words += ["-r", f"__ns:={self._final_namespace}"]
        except Exception:
            get_logger("launch_ros.actions.node").error(
                "Error while expanding or validating node name or namespace for "
                f"'package={self._package}, executable={self._executable}, name={self._node_name}, "
                f"namespace={self._node_namespace}':"
            )
            raise
        words += self._global_parameters(context)
        words += self._own_parameters(context)
        remappings = list(context.launch_configurations.get("ros_remaps") or ())
        remappings += [
            (perform_substitutions(context, src), perform_substitutions(context, dst)) for src, dst in self._remappings
        ]
        for src, dst in remappings:
            words += ["-r", f"{src}:={dst}"]
        return words

    def _expand_name(self, context: LaunchContext) -> str | None:
        """Expand the namespace and the name, and return the name. Raises if ROS would reject them."""
        name = _perform(context, self._node_name)
        if name is not None:
            validate_node_name(name)
        pushed = context.launch_configurations.get("ros_namespace")
        namespace = make_namespace_absolute(prefix_namespace(pushed, _perform(context, self._node_namespace)))
        if namespace is not None:
            validate_namespace(namespace)
        self._final_namespace = namespace
        self._final_node_name = prefix_namespace(self.expanded_node_namespace, name or self.UNSPECIFIED_NODE_NAME)
        return name

    def _global_parameters(self, context: LaunchContext) -> list[str]:
        words = []
        for item in context.launch_configurations.get("global_params") or ():
            if isinstance(item, tuple):
                words += ["-p", f"{item[0]}:={item[1]}"]
            else:
                words += ["--params-file", os.path.abspath(item)]
        return words

    def _own_parameters(self, context: LaunchContext) -> list[str]:
        words = []
        for item in self._parameters:
            if isinstance(item, Parameter):
                name, value = item.evaluate(context)
                words += ["-p", f"{name}:={yaml.dump(value)}"]
                continue
            if isinstance(item, ParameterFile):
                path = item.evaluate(context)
            else:
                path = self._write_parameters(evaluate_parameter_dict(context, item))
            if path.is_file():
                words += ["--params-file", str(path)]
            else:
                get_logger("launch_ros.actions.node").warning(f"Parameter file path is not a file: {path}")
        return words

    def _write_parameters(self, parameters: dict[str, Any]) -> Path:
        """Write parameters to a file that exists as long as the launch runs."""
        plain = {name: list(value) if isinstance(value, tuple) else value for name, value in parameters.items()}
        node = self.node_name if self.is_node_name_fully_specified() else "/**"
        return temporary_file(yaml.dump({node: {"ros__parameters": plain}}, default_flow_style=False))

    def _warn_about_duplicate_name(self, context: LaunchContext) -> None:
        names: dict[str, int] = context.get_locals_as_dict().get("unique_ros_node_names", {})
        names[self.node_name] = names.get(self.node_name, 0) + 1
        context.extend_globals({"unique_ros_node_names": names})
        if names[self.node_name] > 1:
            get_logger(self.name).warning(
                f"there are now at least {names[self.node_name]} nodes with the name {self.node_name} "
                "created within this launch context"
            )


def _perform(context: LaunchContext, value: SomeSubstitutionsType | None) -> str | None:
    return None if value is None else perform_substitutions(context, normalize_to_list_of_substitutions(value))
