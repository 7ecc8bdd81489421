"""Actions with settings for all later nodes, and a ROS timer."""

from __future__ import annotations

import os.path
from typing import Any

from tutor.bundled_ros.launching.launch.base import LaunchContext, SomeSubstitutionsType
from tutor.bundled_ros.launching.launch.entities import Action
from tutor.bundled_ros.launching.launch.flow import TimerAction
from tutor.bundled_ros.launching.launch.values import (
    SubstitutionFailure,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from tutor.bundled_ros.launching.launch_ros.names import (
    InvalidNamespaceException,
    make_namespace_absolute,
    prefix_namespace,
    validate_namespace,
)
from tutor.bundled_ros.launching.launch_ros.parameters import evaluate_parameter_dict, normalize_parameter_dict


class PushROSNamespace(Action):
    """Puts later nodes in this scope into a namespace, relative to the one pushed before."""

    def __init__(self, namespace: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._namespace = normalize_to_list_of_substitutions(namespace)

    def execute(self, context: LaunchContext) -> None:
        pushed = perform_substitutions(context, self._namespace)
        previous = context.launch_configurations.get("ros_namespace")
        namespace = make_namespace_absolute(prefix_namespace(previous, pushed))
        try:
            validate_namespace(namespace or "")
        except InvalidNamespaceException as error:
            raise SubstitutionFailure(
                f"The resulting namespace is invalid: [previous_namespace='{previous}', pushed_namespace='{pushed}']"
            ) from error
        context.launch_configurations["ros_namespace"] = namespace


class SetParameter(Action):
    """Sets a parameter of all later nodes in this scope; the nodes' own parameters take precedence."""

    def __init__(self, name: SomeSubstitutionsType, value: Any, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._parameter = normalize_parameter_dict({tuple(normalize_to_list_of_substitutions(name)): value})

    def execute(self, context: LaunchContext) -> None:
        evaluated = evaluate_parameter_dict(context, self._parameter)
        context.launch_configurations.setdefault("global_params", []).extend(evaluated.items())


class SetParametersFromFile(Action):
    """Passes a parameter file to all later nodes in this scope."""

    def __init__(self, filename: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._file = normalize_to_list_of_substitutions(filename)

    def execute(self, context: LaunchContext) -> None:
        path = perform_substitutions(context, self._file)
        context.launch_configurations.setdefault("global_params", []).append(path)


class SetUseSimTime(Action):
    """Does nothing: the original sets `use_sim_time` only on the launch's own node, whose clock is not used here."""

    def __init__(self, value: bool, **kwargs: Any) -> None:
        super().__init__(**kwargs)

    def execute(self, context: LaunchContext) -> None:
        return None


class SetRemap(Action):
    """Adds a remapping to all later nodes in this scope, before their own."""

    def __init__(self, src: SomeSubstitutionsType, dst: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._src = normalize_to_list_of_substitutions(src)
        self._dst = normalize_to_list_of_substitutions(dst)

    def execute(self, context: LaunchContext) -> None:
        rule = (perform_substitutions(context, self._src), perform_substitutions(context, self._dst))
        # As in the original, an inner scope shares an existing list rather than copying it.
        context.launch_configurations.setdefault("ros_remaps", []).append(rule)


def _current_log_dir(context: LaunchContext) -> str:
    home = context.environment.get("ROS_HOME") or os.path.expanduser("~/.ros")
    return context.environment.get("ROS_LOG_DIR") or os.path.join(home, "log")


class SetROSLogDir(Action):
    """Sets ROS_LOG_DIR for later processes in this scope; a relative path is below the current one."""

    def __init__(self, new_log_dir: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._log_dir = normalize_to_list_of_substitutions(new_log_dir)

    def execute(self, context: LaunchContext) -> None:
        folder = perform_substitutions(context, self._log_dir)
        context.environment["ROS_LOG_DIR"] = os.path.join(_current_log_dir(context), folder)


class ROSTimer(TimerAction):
    """A timer on the clock of the launch's own node. Here that is the system clock: simulated time is not supported."""
