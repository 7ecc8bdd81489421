"""`ros2 param set`, `delete` and `load`."""

from __future__ import annotations

import argparse
import sys
from typing import Any

from tutor.bundled_ros.ros2.param.client import NODE, TIMEOUT, complete_parameters, parameter_client
from tutor.bundled_ros.ros2.parsing import Verb, argument, flag
from tutor.bundled_ros.ros2.yaml_input import yaml_problem
from tutor.errors import CommandError


def _set(arguments: argparse.Namespace) -> None:
    """Set the parameter. If the node rejects that, its reason goes to stderr, and the exit code is still 0."""
    from rcl_interfaces.msg import Parameter
    from rclpy.parameter import get_parameter_value

    parameter = Parameter(name=arguments.parameter_name, value=get_parameter_value(arguments.value))
    with parameter_client(arguments) as node:
        results = node.set([parameter])
    _print_result("Set parameter successful", "Setting parameter failed", results[0])


def _delete(arguments: argparse.Namespace) -> None:
    """Delete the parameter. If the node rejects that, its reason goes to stderr, and the exit code is still 0."""
    from rcl_interfaces.msg import Parameter

    with parameter_client(arguments) as node:
        results = node.set([Parameter(name=arguments.parameter_name)])  # a value of type NOT_SET deletes the parameter
    _print_result("Deleted parameter successfully", "Deleting parameter failed", results[0])


def _load(arguments: argparse.Namespace) -> None:
    """Set the parameters in the file. Rejections go to stderr, and the exit code is still 0."""
    with parameter_client(arguments) as node:
        parameters = _read_parameters(arguments.parameter_file, wildcard=not arguments.no_use_wildcard)
        results = node.set(parameters)
    for parameter, result in zip(parameters, results, strict=True):
        _print_result(f"Set parameter {parameter.name} successful", f"Set parameter {parameter.name} failed", result)


def _read_parameters(file: str, *, wildcard: bool) -> list[Any]:
    import yaml
    from rclpy.parameter import parameter_dict_from_yaml_file

    try:
        return list(parameter_dict_from_yaml_file(file, wildcard).values())
    except OSError as error:
        raise CommandError(f"{file} cannot be read: {error.strerror or error}") from error
    except (RuntimeError, UnicodeDecodeError) as error:
        raise CommandError(str(error)) from error
    except yaml.YAMLError as error:
        raise CommandError(f"{file} is not YAML: {yaml_problem(error)}") from error
    except (TypeError, AttributeError, ValueError) as error:  # not a mapping of node names
        raise CommandError(f"{file} is not a parameter file: it has no node with ros__parameters") from error


def _print_result(success: str, failure: str, result: Any) -> None:
    """Print the outcome of a change (a SetParametersResult): a success to stdout, a rejection to stderr."""
    reason = f": {result.reason}" if result.reason else ""
    print((success if result.successful else failure) + reason, file=sys.stdout if result.successful else sys.stderr)


_PARAMETER = argument("parameter_name", complete=complete_parameters, help="the parameter")
GRAMMAR = {
    "delete": Verb(_delete, *NODE, _PARAMETER, TIMEOUT),
    "load": Verb(
        _load,
        *NODE,
        argument("parameter_file", help="a YAML file of parameters, as `ros2 param dump` makes it"),
        flag("--no-use-wildcard", help="leave out what the file has for all nodes, /**"),
        TIMEOUT,
    ),
    "set": Verb(
        _set,
        *NODE,
        _PARAMETER,
        argument("value", help="its new value, as YAML: 5.0 is a double, 5 an integer, true a boolean"),
        TIMEOUT,
    ),
}
