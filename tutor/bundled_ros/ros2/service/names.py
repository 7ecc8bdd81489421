"""Service names and types, and their tab completion."""

from __future__ import annotations

import argparse
from collections.abc import Sequence

from tutor.bundled_ros.ros2.domain import Domain, join_domain
from tutor.ros.interfaces import type_names


def services(domain: Domain, *, hidden: bool) -> list[tuple[str, Sequence[str]]]:
    """Return all discovered services with their types; hidden ones (a name part starts with `_`) only if `hidden`."""
    from rclpy.topic_or_service_is_hidden import topic_or_service_is_hidden

    found = domain.node.get_service_names_and_types()
    return [(name, types) for name, types in found if hidden or not topic_or_service_is_hidden(name)]


def service_names(parsed_args: argparse.Namespace, **_: object) -> list[str]:
    """Complete service names."""
    with join_domain(parsed_args) as domain:
        domain.wait_for_discovery()
        return [name for name, _ in services(domain, hidden=getattr(parsed_args, "include_hidden_services", False))]


def service_types(parsed_args: argparse.Namespace, **_: object) -> list[str]:
    """Complete types: those of the service that was typed, else all."""
    if name := getattr(parsed_args, "service_name", None):
        with join_domain(parsed_args) as domain:
            if types := domain.find(lambda: dict(services(domain, hidden=True)).get(name)):
                return list(types)
    return type_names("srv")


def add_hidden_option(parser: argparse.ArgumentParser) -> None:
    """Add --include-hidden-services, which `ros2 service` itself has as well."""
    parser.add_argument(
        "--include-hidden-services", action="store_true", default=argparse.SUPPRESS, help="hidden services as well"
    )
