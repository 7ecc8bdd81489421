"""Services by name, and what Tab offers for them."""

from __future__ import annotations

import argparse
from collections.abc import Sequence

from tutor.sandbox.ros2.interfaces import interfaces
from tutor.sandbox.ros2.joining import Domain, joined


def services(domain: Domain, *, hidden: bool) -> list[tuple[str, Sequence[str]]]:
    """All services that are seen, with their types; `hidden`: also those with a part that starts with `_`."""
    from rclpy.topic_or_service_is_hidden import topic_or_service_is_hidden

    found = domain.node.get_service_names_and_types()
    return [(name, types) for name, types in found if hidden or not topic_or_service_is_hidden(name)]


def service_names(parsed_args: argparse.Namespace, **_: object) -> list[str]:
    """The services that Tab offers."""
    with joined(parsed_args) as domain:
        domain.complete()
        return [name for name, _ in services(domain, hidden=getattr(parsed_args, "include_hidden_services", False))]


def service_types(parsed_args: argparse.Namespace, **_: object) -> list[str]:
    """The types that Tab offers: those of the service that was named, else all."""
    if name := getattr(parsed_args, "service_name", None):
        with joined(parsed_args) as domain:
            if types := domain.find(lambda: dict(services(domain, hidden=True)).get(name)):
                return list(types)
    return [f"{package}/{name}" for package, names in interfaces().items() for name in names if name.startswith("srv/")]


def add_hidden(parser: argparse.ArgumentParser) -> None:
    """The option that `ros2 service` itself has, too."""
    parser.add_argument(
        "--include-hidden-services", action="store_true", default=argparse.SUPPRESS, help="hidden services as well"
    )
