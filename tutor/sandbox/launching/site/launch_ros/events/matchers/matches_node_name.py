"""Picks by the node's name."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any


def matches_node_name(node_name: str) -> Callable[[Any], bool]:
    """True for the action whose node has this name; without a slash it is one in the root namespace."""
    full = node_name if node_name.startswith("/") else f"/{node_name}"
    return lambda action: bool(action.node_name == full)
