"""The message class of a topic, found from the publishers and subscriptions that are there."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import Any

from tutor.bundled_ros.ros2.domain import Domain
from tutor.bundled_ros.ros2.names import TOPICS, class_of_type, full_name
from tutor.errors import CommandError

_GRAPH_POLL_S = 0.05


def message_class(domain: Domain, topic: str) -> Any:
    """Return the message class of a topic; None once discovery is complete without such a topic.

    Raises CommandError for an invalid name, a topic with several types, or a type that is not installed.
    """
    types = TOPICS.types_of(domain, full_name(domain, topic))
    return None if types is None else _single_class(topic, types)


def wait_for_class(domain: Domain, topic: str) -> Any:
    """Like `message_class`, but warn once and wait if the topic does not exist yet."""
    if (found := message_class(domain, topic)) is not None:
        return found
    warn_not_published(topic)
    full = full_name(domain, topic)
    while (types := dict(TOPICS.known(domain, hidden=True)).get(full)) is None:
        time.sleep(_GRAPH_POLL_S)
    return _single_class(topic, types)


def named_class(name: str) -> Any:
    """Return the class of a message type that the user named. Raises CommandError."""
    return class_of_type(name, "msg", "The passed message type is invalid")


def warn_not_published(topic: str) -> None:
    """Warn that there is no such topic yet."""
    print(f"WARNING: topic [{topic}] does not appear to be published yet")


def _single_class(topic: str, types: Sequence[str]) -> Any:
    if len(types) > 1:
        raise CommandError(f"Cannot echo topic '{topic}', as it contains more than one type: [{', '.join(types)}]")
    return class_of_type(types[0], "msg", f"The message type '{types[0]}' is invalid")
