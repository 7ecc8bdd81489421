"""The page of a mistake: with x, and unasked after several checks that failed by it; remarks after a pass."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from tests.tui import fakes
from tests.tui.conftest import open_app
from tutor.judge.events import CriterionJudged
from tutor.judge.result import Remark
from tutor.judge.verdict import Verdict
from tutor.tui.dialogs.explanation import ExplanationScreen

SIZES = [(120, 36), (80, 24)]
SAME = replace(fakes.BAD, cause="for the same reason as `range`", step="", same_as="range")
REMARKS = (
    Remark("shutdown-after-ctrl-c", "line 61 raises RCLError", "thermometer.py", 61),
    Remark("no-spin", "an integer is declared", "thermometer.py", 14),
)


async def checks(me: Any, rate: Verdict = fakes.BAD, **more: Any) -> None:
    """Check from any page, and wait until the attempt is on record."""
    before = len(me.main.model.progress.of("i1.1").attempts)
    await me.start_check()
    await me.engine_emits(*fakes.final_events(rate, **more))
    await me.end_check()
    await me.until(lambda: len(me.main.model.progress.of("i1.1").attempts) == before + 1, "the attempt is recorded")
    await me.pilot.pause()


def explained(me: Any) -> bool:
    return isinstance(me.app.screen, ExplanationScreen)


@pytest.mark.parametrize("size", SIZES)
async def test_x_explains_the_mistake_that_a_check_has_named(learner: Any, size: Any) -> None:
    async with learner(size) as me:
        await me.sees_no("x Why")
        await me.press("x")
        assert not explained(me)
        await checks(me)
        await me.sees("x Why", "Why", "rate used as a period: a period of", "x explains this mistake")
        await me.press("x")
        await me.sees("rate used as a period", "A rate in Hz is given to a timer, which takes seconds.", "Esc closes")
        await me.press("end")
        await me.sees("✓ Good", "See it")
        await me.press("home")
        await me.sees("A rate in Hz is given to a timer")
        await me.press("escape")
        await me.sees("Next step")
        assert not explained(me)
        await me.press("question_mark")
        await me.sees("Explain the mistake, with an example") if size == (120, 36) else None
        await me.press("escape", "ctrl+p", *"explain")
        await me.sees("Explain the mistake, with an example")


async def test_the_examples_are_coloured_and_differing_lines_are_marked(learner: Any) -> None:
    async with learner((120, 60)) as me:
        await checks(me)
        await me.press("x")
        await me.until(lambda: explained(me))
        await me.sees("✗ Bad", "✓ Good", "▌")
        bad, good = (each.text for each in me.app.screen.query(".explanation-code"))
        for example, colour in ((bad, "$bad"), (good, "$good")):
            styles = {str(span.style) for span in example.spans}
            assert colour in styles
            assert any(style.startswith("$code-") for style in styles)


@pytest.mark.parametrize("size", SIZES)
async def test_criteria_with_the_same_root_point_to_it_and_it_is_selected_first(learner: Any, size: Any) -> None:
    async with learner(size) as me:
        # The criterion that fails first during the check is not the one that shows the root.
        await me.start_check()
        await me.engine_emits(CriterionJudged("i1.1", fakes.result("rate", fakes.BAD)))
        await me.until(lambda: me.main.chosen_criterion == "rate")
        await me.engine_emits(*fakes.final_events(SAME, range=fakes.BAD))
        await me.sees("1 of 3 passed", "✗ range  ", "rate used as a period")
        assert me.main.chosen_criterion == "range"
        await me.end_check()
        await me.press("5", "down")
        await me.sees("✗ rate  ", "for the same reason as range")
        await me.sees_no("Next step")
        await me.press("x")
        await me.sees("A rate in Hz is given to a timer")
        await me.press("escape")
        link = next(iter(me.main.query_one("#part-why .part-text").query_ancestor("Part").query(".part-text")))
        await me.pilot.click(link, offset=(len("for the same reason as ") + 1, 0))
        await me.until(lambda: me.main.chosen_criterion == "range", "the link leads to the root")


async def test_the_third_check_in_a_row_explains_unasked_once_and_across_a_restart(tmp_path: Path) -> None:
    session = fakes.FakeSession(tmp_path / "learner")
    async with open_app(session) as me:
        await checks(me)
        await checks(me)
        assert not explained(me)
        await me.press("n", "p")
    async with open_app(session) as me:
        await checks(me)
        await me.until(lambda: explained(me), "the page is opened unasked")
        await me.sees("Your last 3 checks failed for this same reason", "A rate in Hz is given to a timer")
        await me.press("escape")
        await checks(me)  # not at every check after
        assert not explained(me)
    async with open_app(session) as me:
        await checks(me)
        assert not explained(me)
        await me.press("x")
        await me.until(lambda: explained(me), "x still explains")


async def test_another_mistake_or_a_pass_between_begins_the_count_again(learner: Any) -> None:
    async with learner() as me:
        for rate in (fakes.BAD, fakes.BAD, replace(fakes.BAD, mistake="no-spin"), fakes.BAD, fakes.BAD, fakes.GOOD):
            await checks(me, rate)
            assert not explained(me)
        bonus = replace(fakes.BAD, mistake="no-spin")
        for _ in range(3):  # a bonus does not count
            await checks(me, fakes.GOOD, shutdown=bonus)
            assert not explained(me)


async def test_a_learner_who_is_typing_is_told_and_not_interrupted(learner: Any) -> None:
    async with learner() as me:
        await checks(me)
        await checks(me)
        await me.focus_editor()
        await me.start_check()
        await me.type_text("# ")
        await me.engine_emits(*fakes.final_events(fakes.BAD))
        await me.sees("Your last 3 checks failed")
        assert not explained(me)
        await me.end_check()
        await me.type_text("typed")
        await me.until(lambda: "# typed" in me.editor.text)
        await me.press("escape")
        await checks(me)
        await me.until(lambda: explained(me), "opened when it can be")


@pytest.mark.parametrize("size", SIZES)
async def test_a_pass_has_at_most_two_remarks_which_x_explains_and_our_solution_to_compare_with(
    learner: Any, size: Any
) -> None:
    async with learner(size) as me:
        await checks(me, fakes.GOOD, remarks=REMARKS)
        await me.sees("I1.1 Sensor Publisher passed", "3 of 3 passed", "This works, but …")
        await me.sees("Line 61 raises RCLError", "Line 14: an integer is declared", "x explains why")
        assert me.session.progress().of("i1.1").is_passed
        await me.press("x")
        await me.sees("(1 of 2)", "x: the other one")
        await me.press("x")
        await me.sees("(2 of 2)", "no spin")
        await me.press("x")
        await me.until(lambda: not explained(me), "closed after the last one")
        await me.press("V")
        await me.sees("From yours to our solution", "+ # the solution")
        await me.pilot.resize_terminal(200, 60)
        await me.press("z")  # the whole width
        await me.until(lambda: re.search(r"yours +│ +ours", me.screen()) is not None, "two columns")
        await me.sees("│    1 # the solution")
        await me.press("z")
        await me.pilot.resize_terminal(*size)
        await me.sees("+ # the solution")
        await me.press("escape")

    async with learner_again(me.session, size) as again:  # the remarks are kept with the last check
        if size == (80, 24):
            await again.press("5")
        await again.sees("This works, but …", "Line 61 raises RCLError")


def learner_again(session: Any, size: Any) -> Any:
    return open_app(session, size)


async def test_before_a_pass_our_solution_is_shown_only_after_a_question(learner: Any) -> None:
    async with learner() as me:
        await checks(me)
        await me.press("V")
        await me.sees("Show our solution all the same?")


async def test_a_mistake_without_a_page_is_said_to_have_none(learner: Any) -> None:
    async with learner() as me:
        await checks(me, replace(fakes.BAD, mistake="of-another-version"))
        await me.press("x")
        await me.sees("There is no page on this mistake")
