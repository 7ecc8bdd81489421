"""How a launch ends on Ctrl+C, on fabricated launches."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.checks.builders import assert_passed, ending
from tests.exercise.launches import (
    DEAD,
    assert_failed,
    judge_shutdown,
    launched,
    pair,
)
from tutor.judge.verdict import Status


def test_a_clean_shutdown_passes() -> None:
    assert_passed(judge_shutdown(launched(pair("/chatter"), ending=ending())))


def test_a_process_is_left_behind() -> None:
    left = ending()
    object.__setattr__(left, "survivors", ("sleep 1000",))
    assert_failed(judge_shutdown(launched(pair("/chatter"), ending=left)), "process left behind", "sleep 1000")


@pytest.mark.parametrize(("name", "cause"), [("my_launch.py", "does not end"), ("talker.py", "SIGINT ignored")])
def test_a_launch_that_goes_on_is_explained_by_its_programs_only(name: str, cause: str) -> None:
    seen = launched(pair("/chatter"), ending=ending(None, still_running=True))
    assert seen.trace.file == "my_launch.py"
    ignoring = "signal.signal(signal.SIGINT, signal.SIG_IGN)"
    seen = replace(seen, trace=replace(seen.trace, sources={name: ignoring}))
    assert_failed(judge_shutdown(seen), cause)


def test_a_traceback_of_a_node_fails_though_the_launch_exits_cleanly() -> None:
    seen = launched(pair("/chatter"), ending=ending(0, err=DEAD))
    assert judge_shutdown(seen).status is Status.FAILED
