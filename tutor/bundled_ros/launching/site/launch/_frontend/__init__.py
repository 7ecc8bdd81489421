"""XML and YAML launch files: they are read as entities and turned into the same actions as in Python files."""

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
    """Return the formats, "xml" or "yaml", that a file may have according to its name."""
    kinds = {"xml": XML, "yaml": YAML}
    return [kind for kind, ends in kinds.items() if any(path.endswith(f".{end}") for end in ends)]


def load_launch_description(path: str) -> LaunchDescription:
    """Load a launch description. If no format fits, raises the error of the first one that the file's name allows."""
    errors: list[Exception] = []
    for kind in suffixes(path) or ["xml", "yaml"]:
        try:
            root = _READERS[kind](path)
        except (ElementTree.ParseError, yaml.YAMLError, ValueError) as error:
            errors.append(error)
        else:
            return _to_description(root)
    raise errors[0]


def _to_description(root: Entity) -> LaunchDescription:
    if root.type_name != "launch":
        raise RuntimeError("Expected 'launch' as root tag")
    importlib.import_module("launch_ros._frontend")  # registers the ROS tags
    deprecated = root.find("deprecated")
    return LaunchDescription([make_action(child) for child in root.children], deprecated_reason=deprecated)


def _read_xml(path: str) -> Entity:
    return XmlEntity(ElementTree.parse(path).getroot())


def _read_yaml(path: str) -> Entity:
    tree = yaml.safe_load(Path(path).read_text(encoding="utf-8"))
    if not isinstance(tree, dict) or len(tree) != 1:
        raise ValueError("Expected only one root")
    return YamlEntity(*next(iter(tree.items())))


_READERS: dict[str, Callable[[str], Entity]] = {"xml": _read_xml, "yaml": _read_yaml}
