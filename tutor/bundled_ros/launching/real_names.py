"""Make every public name of the real packages importable from every module that has it there.

`names.txt` lists these names. Each of the real modules is created on import. It has the names that our module in its
place (`HOMES`) defines; any other name is resolved by its `__getattr__`: to the object itself if another module
has it, else to a stand-in that raises when used.
"""

from __future__ import annotations

import importlib
import sys
from collections.abc import Sequence
from functools import cache, partial
from importlib.abc import Loader
from importlib.machinery import ModuleSpec, PathFinder
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any

from tutor.bundled_ros.launching.launch import errors

_OURS = {
    "launch.base": {
        "launch": (
            "event launch_context launch_description_entity some_entities_type some_substitutions_type substitution"
        ),
    },
    "launch.entities": {
        "launch": "action condition event_handler",
        "launch.conditions": (
            "evaluate_condition_expression_impl if_condition invalid_condition_expression_error "
            "launch_configuration_equals launch_configuration_not_equals unless_condition"
        ),
        "launch.events": "execution_complete",
    },
    "launch.values": {
        "launch.substitutions": "substitution_failure text_substitution",
        "launch.utilities": (
            "class_tools_impl ensure_argument_type_impl normalize_to_list_of_entities_impl "
            "normalize_to_list_of_substitutions_impl perform_substitutions_impl type_utils "
            "visit_all_entities_and_collect_futures_impl"
        ),
    },
    "launch.description": {
        "launch": "invalid_launch_file_error launch_description launch_description_source",
        "launch.launch_description_sources": (
            "any_launch_description_source any_launch_file_utilities frontend_launch_description_source "
            "frontend_launch_file_utilities python_launch_description_source python_launch_file_utilities"
        ),
        "launch_xml.launch_description_sources": "xml_launch_description_source",
        "launch_yaml.launch_description_sources": "yaml_launch_description_source",
    },
    "launch.events": {
        "launch.events": "include_launch_description matchers shutdown",
        "launch.events.process": (
            "process_exited process_io process_started process_stderr process_stdout process_targeted_event "
            "running_process_event shutdown_process signal_process"
        ),
    },
    "launch.handlers": {
        "launch.event_handlers": (
            "event_named on_action_event_base on_execution_complete on_include_launch_description on_shutdown"
        ),
    },
    "launch.lookup": {
        "launch.substitutions": (
            "anon_name command environment_variable file_content find_executable launch_configuration "
            "launch_log_dir local_substitution path_join_substitution this_launch_file this_launch_file_dir"
        ),
    },
    "launch.logic": {
        "launch.substitutions": (
            "boolean_substitution equals_substitution if_else_substitution not_equals_substitution python_expression"
        ),
    },
    "launch.scope": {
        "launch.actions": (
            "append_environment_variable declare_launch_argument pop_environment pop_launch_configurations "
            "push_environment push_launch_configurations reset_environment reset_launch_configurations "
            "set_environment_variable set_launch_configuration unset_environment_variable "
            "unset_launch_configuration"
        ),
    },
    "launch.flow": {
        "launch.actions": (
            "emit_event log_info opaque_coroutine opaque_function register_event_handler shutdown_action timer_action "
            "unregister_event_handler"
        ),
        "launch.events": "timer_event",
    },
    "launch.composition": {"launch.actions": "group_action include_launch_description"},
    "launch.executable": {"launch.descriptions": "executable"},
    "launch.execute_local": {"launch.actions": "execute_local"},
    "launch.execute_process": {
        "launch.actions": "execute_process",
        "launch.event_handlers": "on_process_exit on_process_io on_process_start",
    },
    "launch.introspector": {"launch": "launch_introspector"},
    "launch.logs": {"launch": "logging"},
    "launch.service": {"launch": "launch_service"},
    "launch_ros.substitutions": {"launch_ros.substitutions": "executable_in_package find_package parameter"},
    "launch_ros.parameters": {
        "launch_ros": "parameter_descriptions",
        "launch_ros.utilities": "evaluate_parameters normalize_parameters",
    },
    "launch_ros.names": {"launch_ros.utilities": "namespace_utils normalize_remap_rule"},
    "launch_ros.node": {"launch_ros.actions": "node"},
    "launch_ros.composable": {
        "launch_ros.actions": "composable_node_container load_composable_nodes",
        "launch_ros.descriptions": "composable_node",
    },
    "launch_ros.lifecycle_events": {
        "launch_ros.events.matchers": "matches_node_name",
        "launch_ros.events.lifecycle": "change_state lifecycle_node_matchers state_transition",
    },
    "launch_ros.lifecycle": {
        "launch_ros": "ros_adapters",
        "launch_ros.actions": "lifecycle_node lifecycle_transition",
        "launch_ros.event_handlers": "on_state_transition",
    },
    "launch_ros.settings": {
        "launch_ros.actions": (
            "push_ros_namespace ros_timer set_parameter set_parameters_from_file set_remap set_ros_log_dir "
            "set_use_sim_time"
        ),
    },
}
"""Maps each of our modules to the real ones whose names it defines, grouped by package."""

HOMES = {
    f"{package}.{name}": f"tutor.bundled_ros.launching.{home}"
    for home, packages in _OURS.items()
    for package, names in packages.items()
    for name in names.split()
}
"""Maps each real module to ours. The other real modules only collect names of these, or are not supported."""

_NAMES_FILE = Path(__file__).with_name("names.txt")


def install() -> None:
    """Install the import hook for the real packages' modules, and name what ours define after these."""
    if any(isinstance(finder, _Finder) for finder in sys.meta_path):
        return
    sys.meta_path.insert(0, _Finder())
    for name, home in HOMES.items():
        ours = vars(importlib.import_module(home))
        for public, origin in _modules()[name][1].items():
            defined = ours.get(public)
            if not origin and isinstance(defined, type | FunctionType) and defined.__module__.startswith(__package__):
                defined.__module__ = name  # for tracebacks and pickle


class _Finder:
    """Finds the modules of those real packages that are not installed."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        if fullname not in _modules():
            return None
        spec = PathFinder.find_spec(fullname, path)
        if spec is not None and spec.origin is not None:
            return spec
        return ModuleSpec(fullname, _Loader(), is_package=_modules()[fullname][0])


class _Loader(Loader):
    """Creates a module from its names."""

    def create_module(self, spec: ModuleSpec) -> ModuleType | None:
        return None

    def exec_module(self, module: ModuleType) -> None:
        is_package, names = _modules()[module.__name__]
        module.__file__ = str(_NAMES_FILE)
        module.__getattr__ = partial(_resolve, module.__name__)  # type: ignore[method-assign]
        vars(module)["__dir__"] = lambda: [*vars(module), *names]  # for "Did you mean"
        if (home := HOMES.get(module.__name__)) is not None:
            ours = vars(importlib.import_module(home))
            module.__doc__, module.__file__ = ours["__doc__"], ours["__file__"]
            own = {name for name, origin in names.items() if not origin.startswith("launch")}
            vars(module).update({name: ours[name] for name in own if name in ours})
        vars(module)["__all__"] = sorted(name for name, origin in names.items() if is_package or not origin)
        for name, origin in names.items():
            if origin == f"{module.__name__}.{name}:{name}":
                # Now, lest the import of the submodule of this name hide what it defines.
                vars(module)[name] = getattr(importlib.import_module(f"{module.__name__}.{name}"), name)


def _resolve(module: str, name: str) -> Any:
    origin = _modules()[module][1].get(name)
    if origin is None and f"{module}.{name}" in _modules():
        return importlib.import_module(f"{module}.{name}")
    if origin is None or name.startswith("_"):
        raise AttributeError(f"module {module!r} has no attribute {name!r}")
    if not origin:
        return _stand_in(f"{module}.{name}")
    source, _, attribute = origin.partition(":")
    if not attribute:
        return _import_or_stand_in(source)
    if source == module:
        return _import_or_stand_in(f"{module}.{name}")
    found = _import_or_stand_in(source)
    if isinstance(found, ModuleType):
        try:
            return getattr(found, attribute)
        except AttributeError:
            return _import_or_stand_in(f"{source}.{attribute}")
    return found


def _import_or_stand_in(module: str) -> Any:
    try:
        return importlib.import_module(module)
    except ImportError:  # something outside launch that is not installed
        return _stand_in(module)


@cache
def _stand_in(what: str) -> type:
    return errors.stand_in(what)


@cache
def _modules() -> dict[str, tuple[bool, dict[str, str]]]:
    """Map each module to whether it is a package, and to its names with their origins."""
    modules: dict[str, tuple[bool, dict[str, str]]] = {}
    names: dict[str, str] = {}
    for line in _NAMES_FILE.read_text(encoding="utf-8").splitlines():
        if line.startswith("#"):
            continue
        name, _, rest = line.strip().partition(" ")
        if line.startswith(" "):
            names[name] = rest
        else:
            names = {}
            modules[name] = (rest == "package", names)
    return modules
