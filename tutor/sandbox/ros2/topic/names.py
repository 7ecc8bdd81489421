"""Topics by name, and what Tab offers for them."""

from __future__ import annotations

import argparse
from collections.abc import Sequence

from tutor.sandbox.ros2.joining import Domain, joined


def topics(domain: Domain, *, hidden: bool) -> list[tuple[str, Sequence[str]]]:
    """All topics that are seen, with their types; `hidden`: also those with a part that starts with `_`."""
    from rclpy.topic_or_service_is_hidden import topic_or_service_is_hidden

    found = domain.node.get_topic_names_and_types()
    return [(name, types) for name, types in found if hidden or not topic_or_service_is_hidden(name)]


def topic_names(prefix: str, parsed_args: argparse.Namespace, **_: object) -> list[str]:
    """The topics that Tab offers."""
    with joined(parsed_args) as domain:
        domain.complete()
        return [name for name, _ in topics(domain, hidden=getattr(parsed_args, "include_hidden_topics", False))]
