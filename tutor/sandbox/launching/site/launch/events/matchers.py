"""Matchers for events that are meant for one action."""

from __future__ import annotations

from collections.abc import Callable

from ..action import Action


def matches_action(target_action: Action) -> Callable[[Action], bool]:
    """True for this action and no other."""
    return lambda action: action is target_action
