"""The names of nodes, topics, services and actions on the domain: listed, found by type, and completed on Tab."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from tutor.bundled_ros.ros2 import completion
from tutor.bundled_ros.ros2.domain import Domain, join_domain
from tutor.bundled_ros.ros2.parsing import Argument, argument
from tutor.errors import CommandError, UnknownType

if TYPE_CHECKING:
    from tutor.ros_model import NodeName

NamesAndTypes = Iterable[tuple[str, Sequence[str]]]


def _find_actions(node: Any) -> NamesAndTypes:
    from rclpy.action.graph import get_action_names_and_types

    return get_action_names_and_types(node)


@dataclass(frozen=True, slots=True)
class Names:
    """Topics, services or actions: what verbs on them have in common. `kind` is that of their types."""

    word: str
    kind: str
    example: str
    find_all: Callable[[Any], NamesAndTypes]
    some_are_hidden: bool = True

    def argument(self, name: str = "") -> Argument:
        """Return the argument that names one of them."""
        help_text = f"the {self.word}, such as {self.example}"
        return argument(name or f"{self.word}_name", complete=self.complete, help=help_text)

    def known(self, domain: Domain, *, hidden: bool) -> list[tuple[str, Sequence[str]]]:
        """Return all that are discovered, with their types; hidden ones only if `hidden`."""
        from tutor.ros_model import is_hidden  # late: help and usage errors do not need it

        return [(name, types) for name, types in self.find_all(domain.node) if hidden or not is_hidden(name)]

    def discovered(self, arguments: argparse.Namespace) -> list[tuple[str, Sequence[str]]]:
        """Join the domain, and return all once discovery is complete; hidden ones only with the option for them."""
        with join_domain(arguments) as domain:
            domain.wait_for_discovery()
            return self.known(domain, hidden=self._with_hidden(arguments))

    def types_of(self, domain: Domain, name: str, *, hidden: bool = True) -> Sequence[str] | None:
        """Return the types of one of them; None once discovery is complete without it."""
        return domain.find(lambda: dict(self.known(domain, hidden=hidden)).get(name))

    def complete(self, parsed_args: argparse.Namespace, **_: object) -> list[str]:
        """Complete names."""
        return [name for name, _ in self.discovered(parsed_args)]

    def complete_types(self, parsed_args: argparse.Namespace, **_: object) -> list[str]:
        """Complete types: those of the one that was typed, else all."""
        if name := getattr(parsed_args, f"{self.word}_name", None):
            with join_domain(parsed_args) as domain:
                if types := self.types_of(domain, name):
                    return list(types)
        return completion.types_of_kind(self.kind)()

    def _with_hidden(self, arguments: argparse.Namespace) -> bool:
        return bool(getattr(arguments, "hidden", not self.some_are_hidden))

    # --- verbs ---

    def list_all(self, arguments: argparse.Namespace) -> None:
        """Print the names, and the types if these are asked for; or only how many there are."""
        found = self.discovered(arguments)
        if arguments.count:
            print(len(found))
            return
        for name, types in found:
            print(f"{name} [{', '.join(types)}]" if arguments.show_types else name)

    def list_types(self, arguments: argparse.Namespace) -> int:
        """Print the types of one. Return 1 if there is no such name."""
        with join_domain(arguments) as domain:
            name = getattr(arguments, f"{self.word}_name")
            types = self.types_of(domain, name, hidden=self._with_hidden(arguments))
        for type_name in types or ():
            print(type_name)
        return 0 if types else 1

    def list_of_type(self, arguments: argparse.Namespace) -> None:
        """Print the names of those with exactly this type, or only how many there are."""
        wanted = getattr(arguments, f"{self.word}_type")
        names = [name for name, types in self.discovered(arguments) if wanted in types]
        if arguments.count:
            print(len(names))
            return
        for name in names:
            print(name)


TOPICS = Names("topic", "msg", "/chatter", lambda node: node.get_topic_names_and_types())
SERVICES = Names("service", "srv", "/add", lambda node: node.get_service_names_and_types())
ACTIONS = Names("action", "action", "/fibonacci", _find_actions, some_are_hidden=False)


def nodes(domain: Domain, *, hidden: bool) -> list[NodeName]:
    """Return all discovered nodes, duplicate names included; with `hidden`, also those whose name starts with `_`."""
    from tutor.ros_model import NodeName, is_hidden

    found = [NodeName(name, namespace) for name, namespace in domain.node.get_node_names_and_namespaces()]
    return [node for node in found if hidden or (node.name and not is_hidden(node.name))]


def complete_nodes(parsed_args: argparse.Namespace, **_: object) -> list[str]:
    """Complete the names of nodes."""
    with join_domain(parsed_args) as domain:
        domain.wait_for_discovery()
        return [node.full for node in nodes(domain, hidden=getattr(parsed_args, "include_hidden_nodes", False))]


def full_name(domain: Domain, name: str) -> str:
    """Return a topic's or action's fully qualified name. Raises CommandError for an invalid name."""
    from rclpy.exceptions import InvalidTopicNameException
    from rclpy.expand_topic_name import expand_topic_name
    from rclpy.validate_full_topic_name import validate_full_topic_name

    try:
        full = expand_topic_name(name, domain.node.get_name(), domain.node.get_namespace())
        validate_full_topic_name(full)
    except (ValueError, InvalidTopicNameException) as error:
        raise CommandError(str(error)) from error
    return str(full)


def class_of_type(name: str, kind: str, failed: str) -> Any:
    """Return the class of a type; `kind` is msg, srv or action. Raises CommandError with `failed` if there is none."""
    from tutor.ros.interfaces import find_interface

    try:
        return find_interface(name, kind)
    except UnknownType:
        raise CommandError(failed) from None
