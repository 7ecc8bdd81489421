"""What a busy machine left in doubt is repeated, alone where it must be, and is an error where the doubt stays."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from dataclasses import dataclass

from tests.engine.made import Scene, criterion, plain
from tutor.errors import MachineTooBusy
from tutor.judge.bench import Bench, Scenario
from tutor.judge.verdict import Cause, Verdict, failed, passed, undecided

NO = Cause("no", "it does not", "do it")


@dataclass(frozen=True)
class Facts:
    """The facts of the n-th run of a scenario."""

    run: int
    alone: bool = True
    slowed: bool = False


class Machine:
    """Scenarios that note who is at work beside them."""

    def __init__(self) -> None:
        self.at_work = 0
        self.runs: dict[str, int] = {}

    def scenario(
        self, name: str, *, slowed_until: int = 0, too_busy_until: int = 0, asks: Scenario[Facts] | None = None
    ) -> Scenario[Facts]:
        """A scenario that is slowed down in its first runs, or for which the machine is too busy."""

        async def run(bench: Bench) -> Facts:
            number = self.runs[name] = self.runs.get(name, 0) + 1
            self.at_work += 1
            alone = True
            for _ in range(20):
                await asyncio.sleep(0.005)
                alone = alone and self.at_work == 1
            if asks is not None:
                self.at_work -= 1
                await bench.facts(asks)
                self.at_work += 1
            self.at_work -= 1
            if number <= too_busy_until:
                raise MachineTooBusy("too busy")
            return Facts(number, alone, number <= slowed_until)

        return run


def passes_from(run: int) -> Callable[..., Verdict]:
    return lambda facts: passed("", "") if facts.run >= run else failed("this", f"run {facts.run}", NO)


async def test_what_fails_while_the_machine_slows_it_down_is_judged_by_new_facts(scene: Scene) -> None:
    machine = Machine()
    slowed, calm = machine.scenario("slowed", slowed_until=1), machine.scenario("calm")
    result = await scene.judge(
        criterion("again", slowed, judge=passes_from(2)),
        criterion("once", calm, judge=passes_from(2)),
    )
    assert plain(result) == {"again": "passed", "once": "failed"}
    assert machine.runs == {"slowed": 2, "calm": 1}


async def test_what_fails_on_a_calm_machine_too_has_failed(scene: Scene) -> None:
    machine = Machine()
    result = await scene.judge(criterion("a", machine.scenario("a", slowed_until=1), judge=passes_from(9)))
    assert plain(result) == {"a": "failed"}
    assert machine.runs == {"a": 2}


async def test_a_failure_on_a_machine_that_stays_busy_is_one_after_three_runs(scene: Scene) -> None:
    machine = Machine()
    slowed = machine.scenario("a", slowed_until=9)
    result = await scene.judge(
        criterion("a", slowed, judge=passes_from(9)), criterion("b", slowed, judge=passes_from(9))
    )
    assert plain(result) == {"a": "failed", "b": "failed"}
    assert machine.runs == {"a": 3}


async def test_what_passes_is_not_repeated(scene: Scene) -> None:
    machine = Machine()
    assert plain(await scene.judge(criterion("a", machine.scenario("a", slowed_until=9)))) == {"a": "passed"}
    assert machine.runs == {"a": 1}


async def test_what_is_undecided_is_repeated_alone(scene: Scene) -> None:
    machine = Machine()
    seen: list[Facts] = []

    def judge(facts: Facts) -> Verdict:
        seen.append(facts)
        return undecided("to time it") if facts.run == 1 else passed("", "")

    names = "a", "b", "c"
    result = await scene.judge(*(criterion(name, machine.scenario(name), judge=judge) for name in names))
    assert set(plain(result).values()) == {"passed"}
    assert machine.runs == dict.fromkeys(names, 2)
    assert [facts.alone for facts in seen] == [False] * 3 + [True] * 3


async def test_what_stays_undecided_is_an_error_of_the_machine(scene: Scene) -> None:
    machine = Machine()
    result = await scene.judge(criterion("a", machine.scenario("a"), judge=lambda facts: undecided("to time it")))
    assert plain(result) == {"a": "error"}
    assert result.criteria[0].verdict.cause == "this machine is too busy to time it"
    assert machine.runs == {"a": 3}


async def test_a_scenario_without_facts_is_repeated_alone_and_others_that_wait_for_it_wait_on(scene: Scene) -> None:
    machine = Machine()
    busy = machine.scenario("busy", too_busy_until=2)
    asking = machine.scenario("asking", asks=busy)
    result = await scene.judge(
        criterion("a", busy, judge=lambda facts: passed("", "") if facts.alone else failed("alone", "not", NO)),
        criterion("b", asking),
        criterion("c", machine.scenario("c")),
    )
    assert set(plain(result).values()) == {"passed"}
    assert machine.runs == {"busy": 3, "asking": 1, "c": 1}


async def test_scenarios_that_are_alone_may_ask_for_one_that_is_to_be_alone_too(scene: Scene) -> None:
    machine = Machine()
    first = machine.scenario("first")
    second = machine.scenario("second", asks=first)

    def judge(one: Facts, two: Facts) -> Verdict:
        return undecided("to time it") if 1 in (one.run, two.run) else passed("", "")

    assert plain(await scene.judge(criterion("a", second, first, judge=judge))) == {"a": "passed"}
    assert machine.runs == {"first": 2, "second": 2}


async def test_no_facts_at_all_are_an_error_of_the_machine(scene: Scene) -> None:
    machine = Machine()
    result = await scene.judge(criterion("a", machine.scenario("a", too_busy_until=9)))
    assert plain(result) == {"a": "error"}
    assert result.criteria[0].verdict.hint == "close what keeps this machine busy, then check again"
    assert machine.runs == {"a": 3}


async def test_criteria_that_share_a_scenario_are_judged_by_the_same_facts(scene: Scene) -> None:
    machine = Machine()
    shared = machine.scenario("shared", slowed_until=1)
    by: list[int] = []

    def second(facts: Facts) -> Verdict:
        by.append(facts.run)
        return passed("", "")

    await scene.judge(criterion("a", shared, judge=passes_from(2)), criterion("b", shared, judge=second))
    assert by == [2]
