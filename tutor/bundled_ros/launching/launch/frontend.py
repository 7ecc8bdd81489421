"""XML and YAML launch files: their elements and keys as entities, and the registry of what each entity becomes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import yaml

from tutor.bundled_ros.launching.launch.entities import Action
from tutor.bundled_ros.launching.launch.values import SCALARS, coerce_to_type, extract_type

XML = ("launch.xml", "xml", "launch")
YAML = ("launch.yaml", "launch.yml", "yaml", "yml", "launch")


def suffixes(path: str) -> list[str]:
    """Return the formats, "xml" or "yaml", that a file may have according to its name."""
    kinds = {"xml": XML, "yaml": YAML}
    return [kind for kind, ends in kinds.items() if any(path.endswith(f".{end}") for end in ends)]


def read(path: str) -> Entity:
    """Return a file's root entity. If no format fits, raises the error of the first one that its name allows."""
    errors: list[Exception] = []
    for kind in suffixes(path) or ["xml", "yaml"]:
        try:
            root = _read_xml(path) if kind == "xml" else _read_yaml(path)
        except (ElementTree.ParseError, yaml.YAMLError, ValueError) as error:
            errors.append(error)
        else:
            if root.type_name != "launch":
                raise RuntimeError("Expected 'launch' as root tag")
            return root
    raise errors[0]


def _read_xml(path: str) -> Entity:
    return XmlEntity(ElementTree.parse(path).getroot())


def _read_yaml(path: str) -> Entity:
    tree = yaml.safe_load(Path(path).read_text(encoding="utf-8"))
    if not isinstance(tree, dict) or len(tree) != 1:
        raise ValueError("Expected only one root")
    return YamlEntity(*next(iter(tree.items())))


class Entity:
    """One entity. It records which attributes and children were queried, so that unknown ones can be reported."""

    def __init__(self, type_name: str) -> None:
        self.type_name = type_name
        self._queried: set[str] = set()

    @property
    def children(self) -> Sequence[Entity]:
        """All child entities."""
        raise NotImplementedError

    def find(self, name: str, data_type: Any = str) -> Any:
        """Return an attribute converted to a type (None: the type that YAML gives it), or as its text; None if missing.

        Raises TypeError for a value of another type.
        """
        raise NotImplementedError

    def get(self, name: str, data_type: Any = str) -> Any:
        """Return a required attribute. Raises AttributeError if it is missing."""
        value = self.find(name, data_type)
        if value is None:
            raise AttributeError(f"Attribute '{name}' of type '{data_type}' not found in Entity '{self.type_name}'")
        return value

    def children_named(self, name: str) -> Sequence[Entity]:
        """Return the child entities with this name."""
        raise NotImplementedError

    def reject_unknown(self) -> None:
        """Raise ValueError if the entity has attributes or children that were never queried."""
        raise NotImplementedError


class XmlEntity(Entity):
    """An XML element."""

    def __init__(self, element: ElementTree.Element) -> None:
        super().__init__(element.tag)
        self._element = element

    @property
    def children(self) -> Sequence[Entity]:
        self._queried.update(f"<{item.tag}>" for item in self._element)
        return [XmlEntity(item) for item in self._element]

    def find(self, name: str, data_type: Any = str) -> Any:
        text = self._element.attrib.get(name)
        self._queried.update((name, f"{name}-sep"))
        if text is None:
            return None
        separator = self._element.attrib.get(f"{name}-sep")
        if separator is None:
            return _coerce(text, data_type)
        item_type = None if data_type is None else extract_type(data_type)[0]
        return [_coerce(item, item_type) for item in text.split(separator)]

    def children_named(self, name: str) -> Sequence[Entity]:
        self._queried.add(f"<{name}>")
        return [XmlEntity(item) for item in self._element if item.tag == name]

    def reject_unknown(self) -> None:
        tags = {item.tag for item in self._element if f"<{item.tag}>" not in self._queried}
        if tags:
            raise ValueError(f"Unexpected nested tag(s) found in `{self.type_name}`: {tags}")
        attributes = set(self._element.attrib) - self._queried
        if attributes:
            raise ValueError(f"Unexpected attribute(s) found in `{self.type_name}`: {attributes}")


class YamlEntity(Entity):
    """The value of a YAML key: a mapping or a list of entities."""

    def __init__(self, type_name: str, value: Any) -> None:
        super().__init__(type_name)
        self._value = value

    @property
    def children(self) -> Sequence[Entity]:
        self._queried.add("children")
        items = self._value
        if isinstance(items, dict):
            if "children" not in items:
                raise ValueError(f"Expected entity `{self.type_name}` to have children entities")
            items = items["children"]
        if not isinstance(items, list):
            raise TypeError(f"Expected a list of entities in `{self.type_name}`, got {type(items)}")
        for item in items:
            if not isinstance(item, dict) or len(item) != 1:
                raise RuntimeError("Subentities must be a dictionary with only one key, which is the entity type")
        return [YamlEntity(*next(iter(item.items()))) for item in items]

    def find(self, name: str, data_type: Any = str) -> Any:
        self._queried.add(name)
        value = self._mapping.get(name)
        if value is not None and not _has_type(value, data_type):
            raise TypeError(
                f"Attribute '{name}' of Entity '{self.type_name}' expected to be of type '{data_type}', "
                f"got '{type(value)}'"
            )
        return value

    def children_named(self, name: str) -> Sequence[Entity]:
        self._queried.add(name)
        items = self._mapping.get(name)
        if items is None:
            return []
        if not isinstance(items, list) or not all(isinstance(item, dict) for item in items):
            raise TypeError(f"Attribute '{name}' of Entity '{self.type_name}' expected to be a list of dictionaries.")
        return [YamlEntity(name, item) for item in items]

    @property
    def _mapping(self) -> dict[str, Any]:
        return self._value if isinstance(self._value, dict) else {}

    def reject_unknown(self) -> None:
        if isinstance(self._value, list) and "children" not in self._queried:
            raise ValueError(f"Unexpected nested entity(ies) found in `{self.type_name}`: {self._value}")
        unknown = set(self._mapping) - self._queried
        if unknown:
            raise ValueError(f"Unexpected key(s) found in `{self.type_name}`: {unknown}")


def _coerce(text: str, data_type: Any) -> Any:
    """Convert a text to a type; keep the text if that fails, since it may contain substitutions."""
    try:
        return coerce_to_type(text, data_type) if text else text
    except ValueError:
        return text


def _has_type(value: Any, data_type: Any) -> bool:
    if data_type is None:
        items = value if isinstance(value, list) else [value]
        return all(isinstance(item, SCALARS) for item in items)
    scalar, is_list = extract_type(data_type)
    if is_list:
        return isinstance(value, list) and all(isinstance(item, str | scalar) for item in value)
    return isinstance(value, str | scalar)


ACTIONS: dict[str, Callable[[Entity], Action]] = {}
"""The function that turns an entity into an action, by the entity's name. The modules that define the tags fill it."""


def make_action(entity: Entity) -> Action:
    """Turn an entity into an action. Raises if the entity is invalid."""
    name = entity.type_name
    if name not in ACTIONS:
        raise RuntimeError(f"Unrecognized entity of the type: {name}")
    made = ACTIONS[name](entity)
    entity.reject_unknown()
    return made


def make_children(entity: Entity) -> list[Action]:
    """Return the actions of all child entities."""
    return [make_action(child) for child in entity.children]
