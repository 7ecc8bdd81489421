"""Doubtful results on a busy machine are repeated, alone if necessary; lasting doubt is an error."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from dataclasses import dataclass

import pytest

from tests.engine.helpers import Scene, criterion, statuses
from tests.failures import failure
from tutor.errors import MachineTooBusy
from tutor.judge.bench import Bench, Scenario
from tutor.judge.verdict import Verdict, passed, skipped, undecided

CAUSE = ("no", "it does not", "do it")


@dataclass(frozen=True)
class Facts:
    """The facts of a scenario's n-th run."""

    run: int
    alone: bool = True
    slowed: bool = False


class Machine:
    """Makes scenarios that record whether they run alone."""

    def __init__(self) -> None:
        self.active = 0
        self.runs: dict[str, int] = {}

    def scenario(
        self, name: str, *, slowed_until: int = 0, too_busy_until: int = 0, asks: Scenario[Facts] | None = None
    ) -> Scenario[Facts]:
        """Return a scenario that is slowed down, or fails on a busy machine, in its first runs."""

        async def run(bench: Bench) -> Facts:
            number = self.runs[name] = self.runs.get(name, 0) + 1
            self.active += 1
            alone = True
            for _ in range(20):
                await asyncio.sleep(0.005)
                alone = alone and self.active == 1
            if asks is not None:
                self.active -= 1
                await bench.facts(asks)
                self.active += 1
            self.active -= 1
            if number <= too_busy_until:
                raise MachineTooBusy("too busy")
            return Facts(number, alone, number <= slowed_until)

        return run


def passes_from(run: int) -> Callable[..., Verdict]:
    return lambda facts: passed("", "") if facts.run >= run else failure("this", f"run {facts.run}", CAUSE)


def skips_until(run: int) -> Callable[..., Verdict]:
    return lambda facts: passed("", "") if facts.run >= run else skipped("another criterion did not pass")


@pytest.mark.parametrize(("judge", "status"), [(passes_from(2), "failed"), (skips_until(2), "skipped")])
async def test_what_fails_or_is_skipped_on_a_slowed_machine_is_judged_again_with_new_facts(
    scene: Scene, judge: Callable[..., Verdict], status: str
) -> None:
    machine = Machine()
    slowed, calm = machine.scenario("slowed", slowed_until=1), machine.scenario("calm")
    result = await scene.judge(criterion("again", slowed, judge=judge), criterion("once", calm, judge=judge))
    assert statuses(result) == {"again": "passed", "once": status}
    assert machine.runs == {"slowed": 2, "calm": 1}


async def test_a_failure_repeated_on_a_calm_machine_is_final(scene: Scene) -> None:
    machine = Machine()
    result = await scene.judge(criterion("a", machine.scenario("a", slowed_until=1), judge=passes_from(9)))
    assert statuses(result) == {"a": "failed"}
    assert machine.runs == {"a": 2}


async def test_a_failure_on_a_machine_that_stays_busy_is_final_after_three_runs(scene: Scene) -> None:
    machine = Machine()
    slowed = machine.scenario("a", slowed_until=9)
    result = await scene.judge(
        criterion("a", slowed, judge=passes_from(9)), criterion("b", slowed, judge=passes_from(9))
    )
    assert statuses(result) == {"a": "failed", "b": "failed"}
    assert machine.runs == {"a": 3}


async def test_a_pass_on_a_slowed_machine_is_not_repeated(scene: Scene) -> None:
    machine = Machine()
    assert statuses(await scene.judge(criterion("a", machine.scenario("a", slowed_until=9)))) == {"a": "passed"}
    assert machine.runs == {"a": 1}


async def test_an_undecided_scenario_is_repeated_alone(scene: Scene) -> None:
    machine = Machine()
    seen: list[Facts] = []

    def judge(facts: Facts) -> Verdict:
        seen.append(facts)
        return undecided("to time it") if facts.run == 1 else passed("", "")

    names = "a", "b", "c"
    result = await scene.judge(*(criterion(name, machine.scenario(name), judge=judge) for name in names))
    assert set(statuses(result).values()) == {"passed"}
    assert machine.runs == dict.fromkeys(names, 2)
    assert [facts.alone for facts in seen] == [False] * 3 + [True] * 3


async def test_a_lasting_undecided_verdict_is_a_machine_error(scene: Scene) -> None:
    machine = Machine()
    result = await scene.judge(criterion("a", machine.scenario("a"), judge=lambda facts: undecided("to time it")))
    assert statuses(result) == {"a": "error"}
    assert result.criteria[0].verdict.cause == "this machine is too busy to time it"
    assert machine.runs == {"a": 3}


async def test_a_scenario_that_found_the_machine_too_busy_is_repeated_alone_while_dependents_wait(scene: Scene) -> None:
    machine = Machine()
    busy = machine.scenario("busy", too_busy_until=2)
    asking = machine.scenario("asking", asks=busy)
    result = await scene.judge(
        criterion("a", busy, judge=lambda facts: passed("", "") if facts.alone else failure("alone", "not", CAUSE)),
        criterion("b", asking),
        criterion("c", machine.scenario("c")),
    )
    assert set(statuses(result).values()) == {"passed"}
    assert machine.runs == {"busy": 3, "asking": 1, "c": 1}


async def test_a_scenario_repeated_alone_may_depend_on_another_one_repeated_alone(scene: Scene) -> None:
    machine = Machine()
    first = machine.scenario("first")
    second = machine.scenario("second", asks=first)

    def judge(one: Facts, two: Facts) -> Verdict:
        return undecided("to time it") if 1 in (one.run, two.run) else passed("", "")

    assert statuses(await scene.judge(criterion("a", second, first, judge=judge))) == {"a": "passed"}
    assert machine.runs == {"first": 2, "second": 2}


async def test_a_scenario_that_never_gets_facts_is_a_machine_error(scene: Scene) -> None:
    machine = Machine()
    result = await scene.judge(criterion("a", machine.scenario("a", too_busy_until=9)))
    assert statuses(result) == {"a": "error"}
    assert result.criteria[0].verdict.step == "close what keeps this machine busy, then check again"
    assert machine.runs == {"a": 3}


async def test_criteria_that_share_a_scenario_are_judged_on_the_same_facts(scene: Scene) -> None:
    machine = Machine()
    shared = machine.scenario("shared", slowed_until=1)
    judged_runs: list[int] = []

    def second(facts: Facts) -> Verdict:
        judged_runs.append(facts.run)
        return passed("", "")

    await scene.judge(criterion("a", shared, judge=passes_from(2)), criterion("b", shared, judge=second))
    assert judged_runs == [2]
