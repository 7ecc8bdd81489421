"""The command table."""

from __future__ import annotations

from typing import Any

from tutor.tui.commands import BY_NAME, GROUPS, all_commands


async def test_every_command_has_a_handler(learner: Any) -> None:
    async with learner() as me:
        assert {me.main.can(command) for command in all_commands()} == {True, False}


def test_command_names_are_unique() -> None:
    assert len(BY_NAME) == sum(len(group) for _, group in GROUPS)
