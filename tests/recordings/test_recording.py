"""A recording holds what judges got, so that they can be asked again without ROS."""

from __future__ import annotations

from pathlib import Path

from tests.recordings.recording import JudgeCall, Outcome, Recording, read, write
from tutor.judge.trace import Trace


def test_facts_of_every_kind_are_read_back(tmp_path: Path) -> None:
    trace = Trace("node.py")
    calls = (
        JudgeCall("rate", "", (trace, None)),
        JudgeCall("launch-validation", "", (trace, (Trace("node.py"), Trace("node.py")))),
        JudgeCall("atomic", "a_scenario", ((),)),
    )
    recording = Recording("i2.1/wrong/made", calls, {"rate": Outcome("failed", "wrong-rate", "why", "step")})
    assert read(write(recording, tmp_path)) == recording


def test_facts_that_calls_share_are_one_object_again(tmp_path: Path) -> None:
    trace = Trace("node.py")
    recording = Recording("i2.1/right/made", (JudgeCall("a", "", (trace,)), JudgeCall("b", "", (trace,))))
    first, second = read(write(recording, tmp_path)).calls
    assert first.facts[0] is second.facts[0]
