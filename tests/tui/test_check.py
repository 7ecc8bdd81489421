"""Checks, by a fake engine: a child process whose events come when the test sends them."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from tests.tui import fakes
from tests.tui.conftest import open_app
from tutor.judge.events import CriterionJudged, ExerciseJudged

SIZES = [(120, 36), (80, 24)]


async def start_check(me: Any) -> None:
    await me.press("c")
    await me.engine_emits(*fakes.started_events())


@pytest.mark.parametrize("size", SIZES)
async def test_during_a_check_each_criterion_shows_its_progress(learner: Any, size: Any) -> None:
    async with learner(size) as me:
        await start_check(me)
        await me.engine_emits(fakes.progress_event("rate", 0.6, "setting publish_rate to 5.0"))
        await me.sees("60%", "setting publish_rate to 5.0", "waiting", "c Cancel", "Esc cancels")
        await me.engine_emits(CriterionJudged("i1.1", fakes.result("publishes", fakes.GOOD)))
        await me.until(lambda: "✓ publishes" in me.criterion("publishes"))
        assert "60%" in me.criterion("rate")


@pytest.mark.parametrize("size", SIZES)
async def test_a_waiting_criterion_shows_the_findings_so_far_until_its_verdict(learner: Any, size: Any) -> None:
    async with learner(size) as me:
        await start_check(me)
        await me.engine_emits(
            fakes.progress_event("publishes", 0.1, "waiting for the first message", so_far="/node is up, but silent")
        )
        await me.sees("so far: /node is up, but silent")
        await me.engine_emits(
            fakes.progress_event("publishes", 0.1, "waiting", so_far="likely [b]no spin[/b]: it never spins")
        )
        await me.until(lambda: "so far: likely [b]no spin[/b]" in me.criterion("publishes"))
        await me.engine_emits(fakes.progress_event("publishes", 0.8, "pressing Ctrl+C"))
        await me.until(lambda: "pressing Ctrl+C" in me.criterion("publishes"))
        assert "so far" not in me.criterion("publishes")
        await me.engine_emits(fakes.progress_event("publishes", 0.1, "waiting", so_far="/node is up"))
        await me.engine_emits(*fakes.final_events(fakes.BAD))
        await me.until(lambda: "✓ publishes" in me.criterion("publishes"))
        assert "so far" not in me.screen()


@pytest.mark.parametrize("size", SIZES)
async def test_a_failure_is_shown_with_its_diagnosis(learner: Any, size: Any) -> None:
    async with learner(size) as me:
        await start_check(me)
        await me.engine_emits(*fakes.final_events(fakes.BAD))
        await me.sees("✗ rate  ", "Expected", "Observed", "Cause", "Next step", "2 of 3 passed")
        await me.sees("0.20 Hz over 3 messages", "rate used as a period")
        assert "line 18" not in me.diagnosis()  # the evidence is folded
        await me.press("i")
        await me.until(lambda: "line 18" in me.diagnosis())
        assert "✗ rate" in me.criterion("rate")
        assert "- shutdown" in me.criterion("shutdown")
        await me.until(lambda: me.main.model.progress.of("i1.1").last is not None)
        assert me.session.progress().of("i1.1").last.passed == ("publishes", "range")
        await me.press("1") if size == (120, 36) else await me.press("l")
        await me.sees("2 of 3 met")


@pytest.mark.parametrize("size", SIZES)
async def test_the_first_failure_is_shown_at_once_and_stays_while_the_check_continues(learner: Any, size: Any) -> None:
    async with learner(size) as me:
        await start_check(me)
        await me.engine_emits(CriterionJudged("i1.1", fakes.result("shutdown", fakes.BAD, bonus=True)))
        await me.engine_emits(CriterionJudged("i1.1", fakes.result("rate", fakes.BAD)))
        await me.sees("✗ rate  ", "Next step  Give create_timer", "rate used as a period", "checking")
        await me.engine_emits(CriterionJudged("i1.1", fakes.result("publishes", fakes.BAD)))
        await me.until(lambda: "✗ publishes" in me.criterion("publishes"))
        await me.engine_emits(*fakes.final_events(fakes.BAD))
        await me.sees("2 of 3 passed")
        assert me.main.chosen_criterion == "rate"
        assert "✗ rate" in me.diagnosis()


async def test_a_selected_waiting_criterion_shows_the_full_findings_until_its_verdict(learner: Any) -> None:
    async with learner() as me:
        await start_check(me)
        await me.engine_emits(
            fakes.progress_event("range", 0.2, "collecting values", so_far="no messages yet, " + "words " * 20 + "end")
        )
        await me.press("5")
        await me.pilot.click(me.main.query("CriterionRow")[1])
        await me.until(lambda: "So far, and not final: no messages yet" in me.diagnosis(), "the full findings so far")
        assert "end" in me.diagnosis()
        await me.engine_emits(CriterionJudged("i1.1", fakes.result("rate", fakes.BAD)))
        await me.until(lambda: "✗ rate" in me.criterion("rate"))
        assert "range" in me.diagnosis()  # the selection stays
        await me.engine_emits(CriterionJudged("i1.1", fakes.result("range", fakes.GOOD)))
        await me.until(lambda: "54 values from 20.03 to 29.87" in me.diagnosis())
        assert "So far" not in me.diagnosis()


async def test_a_check_can_be_set_to_end_at_its_first_failure(learner: Any) -> None:
    async with learner() as me:
        await me.press("F")
        await me.sees("A check now ends at its first failure")
        await start_check(me)
        await me.engine_emits(*fakes.final_events(fakes.BAD))
        me.session.engine.close()
        await me.until(lambda: me.main.checks.running is None)
        assert me.session.first
        await me.press("F", "c")
        await me.until(lambda: not me.session.first)


async def test_selecting_another_criterion_shows_what_was_measured(learner: Any) -> None:
    async with learner() as me:
        await start_check(me)
        await me.engine_emits(*fakes.final_events(fakes.BAD))
        await me.sees("Next step")
        await me.pilot.click(me.main.query("CriterionRow")[1])
        await me.sees("✓ range  ", "54 values from 20.03 to 29.87")


@pytest.mark.parametrize("size", SIZES)
async def test_a_pass_is_celebrated_and_names_the_next_step(learner: Any, size: Any) -> None:
    async with learner(size) as me:
        await start_check(me)
        await me.engine_emits(*fakes.final_events(fakes.GOOD))
        await me.sees("I1.1 Sensor Publisher passed", "Well done", "Next: press n for", "3 of 3 passed")
        await me.press("n")
        await me.sees("I1.3  Calculator Service")
        await me.press("p")
        if size == (80, 24):
            await me.press("5")
        await me.sees("I1.1 Sensor Publisher passed")
        await me.until(lambda: me.main.model.progress.of("i1.1").best is not None)
        assert me.session.progress().of("i1.1").best.value == "passed"


@pytest.mark.parametrize("key", ["escape", "c"])
async def test_cancelling_interrupts_the_engine_and_waits_for_it(learner: Any, key: str) -> None:
    async with learner() as me:
        await start_check(me)
        await me.engine_emits(fakes.progress_event("rate", 0.3, "listening"))
        await me.sees("listening")
        pid = me.session.engine.pid
        await me.press(key)
        await me.sees("cancelled", "c Check")
        assert me.session.engine.cleaned_up
        with pytest.raises(ProcessLookupError):
            os.kill(pid, 0)
        assert me.criterion("rate").startswith("○ rate")
        assert me.session.progress().of("i1.1").last is None


async def test_a_crash_of_the_engine_is_our_fault_and_prints_no_traceback_over_the_screen(learner: Any) -> None:
    async with learner() as me:
        await start_check(me)
        await me.engine_emits(CriterionJudged("i1.1", fakes.result("publishes", fakes.GOOD)), "crash")
        await me.sees("! error", "the check ended before it was done", "not of your code")
        await me.press("i")
        await me.until(lambda: "RuntimeError: the engine has a bug" in me.diagnosis())
        assert "✓ publishes" in me.criterion("publishes")
        assert "! rate" in me.criterion("rate")
        assert me.session.progress().of("i1.1").last is None


async def test_a_known_engine_error_is_shown_in_the_engines_words(learner: Any) -> None:
    async with learner() as me:
        await start_check(me)
        await me.engine_emits("fault")
        await me.sees("! error")
        assert "no domain is free. End other checks first." in me.diagnosis()


async def test_a_line_that_is_not_an_event_is_an_error_too(learner: Any) -> None:
    async with learner() as me:
        await start_check(me)
        await me.engine_emits("hello [red]world[/red]")
        await me.sees("! error")
        assert "not understood: 'hello [red]world[/red]" in me.diagnosis()


async def test_an_engine_that_cannot_be_started_is_reported(learner: Any) -> None:
    async with learner() as me:
        me.session.engine.command = ("/nowhere/python",)
        await me.press("c")
        await me.sees("! error", "could not be started")


async def test_a_check_continues_while_another_lesson_is_open(learner: Any) -> None:
    async with learner() as me:
        await start_check(me)
        await me.press("n")
        await me.sees("I1.3  Calculator Service", "checking I1.1")
        await me.engine_emits(*fakes.final_events(fakes.GOOD))
        me.session.engine.close()
        await me.sees("I1.1 passed.", "○ Criteria  publishes, range, rate")


async def test_quitting_ends_the_check(learner: Any) -> None:
    async with learner() as me:
        await start_check(me)
        await me.engine_emits(fakes.progress_event("rate", 0.3, "listening"))
        await me.sees("listening")
        pid = me.session.engine.pid
        await me.press("q")
        await me.until(lambda: me.app.return_code == 0)
        assert me.session.engine.cleaned_up
        with pytest.raises(ProcessLookupError):
            os.kill(pid, 0)


async def test_a_save_replaces_the_running_check_by_a_new_one(learner: Any) -> None:
    async with learner() as me:
        await me.press("w")
        await me.sees("a save checks")
        await start_check(me)
        await me.engine_emits(fakes.progress_event("rate", 0.3, "listening"))
        await me.sees("listening")
        first = me.session.engine.pid
        me.session.engine.detach()
        await me.focus_editor()
        await me.press("#", "ctrl+s")
        await me.until(lambda: me.main.checks.running is not None and me.session.engine.pid != first, "checked again")
        with pytest.raises(ProcessLookupError):
            os.kill(first, 0)
        await me.engine_emits(*fakes.started_events(), *fakes.final_events(fakes.GOOD))
        me.session.engine.close()
        await me.until(lambda: me.main.model.progress.of("i1.1").best is not None)


async def test_attempts_are_recorded_and_listed(learner: Any) -> None:
    async with learner((180, 50)) as me:
        await start_check(me)
        await me.engine_emits(*fakes.final_events(fakes.BAD))
        me.session.engine.close()
        await me.sees("1 attempt", "2 of 3", "not yet: rate")
        await me.until(lambda: me.main.checks.running is None)
        await me.press("a")
        await me.sees("I1.1: your attempts", "today")


async def test_in_the_editor_the_hints_name_keys_that_work_there(learner: Any) -> None:
    async with learner() as me:
        await me.focus_editor()
        await me.press("f9")
        await me.engine_emits(*fakes.started_events())
        await me.sees("F9 cancels")
        await me.engine_emits(*fakes.final_events(fakes.GOOD))
        await me.sees("Next: press Esc, then n for I1.3")
        await me.press("escape")
        await me.sees("Next: press n for I1.3")
        await me.press("n")
        await me.sees("I1.3  Calculator Service")
        assert me.session.path(me.session.lessons[0].files[0]).read_text() == fakes.NODE


async def test_verdicts_are_marked_stale_while_the_code_differs_from_what_was_checked(learner: Any) -> None:
    async with learner() as me:
        await start_check(me)
        await me.engine_emits(*fakes.final_events(fakes.BAD))
        await me.sees("Next step")
        changed = "your code has changed since this check"
        await me.focus_editor()
        await me.press("#")
        await me.sees(changed, "✗ rate")
        await me.press("ctrl+z")
        await me.sees_no(changed)
        me.file.write_text("# by another editor\n")
        await me.sees(changed)


async def test_after_a_restart_the_last_check_is_shown(tmp_path: Path) -> None:
    session = fakes.FakeSession(tmp_path / "learner")
    done = fakes.final_events(fakes.BAD)[-2]
    assert isinstance(done, ExerciseJudged)
    session.record(done.result)
    async with open_app(session) as me:
        await me.press("2", "5")
        await me.sees("Criteria", "last check today", "2 of 3 met", "✓ publishes", "○ rate")
        await me.press("down", "down", "down", "enter")
        await me.sees("Not met at the last check, today", "Press c")


LONG = replace(
    fakes.BAD,
    expected="a rate that can be set: " + "words " * 20,
    hint="Change this " + "and that in the same place " * 11 + "and then check again.",
)


async def test_the_next_step_comes_first_and_no_notification_covers_it(learner: Any) -> None:
    async with learner((120, 36)) as me:
        await start_check(me)
        await me.engine_emits(*fakes.final_events(LONG))
        await me.sees("Next step  Change this", "then check again.", "Cause")
        me.main.say("A note that is as long as notes are. " * 5)
        await me.sees("A note that", "Next step  Change this", "check again.", "Cause")
        lines = me.screen().split("\n")
        step, cause = (next(n for n, line in enumerate(lines) if word in line) for word in ("Next step", "Cause"))
        assert step < cause
        assert "✗ failed" not in me.screen()
        assert "passed  " not in me.criterion("publishes")


async def test_hints_begin_with_what_failed_and_continue_with_the_general_ones(learner: Any) -> None:
    async with learner() as me:
        await start_check(me)
        await me.engine_emits(*fakes.final_events(fakes.BAD))
        await me.sees("Next step")
        await me.press("h")
        await me.sees("I1.1: a hint for what failed", "✗ rate", "Declare it.", "h: general hint")
        assert "Think of a timer." not in me.screen()
        await me.press("h")
        await me.sees("hint 1 of 3", "Declare it.", "Think of a timer.")
        await me.press("escape", "h")
        await me.sees("hint 1 of 3", "Declare it.", "Think of a timer.")


async def test_on_the_lesson_page_unchecked_criteria_collapse_into_one_line(learner: Any) -> None:
    async with learner() as me:
        whole = "Float64 messages arrive on /sensor/temperature"
        await me.sees("○ Criteria  publishes, range, rate, 1 bonus", "5 opens")
        assert whole not in me.screen()
        await me.press("5")
        await me.sees(whole, "not checked yet")
        await me.press("1")
        await me.sees_no(whole)
        await me.press("2")
        await me.sees(whole)
        await me.press("1")
        await start_check(me)
        await me.engine_emits(*fakes.final_events(fakes.BAD))
        await me.sees("Next step", "✗ rate")
