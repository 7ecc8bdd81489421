"""Action names and types, and their tab completion."""

from __future__ import annotations

import argparse
from collections.abc import Sequence

from tutor.bundled_ros.ros2.domain import Domain, join_domain
from tutor.ros.interfaces import type_names


def actions(domain: Domain) -> list[tuple[str, Sequence[str]]]:
    """Return all discovered actions with their types."""
    from rclpy.action.graph import get_action_names_and_types

    return list(get_action_names_and_types(domain.node))


def action_names(parsed_args: argparse.Namespace, **_: object) -> list[str]:
    """Complete action names."""
    with join_domain(parsed_args) as domain:
        domain.wait_for_discovery()
        return [name for name, _ in actions(domain)]


def action_types(parsed_args: argparse.Namespace, **_: object) -> list[str]:
    """Complete types: those of the action that was typed, else all."""
    if name := getattr(parsed_args, "action_name", None):
        with join_domain(parsed_args) as domain:
            if types := domain.find(lambda: dict(actions(domain)).get(name)):
                return list(types)
    return type_names("action")
