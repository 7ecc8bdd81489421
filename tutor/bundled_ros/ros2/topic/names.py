"""Topics by name, and what Tab offers for them."""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence
from typing import Any

from tutor.bundled_ros.ros2.domain import Domain, join_domain
from tutor.bundled_ros.ros2.interfaces import UnknownInterface, find_interface
from tutor.errors import CommandError

_LOOK_AGAIN_S = 0.05


def topics(domain: Domain, *, hidden: bool) -> list[tuple[str, Sequence[str]]]:
    """All topics that are seen, with their types; `hidden`: also those with a part that starts with `_`."""
    from rclpy.topic_or_service_is_hidden import topic_or_service_is_hidden

    found = domain.node.get_topic_names_and_types()
    return [(name, types) for name, types in found if hidden or not topic_or_service_is_hidden(name)]


def topic_names(prefix: str, parsed_args: argparse.Namespace, **_: object) -> list[str]:
    """The topics that Tab offers."""
    with join_domain(parsed_args) as domain:
        domain.complete()
        return [name for name, _ in topics(domain, hidden=getattr(parsed_args, "include_hidden_topics", False))]


def full_name(domain: Domain, topic: str) -> str:
    """A topic's name with its namespace. Raises CommandError for a name that no topic can have."""
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
    """The class of the messages on a topic; None where all that is there has been seen, and no such topic is.

    Raises CommandError for a name that no topic can have, a topic of several types, and a type that is not here.
    """
    full = full_name(domain, topic)
    types = domain.find(lambda: dict(topics(domain, hidden=True)).get(full))
    return None if types is None else _class_of(topic, types)


def wait_for_class(domain: Domain, topic: str) -> Any:
    """As `message_class`, but waits for the topic, and says so once."""
    if (found := message_class(domain, topic)) is not None:
        return found
    warn_of_no_publisher(topic)
    full = full_name(domain, topic)
    while (types := dict(topics(domain, hidden=True)).get(full)) is None:
        time.sleep(_LOOK_AGAIN_S)
    return _class_of(topic, types)


def _class_of(topic: str, types: Sequence[str]) -> Any:
    if len(types) > 1:
        raise CommandError(f"Cannot echo topic '{topic}', as it contains more than one type: [{', '.join(types)}]")
    try:
        return find_interface(types[0], "msg")
    except UnknownInterface:
        raise CommandError(f"The message type '{types[0]}' is invalid") from None


def warn_of_no_publisher(topic: str) -> None:
    """Say that there is no such topic as yet."""
    print(f"WARNING: topic [{topic}] does not appear to be published yet")
