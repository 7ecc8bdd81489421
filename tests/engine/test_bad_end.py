"""A crash at exit may be chance, so the program is restarted: one crash is forgiven, a repeated one fails."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass
from pathlib import Path

import pytest

from tests.engine.helpers import FILE, Scene
from tutor.content import load_course
from tutor.engine.explanation import explain
from tutor.engine.loading import load_check
from tutor.judge import ending
from tutor.judge.bench import Bench
from tutor.judge.check import Check
from tutor.judge.ending import judge_ending, repeat_chance_failures
from tutor.judge.submission import Submission
from tutor.judge.trace import Ending, Trace
from tutor.judge.verdict import Verdict
from tutor.workspace import solution

# Appended to a program, to crash as rclpy's C++ code may after shutdown. `{}`: the runs (from 1) that crash, the code
# that these runs execute, and the code that every run executes at its very end.
CRASHES = """
import os, pathlib, signal
def spin_on():
    import rclpy
    from rclpy.executors import SingleThreadedExecutor
    context = rclpy.Context()
    context.init()
    executor = SingleThreadedExecutor(context=context)
    context.shutdown()
    executor.spin_once()
def try_shutdown():
    raise RuntimeError("failed to shutdown: rcl_shutdown already called on the given context")
ends = pathlib.Path(__file__).with_name("ends")
with ends.open("a") as file:
    file.write(".")
if len(ends.read_text()) in {}:
    {}
{}
"""
CRASH = "os.kill(os.getpid(), signal.SIGSEGV)"
SPIN_ON = "spin_on()"
RACE = "try_shutdown()"
# By chance it raises, as `try_shutdown` above does, and the code appended to the file would not run.
TRIES = "rclpy.try_shutdown()"
TRIES_SAFELY = "with __import__('contextlib').suppress(RuntimeError): rclpy.try_shutdown()"
SCENARIOS = [
    ("i1.1", "shutdown"),
    ("i1.2", "shutdown"),
    ("i1.3", "shutdown"),
    ("i2.1", "shutdown"),
    ("i2.3", "shutdown"),
    ("i2.3", "shutdown-busy"),
]
"""The criteria whose first scenario ends with Ctrl+C."""


# For what does not depend on the scenario: a program that needs no ROS until it crashes.
ENDS_ON_CTRL_C = """
import threading
print("up", flush=True)
try:
    threading.Event().wait()
except KeyboardInterrupt:
    pass
"""


@dataclass(frozen=True)
class Interrupted:
    """The facts of `press_ctrl_c`."""

    trace: Trace
    ending: Ending | None


@repeat_chance_failures
async def press_ctrl_c(bench: Bench) -> Interrupted:
    """Press Ctrl+C once the program is up."""
    async with bench.start(FILE) as run:
        assert await run.until(lambda: bool(run.output), 20.0), run.trace()
        trace = run.trace()
        return Interrupted(trace, await run.interrupt())


async def judge_interrupted(scene: Scene, crashing_runs: tuple[int, ...], code: str, always: str = "") -> Verdict:
    """Judge how the program ends that runs `code` at the end of these runs (from 1)."""
    facts = await press_ctrl_c(scene.bench(ENDS_ON_CTRL_C + CRASHES.format(crashing_runs, code, always)))
    return explain(judge_ending(facts.trace, facts.ending, shown_by="another"), Check("h1.1", ()))


def count_starts(folder: Path) -> int:
    return len((folder / "ends").read_text())


async def test_a_single_crash_is_forgiven_in_each_scenario_that_ends_with_ctrl_c(
    scene: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    # One repetition shows that a scenario is repeated. How often that happens does not depend on the scenario.
    monkeypatch.setattr(ending, "_MAX_RETRIES", 1)

    async def check_one(folder: Path, exercise: str, name: str) -> None:
        folder.mkdir()
        files = {}
        for file, path in solution(load_course().find(exercise)).files.items():
            text = path.read_text()
            assert text.count(TRIES) == 1, path
            files[file] = folder / file
            files[file].write_text(text.replace(TRIES, TRIES_SAFELY) + CRASHES.format((1,), CRASH, ""))
        bench = scene.bench_of(Submission(exercise, files))
        check = load_check(load_course().find(exercise))
        scenario = next(each.facts[0] for each in check.criteria if each.id == name)
        facts = await scenario(bench)
        verdict = judge_ending(facts.trace, facts.ending, shown_by="another")
        assert verdict.passed, (exercise, name, verdict)
        assert count_starts(folder) == 2, (exercise, name)  # the crash, and a repetition

    async with asyncio.TaskGroup() as group:
        for exercise, name in SCENARIOS:
            group.create_task(check_one(scene.folder / f"{exercise} {name}", exercise, name))


async def test_after_a_single_crash_the_program_is_run_twice_more(scene: Scene) -> None:
    assert (await judge_interrupted(scene, (1,), CRASH)).passed
    assert count_starts(scene.folder) == 3


@pytest.mark.parametrize(("crashing_runs", "starts"), [((1, 2), 2), ((1, 3), 3)])
async def test_a_second_crash_fails(scene: Scene, crashing_runs: tuple[int, ...], starts: int) -> None:
    verdict = await judge_interrupted(scene, crashing_runs, CRASH)
    assert "signal 11 (node.py, line" in verdict.cause, verdict
    assert count_starts(scene.folder) == starts


async def test_a_second_spin_after_shutdown_fails(scene: Scene) -> None:
    verdict = await judge_interrupted(scene, (1, 2), SPIN_ON)
    assert "RCLError: failed to initialize wait set" in verdict.cause, verdict
    assert count_starts(scene.folder) == 2


async def test_an_exit_code_hidden_by_an_rclpy_race_is_found_on_a_further_run(scene: Scene) -> None:
    verdict = await judge_interrupted(scene, (1,), RACE, "raise SystemExit(3)")
    assert "exit code 3" in verdict.cause, verdict
    assert count_starts(scene.folder) == 3


async def test_an_rclpy_race_is_forgiven_even_on_every_run(scene: Scene) -> None:
    assert (await judge_interrupted(scene, (1, 2), RACE)).passed
    assert count_starts(scene.folder) == 2


async def test_a_program_that_does_not_crash_is_started_once(scene: Scene) -> None:
    assert (await judge_interrupted(scene, (), CRASH)).passed
    assert count_starts(scene.folder) == 1
