"""What a launch writes."""

from __future__ import annotations

from tests.checks.builders import lines
from tests.exercise.launches import (
    DEAD,
)
from tutor.judge.launch_output import ended_processes, writers, written_by


def test_output_is_attributed_to_its_process() -> None:
    output = lines("[a-1] one\n[INFO] [a-1]: process started with pid [3]\n\x1b[32m[b-2] two\x1b[0m\nplain")
    assert [line.text for line in written_by(output, "a-1")] == ["one"]
    assert [line.text for line in written_by(output, "b-2")] == ["two"]
    assert writers(output) == ["a-1", "b-2"]


def test_ended_processes() -> None:
    output = lines(f"{DEAD}\n[INFO] [talker-1]: process has finished cleanly [pid 11]")
    assert [(each.process, each.code) for each in ended_processes(output)] == [
        ("hearer-2", 1),
        ("talker-1", 0),
    ]
