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
from tutor.judge.verdict import Status
from tutor.workspace import digests_of

SIZES = [(120, 36), (80, 24)]


@pytest.mark.parametrize("size", SIZES)
async def test_during_a_check_each_criterion_shows_what_is_known_until_its_verdict(learner: Any, size: Any) -> None:
    async with learner(size) as me:
        await me.start_check()
        await me.engine_emits(fakes.progress_event("rate", 0.6, "setting publish_rate to 5.0"))
        await me.sees("60%", "setting publish_rate to 5.0", "waiting", "c Cancel", "Esc cancels")

        # The findings so far, of a criterion that is waiting.
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
        await me.engine_emits(
            fakes.progress_event("publishes", 0.1, "waiting", so_far="/node is up"),
            CriterionJudged("i1.1", fakes.result("publishes", fakes.GOOD)),
        )
        await me.until(lambda: "✓ publishes" in me.criterion("publishes"))
        assert "so far" not in me.screen()
        assert "60%" in me.criterion("rate")

        # The first failure is shown at once, unless it is a bonus, and stays while the check continues.
        await me.engine_emits(CriterionJudged("i1.1", fakes.result("shutdown", fakes.BAD, bonus=True)))
        await me.engine_emits(CriterionJudged("i1.1", fakes.result("rate", fakes.BAD)))
        await me.sees("✗ rate  ", "Next step  Give the timer", "rate used as a period", "checking")
        await me.engine_emits(CriterionJudged("i1.1", fakes.result("range", fakes.BAD)))
        await me.until(lambda: "✗ range" in me.criterion("range"))
        await me.engine_emits(*fakes.final_events(fakes.BAD))
        await me.sees("2 of 3 passed")
        assert me.main.chosen_criterion == "rate"
        assert "✗ rate" in me.diagnosis()


@pytest.mark.parametrize("size", SIZES)
async def test_a_failure_is_shown_with_its_diagnosis_and_then_a_pass_is_celebrated(learner: Any, size: Any) -> None:
    async with learner(size) as me:
        await me.start_check()
        await me.engine_emits(*fakes.final_events(fakes.BAD))
        await me.sees("✗ rate  ", "Expected", "Observed", "Why", "Next step", "2 of 3 passed")
        await me.sees("0.20 Hz over 3 messages", "rate used as a period")
        assert "line 18" not in me.diagnosis()  # the evidence is folded
        await me.press("i")
        await me.until(lambda: "line 18" in me.diagnosis())
        assert "✗ rate" in me.criterion("rate")
        assert "- shutdown" in me.criterion("shutdown")
        await me.until(lambda: me.main.model.progress.of("i1.1").last is not None)
        assert me.session.progress().of("i1.1").last.passed == ("publishes", "range")
        await me.end_check()
        await me.press("1") if size == (120, 36) else await me.press("l")
        await me.sees("2 of 3 met")
        if size == (80, 24):
            await me.press("l")

        # Checked again, it passes: the next step is named, and the celebration is still there on coming back.
        await me.start_check()
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


async def test_the_selected_criterion_shows_the_findings_so_far_and_then_what_was_measured(learner: Any) -> None:
    async with learner((180, 50)) as me:
        await me.start_check()
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

        # After the check, another criterion is selected, and the first one again.
        await me.engine_emits(*fakes.final_events(fakes.BAD))
        await me.sees("1 attempt", "2 of 3", "not yet: rate")
        await me.pilot.click(me.main.query("CriterionRow")[2])
        await me.sees("✗ rate  ", "Next step")
        await me.pilot.click(me.main.query("CriterionRow")[1])
        await me.sees("✓ range  ", "54 values from 20.03 to 29.87")

        await me.end_check()
        await me.press("a")
        await me.sees("I1.1: your attempts", "today")


def assert_engine_ended(me: Any, pid: int) -> None:
    """Assert that the engine was interrupted and had the time to clean up, and that its process is gone."""
    assert me.session.engine.cleaned_up
    with pytest.raises(ProcessLookupError):
        os.kill(pid, 0)


async def test_a_check_ends_at_its_first_failure_if_set_by_either_key_and_with_the_app(learner: Any) -> None:
    async def listening() -> int:
        """Wait until the engine is at work, and return its process id."""
        await me.engine_emits(*fakes.started_events(), fakes.progress_event("rate", 0.3, "listening"))
        await me.sees("listening")
        await me.sees_no("cancelled")
        pid: int = me.session.engine.pid
        return pid

    async with learner() as me:
        # It can be set to end at its first failure.
        await me.press("F")
        await me.sees("A check now ends at its first failure")
        await me.start_check()
        await me.engine_emits(*fakes.final_events(fakes.BAD))
        await me.end_check()
        assert me.session.first
        await me.until(lambda: me.main.model.progress.of("i1.1").last is not None)
        recorded = me.session.progress().of("i1.1")
        await me.press("F", "c")
        await me.until(lambda: not me.session.first)

        for key in ("escape", "c"):
            pid = await listening()
            await me.press(key)
            await me.sees("cancelled", "c Check")
            assert_engine_ended(me, pid)
            assert me.criterion("rate").startswith("○ rate")
            assert me.session.progress().of("i1.1") == recorded
            await me.end_check()
            (me.session.engine.folder / "cleaned-up").unlink()
            await me.press("c")

        pid = await listening()
        await me.press("q")
        await me.until(lambda: me.app.return_code == 0)
        assert_engine_ended(me, pid)


async def test_a_fault_of_the_engine_is_ours_and_is_shown_without_a_traceback_over_the_screen(learner: Any) -> None:
    async with learner() as me:
        works, me.session.engine.command = me.session.engine.command, ("/nowhere/python",)
        await me.press("c")
        await me.sees("! error", "could not be started")
        await me.until(lambda: me.main.checks.running is None)
        me.session.engine.command = works

        await me.start_check()
        await me.engine_emits(CriterionJudged("i1.1", fakes.result("publishes", fakes.GOOD)), "crash")
        await me.sees("! error", "the check ended before it was done", "not of your code")
        await me.press("i")
        await me.until(lambda: "RuntimeError: the engine has a bug" in me.diagnosis())
        assert "✓ publishes" in me.criterion("publishes")
        assert "! rate" in me.criterion("rate")
        await me.end_check()

        # An error that the engine knows, in its own words.
        await me.start_check()
        await me.sees_no("! error")
        await me.engine_emits("fault")
        await me.sees("! error")
        assert "no domain is free. End other checks first." in me.diagnosis()
        await me.end_check()

        # A line that is not an event.
        await me.start_check()
        await me.sees_no("! error")
        await me.engine_emits("hello [red]world[/red]")
        await me.sees("! error")
        assert "not understood: 'hello [red]world[/red]" in me.diagnosis()
        assert me.session.progress().of("i1.1").last is None


async def test_hints_name_keys_that_work_in_the_editor_and_a_check_continues_in_another_lesson(learner: Any) -> None:
    async with learner() as me:
        await me.focus_editor()
        await me.press("f9")
        await me.engine_emits(*fakes.started_events())
        await me.sees("F9 cancels")
        await me.engine_emits(*fakes.final_events(fakes.GOOD))
        await me.sees("Next: press Esc, then n for I1.3")
        await me.press("escape")
        await me.sees("Next: press n for I1.3")
        await me.end_check()

        # Another check, which continues while another lesson is open.
        await me.start_check()
        await me.press("n")
        await me.sees("I1.3  Calculator Service", "checking I1.1")
        assert me.session.path(me.session.lessons[0].files[0]).read_text() == fakes.NODE
        await me.engine_emits(*fakes.final_events(fakes.GOOD))
        me.session.engine.close()
        await me.sees("I1.1 passed.", "○ Criteria  publishes, range, rate")


async def test_a_change_of_the_code_makes_verdicts_stale_and_a_save_replaces_the_running_check(learner: Any) -> None:
    async with learner() as me:
        await me.start_check()
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
        await me.end_check()

        await me.press("escape", "w")
        await me.sees("a save checks")
        await me.start_check()
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
        await me.until(lambda: me.main.model.progress.of("i1.1").best is Status.PASSED)


async def test_what_is_said_of_the_code_is_true_of_every_file_on_disk_however_it_was_saved(learner: Any) -> None:
    changed = "your code has changed since this check"
    async with learner() as me:
        await me.press("2")
        await me.sees("the sensor is warm")

        # Saved outside and checked at once: that version is the one that is judged.
        me.file.write_text("# another version\n")
        await me.start_check()
        await me.engine_emits(*fakes.final_events(fakes.BAD))
        await me.sees("# another version", "Next step", "2 of 3 passed")
        await me.end_check()
        assert changed not in me.screen()

        # A save that changes nothing leaves a running check alone, even if each save begins one.
        await me.press("escape", "w")
        await me.start_check()
        await me.engine_emits(fakes.progress_event("rate", 0.3, "listening"))
        await me.sees("listening")
        checking = me.main.checks.running
        await me.press("ctrl+s")
        await me.sees("is saved")
        assert me.main.checks.running is checking
        assert not checking.cancelled
        await me.engine_emits(*fakes.final_events(fakes.BAD))
        await me.end_check()
        await me.press("w")

        # The other file of an exercise counts, too, though it is not shown.
        await me.press("n", "s")
        await me.until(lambda: all(path.exists() for path in me.main.model.paths))
        client = me.main.model.paths[1]
        await me.press("f9")
        lesson = me.main.model.lesson
        await me.engine_emits(*fakes.lesson_final_events(lesson, fakes.BAD))
        await me.end_check()
        assert changed not in me.screen()
        was = client.read_text()
        client.write_text("# another client\n")
        await me.sees(changed)
        client.write_text(was)
        await me.sees_no(changed)
        client.unlink()
        await me.sees(changed)
        assert len(me.main.query("CodeEditor")) == 2, "none for a file that was never shown"


async def test_after_a_restart_the_last_report_is_shown_with_its_time_and_whether_the_code_has_changed(
    tmp_path: Path,
) -> None:
    session = fakes.FakeSession(tmp_path / "learner")
    done = fakes.final_events(fakes.BAD)[-2]
    assert isinstance(done, ExerciseJudged)
    path = session.path(session.lessons[0].files[0])
    session.record(replace(done.result, digests=digests_of({path.name: path})))
    async with open_app(session) as me:
        await me.sees("Checked today", "your code is the same", "✓ publishes", "✗ rate  ", "2 of 3 passed")
        await me.sees("Next step  Give the timer", "Why", "Expected", "0.20 Hz over 3 messages")
        await me.press("5", "i")
        await me.until(lambda: "line 18" in me.diagnosis(), "the evidence")
        await me.press("up")
        await me.sees("54 values from 20.03 to 29.87")
        path.write_text("# another version\n")
        await me.sees("Checked today", "your code has changed since")

        # A new check replaces it.
        await me.start_check()
        await me.sees_no("Checked today")
        await me.engine_emits(*fakes.final_events(fakes.GOOD))
        await me.sees("3 of 3 passed")
        await me.end_check()
        await me.until(lambda: me.main.model.progress.of("i1.1").is_passed)

    # A damaged one is set aside: what is left is which criteria were met.
    kept = session.workspace.last_checks().path_of("i1.1")
    assert '"ros-tutor/last-check/2"' in kept.read_text()
    kept.write_text("{")
    async with open_app(session) as me:
        await me.sees("the last check of i1.1 could not be read")
        assert [each.read_text() for each in kept.parent.glob("*.damaged-*")] == ["{"]
        await me.press("2", "5")
        await me.sees("last check today", "3 of 3 met", "✓ publishes")
        await me.press("down", "down", "down", "enter")
        await me.sees("Met at the last check, today", "Press c")


async def test_hints_begin_with_what_fails(learner: Any) -> None:
    async with learner() as me:
        await me.start_check()
        await me.engine_emits(*fakes.final_events(fakes.BAD))
        await me.sees("Next step")
        await me.press("h")
        await me.sees("I1.1: a hint for what failed", "✗ rate", "Declare it.", "h: general hint")
        await me.until(lambda: me.session.progress().of("i1.1").criterion_hint, "saved")
        assert "Think of a timer." not in me.screen()
        await me.press("h")
        await me.sees("hint 1 of 3", "Declare it.", "Think of a timer.")
        await me.press("escape", "h")
        await me.sees("hint 1 of 3", "Declare it.", "Think of a timer.")


@pytest.mark.parametrize("size", [*SIZES, (180, 50)])
async def test_the_selection_stays_where_the_learner_has_put_it(learner: Any, size: Any) -> None:
    async with learner(size) as me:
        await me.start_check()
        await me.engine_emits(fakes.progress_event("range", 0.2, "collecting values"))
        await me.press("5", "down", "down")
        assert me.main.chosen_criterion == "range"

        # Neither results, nor the end of the check, nor the next check move it, whatever they find.
        await me.engine_emits(CriterionJudged("i1.1", fakes.result("publishes", fakes.BAD)))
        await me.until(lambda: "✗ publishes" in me.criterion("publishes"))
        assert me.main.chosen_criterion == "range"
        await me.engine_emits(*fakes.final_events(fakes.BAD))
        await me.sees("2 of 3 passed", "✓ range  ", "54 values", "✗ Not met yet: rate")
        assert me.main.chosen_criterion == "range"
        await me.end_check()
        await me.start_check()
        await me.engine_emits(CriterionJudged("i1.1", fakes.result("publishes", fakes.BAD)))
        await me.until(lambda: "✗ publishes" in me.criterion("publishes"))
        assert me.main.chosen_criterion == "range"
        await me.engine_emits(*fakes.final_events(fakes.GOOD))
        await me.sees("3 of 3 passed", "54 values", "✓ I1.1 passed  press n for I1.3")
        assert me.main.chosen_criterion == "range"
        await me.end_check()

        # In another lesson the app selects again.
        await me.press("n", "s")
        await me.until(lambda: all(path.exists() for path in me.main.model.paths))
        await me.start_check()
        await me.engine_emits(*fakes.lesson_final_events(me.main.model.lesson, fakes.BAD))
        await me.until(lambda: me.main.chosen_criterion == "rate")


LONG = replace(
    fakes.BAD,
    expected="a rate that can be set: " + "words " * 20,
    step="Change this " + "and that in the same place " * 6 + "and then check again.",
)


async def test_the_criteria_are_one_line_until_checked_and_then_the_next_step_is_in_sight(learner: Any) -> None:
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
        await me.start_check()
        await me.engine_emits(*fakes.final_events(LONG))
        await me.sees("✗ rate", "Next step  Change this", "then check again.", "Why")

        # No notification covers the next step.
        me.main.say("A note that is as long as notes are. " * 5)
        await me.sees("A note that", "Next step  Change this", "check again.", "Why")
        lines = me.screen().split("\n")
        labels = [next(n for n, line in enumerate(lines) if word in line) for word in ("Observed", "Why", "Next step")]
        assert labels == sorted(labels)
        assert "✗ failed" not in me.screen()
        assert "passed  " not in me.criterion("publishes")
