"""Launch files in XML and YAML: read as entities, which are turned into the same actions that Python files make."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree

import yaml

from ..launch_description import LaunchDescription
from .actions import make_action
from .entities import Entity, XmlEntity, YamlEntity
from .text import parse_substitution

__all__ = ["load_launch_description", "parse_substitution", "suffixes"]
XML = ("launch.xml", "xml", "launch")
YAML = ("launch.yaml", "launch.yml", "yaml", "yml", "launch")


def suffixes(path: str) -> list[str]:
    """The kinds of launch file that the name says it may be: "xml", "yaml"."""
    kinds = {"xml": XML, "yaml": YAML}
    return [kind for kind, ends in kinds.items() if any(path.endswith(f".{end}") for end in ends)]


def load_launch_description(path: str) -> LaunchDescription:
    """The launch description; raises what is wrong with the file, of the kinds that its name allows the first."""
    errors: list[Exception] = []
    for kind in suffixes(path) or ["xml", "yaml"]:
        try:
            root = _ROOTS[kind](path)
        except (ElementTree.ParseError, yaml.YAMLError, ValueError) as error:
            errors.append(error)
        else:
            return _describe(root)
    raise errors[0]


def _describe(root: Entity) -> LaunchDescription:
    if root.type_name != "launch":
        raise RuntimeError("Expected 'launch' as root tag")
    importlib.import_module("launch_ros._frontend")  # the tags that know ROS
    deprecated = root.find("deprecated")
    return LaunchDescription([make_action(child) for child in root.children], deprecated_reason=deprecated)


def _xml(path: str) -> Entity:
    return XmlEntity(ElementTree.parse(path).getroot())


def _yaml(path: str) -> Entity:
    tree = yaml.safe_load(Path(path).read_text(encoding="utf-8"))
    if not isinstance(tree, dict) or len(tree) != 1:
        raise ValueError("Expected only one root")
    return YamlEntity(*next(iter(tree.items())))


_ROOTS: dict[str, Callable[[str], Entity]] = {"xml": _xml, "yaml": _yaml}
