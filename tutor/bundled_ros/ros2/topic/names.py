"""Topic names and types, and their tab completion."""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence
from typing import Any

from tutor.bundled_ros.ros2.domain import Domain, join_domain
from tutor.errors import CommandError, UnknownType
from tutor.ros.interfaces import find_interface

_GRAPH_POLL_S = 0.05


def topics(domain: Domain, *, hidden: bool) -> list[tuple[str, Sequence[str]]]:
    """Return all discovered topics with their types; hidden ones (a name part starts with `_`) only if `hidden`."""
    from rclpy.topic_or_service_is_hidden import topic_or_service_is_hidden

    found = domain.node.get_topic_names_and_types()
    return [(name, types) for name, types in found if hidden or not topic_or_service_is_hidden(name)]


def topic_names(prefix: str, parsed_args: argparse.Namespace, **_: object) -> list[str]:
    """Complete topic names."""
    with join_domain(parsed_args) as domain:
        domain.wait_for_discovery()
        return [name for name, _ in topics(domain, hidden=getattr(parsed_args, "include_hidden_topics", False))]


def full_name(domain: Domain, topic: str) -> str:
    """Return a topic's fully qualified name. Raises CommandError for an invalid name."""
    from rclpy.exceptions import InvalidTopicNameException
    from rclpy.expand_topic_name import expand_topic_name
    from rclpy.validate_full_topic_name import validate_full_topic_name

    try:
        full = expand_topic_name(topic, domain.node.get_name(), domain.node.get_namespace())
        validate_full_topic_name(full)
    except (ValueError, InvalidTopicNameException) as error:
        raise CommandError(str(error)) from error
    return str(full)


def message_class(domain: Domain, topic: str) -> Any:
    """Return the message class of a topic; None once discovery is complete without such a topic.

    Raises CommandError for an invalid name, a topic with several types, or a type that is not installed.
    """
    full = full_name(domain, topic)
    types = domain.find(lambda: dict(topics(domain, hidden=True)).get(full))
    return None if types is None else _single_class(topic, types)


def wait_for_class(domain: Domain, topic: str) -> Any:
    """Like `message_class`, but warn once and wait if the topic does not exist yet."""
    if (found := message_class(domain, topic)) is not None:
        return found
    warn_not_published(topic)
    full = full_name(domain, topic)
    while (types := dict(topics(domain, hidden=True)).get(full)) is None:
        time.sleep(_GRAPH_POLL_S)
    return _single_class(topic, types)


def _single_class(topic: str, types: Sequence[str]) -> Any:
    if len(types) > 1:
        raise CommandError(f"Cannot echo topic '{topic}', as it contains more than one type: [{', '.join(types)}]")
    try:
        return find_interface(types[0], "msg")
    except UnknownType:
        raise CommandError(f"The message type '{types[0]}' is invalid") from None


def class_of_type(name: str) -> Any:
    """Return the class of a message type that the user named. Raises CommandError."""
    try:
        return find_interface(name, "msg")
    except UnknownType:
        raise CommandError("The passed message type is invalid") from None


def warn_not_published(topic: str) -> None:
    """Warn that there is no such topic yet."""
    print(f"WARNING: topic [{topic}] does not appear to be published yet")
