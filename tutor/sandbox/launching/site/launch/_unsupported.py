"""What the real `launch` and `launch_ros` have and this subset has not: one clear error that names it."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from types import ModuleType
from typing import NoReturn

ABSENT_PACKAGES = frozenset({"launch_pytest", "launch_testing", "launch_testing_ros", "launch_xml", "launch_yaml"})
"""Packages beside launch and launch_ros that a launch file may import."""

ABSENT_MODULES = frozenset(
    {
        "launch.actions.opaque_coroutine",
        "launch.frontend",
        "launch.launch_description_sources.frontend_launch_description_source",
        "launch.launch_introspector",
        "launch.logging.handlers",
        "launch.substitutions.launch_log_dir",
        "launch.utilities.signal_management",
        "launch_ros.actions.composable_node_container",
        "launch_ros.actions.lifecycle_node",
        "launch_ros.actions.lifecycle_transition",
        "launch_ros.actions.load_composable_nodes",
        "launch_ros.actions.ros_timer",
        "launch_ros.actions.set_ros_log_dir",
        "launch_ros.descriptions.composable_node",
        "launch_ros.event_handlers",
        "launch_ros.events",
        "launch_ros.parameters_type",
        "launch_ros.remap_rule_type",
        "launch_ros.ros_adapters",
        "launch_ros.substitutions.parameter",
    }
)
"""Modules of the real packages that people import by path."""


class NotSupportedError(ImportError):
    """Something of the real launch that this subset does not have."""


def refuse(what: str) -> NoReturn:
    """Raise the one error for a thing that only the real launch has; `what` is its full name."""
    raise NotSupportedError(
        f"{what} is not supported by the launch files that run without an installed ROS 2; "
        "it works where ROS 2 is installed and sourced"
    )


def lazily_refusing(module: str, absent: frozenset[str]) -> Callable[[str], NoReturn]:
    """A module's `__getattr__`: names in `absent` are refused, any other is unknown, as in any module."""

    def getattr_of_module(name: str) -> NoReturn:
        if name in absent:
            refuse(f"{module}.{name}")
        raise AttributeError(f"module {module!r} has no attribute {name!r}")

    return getattr_of_module


class AbsentModuleFinder:
    """Asked last, when nothing else has found a module: refuses those that only an installed ROS 2 has."""

    def find_spec(self, fullname: str, path: Sequence[str] | None = None, target: ModuleType | None = None) -> None:
        if fullname.partition(".")[0] in ABSENT_PACKAGES or fullname in ABSENT_MODULES:
            refuse(fullname)


def install() -> None:
    """Let an import of a module that is absent here end in the clear error."""
    if not any(isinstance(finder, AbsentModuleFinder) for finder in sys.meta_path):
        sys.meta_path.append(AbsentModuleFinder())
