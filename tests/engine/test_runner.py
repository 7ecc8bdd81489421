"""The runner: concurrent scenarios, shared facts, verdicts, and a clean end whatever happens."""

from __future__ import annotations

import asyncio
import os
import signal
import time
from typing import Any

import pytest

from tests.engine.helpers import FILE, PUBLISHES, Scene, criterion, node, statuses
from tests.failures import failure
from tutor.errors import EngineError
from tutor.judge.bench import Bench
from tutor.judge.events import CheckStarted, CriterionJudged, ExerciseJudged, Progress
from tutor.judge.verdict import Status, Verdict, passed
from tutor.workspace import digest_of_file

CAUSE = ("no", "it does not", "do it")


def fails(*facts: Any) -> Verdict:
    return failure("this", "that", CAUSE)


async def no_facts(bench: Bench) -> str:
    return "nothing"


async def test_scenarios_run_concurrently(scene: Scene) -> None:
    async def up(bench: Bench) -> tuple[float, float]:
        async with bench.start(FILE) as run:
            assert await run.until(lambda: bool(run.output), 20)
            began = time.monotonic()
            await run.until(lambda: time.monotonic() >= began + 1, 2)
            return began, time.monotonic()

    async def one(bench: Bench) -> tuple[float, float]:
        return await up(bench)

    async def two(bench: Bench) -> tuple[float, float]:
        return await up(bench)

    def overlap(first: tuple[float, float], second: tuple[float, float]) -> Verdict:
        assert max(first[0], second[0]) < min(first[1], second[1])
        return passed("at once", "at once")

    assert statuses(await scene.judge(criterion("both", one, two, judge=overlap))) == {"both": "passed"}
    assert len(set(scene.seen_domains)) == 2


async def test_facts_are_gathered_once_however_many_criteria_use_them(scene: Scene) -> None:
    ran: list[str] = []

    async def first(bench: Bench) -> str:
        ran.append("first")
        await asyncio.sleep(0)
        return "one"

    async def second(bench: Bench) -> str:
        ran.append("second")
        return await bench.facts(first) + await bench.facts(first) + " two"

    result = await scene.judge(criterion("a", first), criterion("b", first, second), criterion("c", second))
    assert sorted(ran) == ["first", "second"]
    assert [c.verdict.observed for c in result.criteria] == ["('one',)", "('one', 'oneone two')", "('oneone two',)"]


async def test_a_result_has_the_digests_of_the_files_as_they_were_when_the_check_began(scene: Scene) -> None:
    began: list[str] = []

    async def edited_meanwhile(bench: Bench) -> None:
        began.append(digest_of_file(scene.folder / FILE))
        (scene.folder / FILE).write_text("# another version\n")

    result = await scene.judge(criterion("a", edited_meanwhile))
    assert result.digests == {FILE: began[0]}
    assert result.given == ()
    assert began[0]


async def test_criteria_that_depend_on_a_failure_are_skipped(scene: Scene) -> None:
    result = await scene.judge(
        criterion("a", no_facts, judge=fails),
        criterion("b", no_facts, after=("a",)),
        criterion("c", no_facts, after=("b",)),
        criterion("d", no_facts),
        criterion("e", no_facts, after=("d",)),
    )
    assert statuses(result) == {"a": "failed", "b": "skipped", "c": "skipped", "d": "passed", "e": "passed"}
    assert "`a`" in result.criteria[1].verdict.cause
    assert result.criteria[2].verdict.cause == result.criteria[1].verdict.cause, "the root is named"
    assert result.verdict is Status.FAILED


async def test_only_reports_the_chosen_criteria_but_judges_their_dependencies(scene: Scene) -> None:
    judged: list[str] = []

    def recording(name: str, passes: bool = True) -> Any:
        def judge(*facts: Any) -> Verdict:
            judged.append(name)
            return passed("a", "b") if passes else fails()

        return judge

    result = await scene.judge(
        criterion("a", no_facts, judge=recording("a")),
        criterion("b", no_facts, judge=recording("b", False), after=("a",)),
        criterion("c", no_facts, judge=recording("c"), after=("b",)),
        criterion("d", no_facts, judge=recording("d")),
        only=frozenset({"c"}),
    )
    assert statuses(result) == {"c": "skipped"}
    assert judged == ["a", "b"]
    assert scene.events[0] == CheckStarted("t1", ("c",))
    assert {e.criterion if isinstance(e, Progress) else "c" for e in scene.events} == {"c"}


async def test_our_own_errors_are_not_the_learners_failures(scene: Scene) -> None:
    async def broken(bench: Bench) -> None:
        raise KeyError("oops")

    async def no_machine(bench: Bench) -> None:
        raise EngineError("no room", "make room")

    def wrong(fact: str) -> Verdict:
        return passed("", str(1 / 0))

    result = await scene.judge(
        criterion("judge", no_facts, judge=wrong),
        criterion("scenario", broken),
        criterion("machine", no_machine),
        criterion("after", no_facts, after=("machine",)),
        criterion("good", no_facts),
    )
    assert statuses(result) == {
        "judge": "error",
        "scenario": "error",
        "machine": "error",
        "after": "skipped",
        "good": "passed",
    }
    judge, scenario, machine = (c.verdict for c in result.criteria[:3])
    assert "ZeroDivisionError" in judge.cause
    assert "not of your code" in judge.step
    assert __file__.rpartition("/")[2] in judge.evidence[0]
    assert "KeyError: 'oops'" in scenario.cause
    assert (machine.cause, machine.step) == ("no room", "make room")
    assert result.verdict is Status.ERROR


async def test_without_a_free_domain_the_criterion_is_an_error_with_a_hint(
    scene: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    import tutor.engine.bench as live
    from tutor.errors import NoFreeDomain

    def none() -> Any:
        raise NoFreeDomain

    monkeypatch.setattr(live, "reserve_domain", none)

    async def start(bench: Bench) -> None:
        async with bench.start(FILE):
            raise AssertionError

    result = await scene.judge(criterion("a", start))
    assert statuses(result) == {"a": "error"}
    assert "No ROS domain id" in result.criteria[0].verdict.cause
    assert "Wait until other checks" in result.criteria[0].verdict.step


async def test_an_exception_in_a_scenario_is_the_cause(scene: Scene) -> None:
    async def raises_during_run(bench: Bench) -> None:
        async with bench.start(FILE) as run:
            await run.until(lambda: bool(run.output), 20)
            raise OSError("disk full")

    result = await scene.judge(criterion("a", raises_during_run))
    assert "OSError: disk full" in result.criteria[0].verdict.cause


async def test_a_certain_failure_is_reported_before_the_scenario_ends(scene: Scene) -> None:
    reported = asyncio.Event()

    async def enough(bench: Bench) -> str:
        return "eight"

    async def counts(bench: Bench) -> str:
        bench.report_facts("seven")  # the early judge does not fail on this
        await asyncio.sleep(0)
        bench.report_facts("eight")
        await reported.wait()
        return "nine"

    def early(facts: str) -> Verdict | None:
        return {"seven": passed("so far", "so good"), "eight": fails()}.get(facts)

    async def waits(bench: Bench) -> str:
        while not any(isinstance(event, CriterionJudged) and event.result.id == "a" for event in scene.events):
            await asyncio.sleep(0.01)
        reported.set()
        return "told"

    result = await scene.judge(
        criterion("a", counts, early=((counts, early),)),
        criterion("b", counts),
        criterion("c", counts, after=("a",)),
        criterion("d", waits),
        criterion("e", enough, waits, early=((enough, early),)),
    )
    assert statuses(result) == {"a": "failed", "b": "passed", "c": "skipped", "d": "passed", "e": "failed"}


async def test_a_certain_failure_waits_for_the_criteria_it_depends_on(scene: Scene) -> None:
    async def counts(bench: Bench) -> str:
        bench.report_facts("anything")
        return "all"

    async def later(bench: Bench) -> str:
        await bench.facts(counts)
        return "later"

    result = await scene.judge(
        criterion("a", later, judge=fails),
        criterion("b", counts, after=("a",), early=((counts, fails),)),
    )
    assert statuses(result) == {"a": "failed", "b": "skipped"}


async def test_facts_slowed_by_the_machine_cause_no_early_failure(scene: Scene) -> None:
    class Slowed:
        slowed = True

    async def counts(bench: Bench) -> str:
        bench.report_facts(Slowed())
        return "all"

    result = await scene.judge(criterion("a", counts, early=((counts, fails),)))
    assert statuses(result) == {"a": "passed"}


async def test_events_come_in_order_and_progress_never_goes_back(scene: Scene) -> None:
    async def steps(bench: Bench) -> str:
        for fraction in (-1.0, 0.0, 0.3, 0.7, 1.0, 4.0):
            bench.report_progress(fraction, f"at {fraction}")
            await asyncio.sleep(0)
        return "done"

    async def other(bench: Bench) -> str:
        await bench.facts(steps)
        bench.report_progress(1.0, "the other")
        return "done"

    result = await scene.judge(criterion("a", steps), criterion("b", steps, other), criterion("c", no_facts))
    started, *between, last = scene.events
    assert started == CheckStarted("t1", ("a", "b", "c"))
    assert last == ExerciseJudged(result)
    judged = [e.result for e in between if isinstance(e, CriterionJudged)]
    assert sorted(judged, key=lambda each: each.id) == list(result.criteria)
    for name in "abc":
        fractions = [e.fraction for e in between if isinstance(e, Progress) and e.criterion == name]
        assert all(0 <= fraction <= 1 for fraction in fractions)
        assert fractions == sorted(fractions)
        (verdict_at,) = (i for i, e in enumerate(between) if isinstance(e, CriterionJudged) and e.result.id == name)
        assert not any(isinstance(e, Progress) and e.criterion == name for e in between[verdict_at:])
    assert [e.fraction for e in between if isinstance(e, Progress) and e.criterion == "a"][-1] == 1.0
    assert [e.fraction for e in between if isinstance(e, Progress) and e.criterion == "b"][-1] == 1.0
    assert {e.exercise for e in between if isinstance(e, Progress | CriterionJudged)} == {"t1"}
    texts = [c.text for c in result.criteria]
    assert texts == ["the text of a", "the text of b", "c"]
    assert all(0 <= c.duration_s <= result.duration_s for c in result.criteria)


async def test_cancellation_leaves_no_process_and_no_domain(scene: Scene) -> None:
    running = asyncio.Event()

    async def forever(bench: Bench) -> None:
        async with bench.start(FILE, watch={"/chatter": "std_msgs/msg/String"}) as run:
            assert await run.until(lambda: bool(run.samples_on("/chatter")), 20)
            running.set()
            await run.until(lambda: False, 1000)

    async def waits_for_it(bench: Bench) -> None:
        await bench.facts(forever)

    check = asyncio.create_task(
        scene.judge(criterion("a", forever), criterion("b", waits_for_it), source=node(PUBLISHES))
    )
    await asyncio.wait_for(running.wait(), 25)
    assert scene.leftovers()
    assert scene.reserved_domains
    check.cancel()
    with pytest.raises(asyncio.CancelledError):
        await check
    assert not scene.leftovers()
    assert not scene.reserved_domains
    assert not any(isinstance(event, CriterionJudged) for event in scene.events)


async def test_an_exception_in_the_event_handler_ends_the_check_cleanly(scene: Scene) -> None:
    async def start(bench: Bench) -> None:
        async with bench.start(FILE) as run:
            await run.until(lambda: bool(run.output), 20)

    def broken(event: object) -> None:
        if isinstance(event, CriterionJudged):
            raise BrokenPipeError

    with pytest.raises(BrokenPipeError):
        await scene.judge(criterion("a", start), on_event=broken)


async def test_a_program_killed_from_outside_is_run_again(scene: Scene) -> None:
    """The sender of SIGKILL is unknown, but a program that kills itself does so on every run."""
    exits: list[str] = []

    async def kill_first_run(bench: Bench) -> str:
        async with bench.start(FILE) as run:
            assert await run.until(lambda: bool(run.output) or run.exit is not None, 20)
            if not exits:
                os.kill(int(run.output[0].text), signal.SIGKILL)
                await run.wait_for_exit(20)
            exits.append(str(run.exit))
            return exits[-1]

    source = "import os, time; print(os.getpid(), flush=True); time.sleep(1000)"
    assert statuses(await scene.judge(criterion("once", kill_first_run, judge=survives), source=source)) == {
        "once": "passed"
    }
    assert exits == ["signal 9", "None"]
    source = "import os; os.kill(os.getpid(), 9)"
    assert statuses(await scene.judge(criterion("each time", kill_first_run, judge=survives), source=source)) == {
        "each time": "failed"
    }
    assert exits[2:] == ["signal 9", "signal 9"]


def survives(exit: str) -> Verdict:
    return passed("lives", exit) if exit == "None" else fails()


async def test_a_killed_supervisor_is_an_error_not_a_failure(scene: Scene) -> None:
    async def broken(bench: Bench) -> str:
        async with bench.start(FILE) as run:
            await run.wait_for_exit(20)
            raise ValueError("what the check makes of facts that mean nothing")

    source = "import os, time; os.kill(os.getppid(), 9); time.sleep(1000)"
    (judged,) = (await scene.judge(criterion("any", broken), source=source)).criteria
    assert judged.verdict.status is Status.ERROR
    assert "looks after the program was killed" in str(judged.verdict.cause)
