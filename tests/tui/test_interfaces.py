"""The app builds the message types that a learner defines, and says what is wrong with them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tests.interfaces.packages import write_package
from tutor.session import Session
from tutor.tui.model import AppModel


async def test_a_definition_that_cannot_be_built_is_said_as_soon_as_it_is_saved(
    learner: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    async with learner((120, 36)) as me:
        await me.sees("Objective")
        write_package(me.session.workspace.root, {"msg/Ding.msg": "double volume\n"})
        await me.sees("bell_interfaces is not built", "msg/Ding.msg:1", "it is float64")


def test_r_runs_a_program_even_while_a_definition_is_shown(session: Session) -> None:
    lesson = session.course.find("b1.3")
    files = [file.name for file in lesson.files]
    model = AppModel(session, lesson)
    programs = {}
    for model.file_index, shown in enumerate(files):
        programs[shown] = model.program.name
    assert programs == dict.fromkeys(files, "tank_sensor.py")
    client = AppModel(session, session.course.find("i1.3"), file_index=1)
    assert client.program == client.file
