"""The command table. That every command has a handler is shown in test_navigation, where the app is open."""

from __future__ import annotations

from tutor.tui.commands import BY_NAME, GROUPS


def test_command_names_are_unique() -> None:
    assert len(BY_NAME) == sum(len(group) for _, group in GROUPS)
