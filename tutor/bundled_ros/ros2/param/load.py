"""`ros2 param load`."""

from __future__ import annotations

import argparse
from typing import Any

from tutor.bundled_ros.ros2.param.client import add_node_arguments, add_timeout, parameter_client, print_results
from tutor.bundled_ros.ros2.yaml_input import yaml_problem
from tutor.errors import CommandError


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """[--no-use-wildcard] NODE FILE."""
    add_node_arguments(parser)
    parser.add_argument("parameter_file", help="a YAML file of parameters, as `ros2 param dump` makes it")
    parser.add_argument("--no-use-wildcard", action="store_true", help="leave out what the file has for all nodes, /**")
    add_timeout(parser)


def main(arguments: argparse.Namespace) -> None:
    """Set the parameters in the file. Rejections go to stderr, and the exit code is still 0."""
    with parameter_client(arguments) as node:
        parameters = _read_parameters(arguments.parameter_file, wildcard=not arguments.no_use_wildcard)
        results = node.set(parameters)
    texts = (f"Set parameter {each.name} successful|Set parameter {each.name} failed" for each in parameters)
    print_results(list(zip(texts, results, strict=True)))


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
