"""The checklist: what counts as evidence for an item, and the documents made from it."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from datetime import date
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tutor.content import (
    Checklist,
    ChecklistGroup,
    ChecklistItem,
    Course,
    CriterionText,
    Difficulty,
    Lesson,
    Option,
    Prediction,
)
from tutor.judge.verdict import Status
from tutor.report.assessment import AssessedItem, Assessment, Evidence, Source, assess
from tutor.report.checklist_formats import FORMATS, format_of, render_checklist
from tutor.report.phrases import calendar_day, describe_evidence, describe_sources, near_day
from tutor.workspace import Attempt, ExerciseProgress, Help, Progress

NOON = "2026-01-02T12:00:00Z"
LATER = "2026-01-03T12:00:00Z"

CRITERIA = (
    CriterionText("defaults", "It starts.", False, True, "Start it.", ("declare",)),
    CriterionText("validation", "It refuses.", False, True, "Refuse it.", ("declare", "validate")),
    CriterionText("shutdown", "It ends.", True, False, "End it.", ("end",)),
)
LESSONS = tuple(
    Lesson(id, title, Difficulty.EASY, "I2", "Do it.", (), criteria, (), items, "", Path("lessons"))
    for id, title, criteria, items in (
        ("i2.1", "Parameters <b>", CRITERIA, ("declare", "validate", "end")),
        ("i2.2", "Launch | go", CRITERIA[:2], ("launch", "declare")),
    )
)
CHECKLIST = Checklist(
    (
        ChecklistGroup(
            "one",
            "Group <1> @all",
            (
                ChecklistItem("declare", "Declare a & b"),
                ChecklistItem("validate", "Refuse *bad* values"),
                ChecklistItem("end", "End cleanly"),
            ),
        ),
        ChecklistGroup("two", "Two", (ChecklistItem("launch", "Launch"), ChecklistItem("judge", "Judge"))),
    ),
    "Ready?",
    "Yes, go <on>.",
)
COURSE = Course(LESSONS, CHECKLIST)


def exercise(*attempts: Attempt, best: Status | None = None) -> ExerciseProgress:
    return ExerciseProgress(NOON, attempts, best)


def failed(*passed: str, at: str = NOON, version: str = "now", **more: Any) -> Attempt:
    return Attempt(at, Status.FAILED, passed, version=version, **more)


def passed(*ids: str, at: str = LATER, version: str = "now", **more: Any) -> Attempt:
    return Attempt(at, Status.PASSED, ids, version=version, **more)


def assessed(done: Progress, course: Course = COURSE) -> Assessment:
    """The assessment of files that are all of the version "now"."""
    return assess(course, done, {lesson.id: "now" for lesson in course.lessons})


def progress(ticks: str = "", **exercises: ExerciseProgress) -> Progress:
    return Progress(
        {key.replace("_", "."): value for key, value in exercises.items()}, dict.fromkeys(ticks.split(), NOON)
    )


def evidence(done: Progress, item: str) -> tuple[Evidence, ...]:
    return next(each.evidence for each in assessed(done).items if each.id == item)


def validation(*attempts: Attempt, best: Status | None = None) -> tuple[Evidence, ...]:
    return evidence(progress(i2_1=exercise(*attempts, best=best)), "validate")


ASKED = replace(
    COURSE,
    lessons=(
        *LESSONS,
        replace(
            LESSONS[1],
            id="i2.3",
            checklist=(),
            criteria=(),
            predictions=tuple(
                Prediction(id, Path("p.py"), "What?", (Option("a", "a"), Option("b", "b")), "So.", shows)
                for id, shows in (("one", ("judge",)), ("two", ("judge", "declare")), ("three", ()))
            ),
        ),
    ),
)
"""A course in which predictions show two items, though their lesson has no criterion that does."""


def predicted(*answers: tuple[str, bool]) -> tuple[AssessedItem, ...]:
    done = Progress()
    for prediction, right in answers:
        done = done.with_prediction("i2.3", prediction, right)
    return assessed(done, ASKED).items


def judge_of(items: tuple[AssessedItem, ...]) -> list[str]:
    (item,) = (item for item in items if item.id == "judge")
    return describe_evidence(item.evidence, lambda at: "today")


def test_predictions_are_evidence_once_all_that_show_an_item_have_come_true() -> None:
    assert judge_of(predicted(("one", True))) == []
    assert judge_of(predicted(("one", True), ("two", False))) == []
    both = predicted(("one", True), ("two", True))
    assert judge_of(both) == ["i2.3 predictions passed, today"]
    assert all(item.shown == (item.id in ("judge", "declare")) for item in both)


def test_an_answer_after_the_outcome_was_seen_says_so_and_a_right_one_is_kept() -> None:
    assert judge_of(predicted(("one", False), ("one", True), ("two", True))) == [
        "i2.3 predictions passed with answers, today"
    ]
    assert judge_of(predicted(("one", True), ("one", False), ("two", True))) == ["i2.3 predictions passed, today"]


def test_what_predictions_could_show_is_named() -> None:
    (item,) = (item for item in predicted() if item.id == "judge")
    assert item.sources == (Source("i2.3", (), ("one", "two")),)
    assert describe_sources(item.sources) == ["i2.3 predictions"]


@pytest.mark.parametrize("format", FORMATS)
def test_every_document_has_the_evidence_of_predictions(format: str) -> None:
    done = Progress().with_prediction("i2.3", "one", False).with_prediction("i2.3", "one", True)
    text = render_checklist(assessed(done.with_prediction("i2.3", "two", True), ASKED), format, at=NOON)
    if format != "json":
        assert "i2.3 predictions passed with answers, " in text
        return
    items = {item["id"]: item for group in json.loads(text)["groups"] for item in group["items"]}
    (piece,) = items["judge"]["evidence"]
    assert (piece["exercise"], piece["criterion"], piece["predictions"]) == ("i2.3", None, ["one", "two"])
    assert (piece["help"], piece["since_changed"]) == ("answers", False)


def test_a_criterion_that_passed_is_evidence_even_if_the_exercise_did_not() -> None:
    assert validation(failed("validation"), failed("validation", "defaults", at=LATER)) == (
        Evidence("i2.1", "validation", LATER),
    )
    assert evidence(progress(i2_1=exercise(failed("validation"))), "launch") == ()


def test_what_fails_in_the_files_as_they_are_is_no_evidence() -> None:
    before = failed("validation", version="before")
    assert validation(failed("validation"), failed(at=LATER)) == ()
    assert validation(before, failed(at=LATER)) == ()
    assert validation(before, passed("validation"), failed(at=LATER), best=Status.PASSED) == ()
    # It was not judged then: an attempt at another criterion, and one that ended in an error of ours.
    alone = failed("defaults", at=LATER, whole=False, judged=("defaults",))
    error = failed(at=LATER, errors=("validation",))
    for later in (alone, error):
        assert validation(failed("validation"), later) == (Evidence("i2.1", "validation", NOON),)


def test_what_passed_with_other_files_says_so() -> None:
    before = failed("validation", version="before")
    changed = Evidence("i2.1", "validation", NOON, changed=True)
    assert validation(before) == (changed,)
    assert validation(before, failed(at=LATER, version="between")) == (changed,)
    # Undone: the files are again what they were.
    assert validation(failed("validation"), failed(at=LATER, version="between")) == (
        Evidence("i2.1", "validation", NOON),
    )
    assert not changed.holds
    assert describe_evidence([changed], calendar_day) == ["i2.1 validation passed on 2026-01-02, since changed"]
    assert describe_evidence([changed], lambda at: "today") == ["i2.1 validation passed today, since changed"]


def test_attempts_from_before_versions_were_recorded_prove_nothing_of_the_files_as_they_are() -> None:
    old = failed("validation", version="")
    (known,) = validation(old)
    assert (known.changed, known.holds) == (None, False)
    assert describe_evidence([known], calendar_day) == ["i2.1 validation passed on 2026-01-02"]
    assert validation(old, failed(at=LATER, version="")) == ()
    assert validation(old, failed(at=LATER)) == ()
    assert evidence(progress(i2_1=exercise(failed("shutdown", version=""))), "end") == ()


def test_the_skeletons_own_code_is_no_evidence() -> None:
    everything = ("defaults", "validation", "shutdown")
    given = passed(*everything, given=("shutdown",))
    assert evidence(progress(i2_1=exercise(given, best=Status.PASSED)), "end") == ()
    done = progress(i2_1=exercise(given, passed(*everything), best=Status.PASSED))
    assert evidence(done, "end") == (Evidence("i2.1", "shutdown", LATER),)
    assert evidence(progress(i2_1=exercise(passed(*everything), given, best=Status.PASSED)), "end") == ()


def test_a_criterion_that_passed_by_other_means_is_no_evidence() -> None:
    both = ("defaults", "validation")
    by_loop = passed(*both, not_shown=("validate",))
    assert evidence(progress(i2_1=exercise(by_loop, best=Status.PASSED)), "validate") == ()
    done = progress(i2_1=exercise(by_loop, passed(*both), best=Status.PASSED))
    assert evidence(done, "validate") == (Evidence("i2.1", "validation", LATER),)


def test_help_before_the_first_pass_is_noted() -> None:
    hints, solution = failed("validation", help=Help.HINTS), passed("defaults", "validation", help=Help.SOLUTION)
    (first,) = validation(hints, solution, best=Status.PASSED)
    assert first.help is Help.HINTS
    assert describe_evidence([first], calendar_day) == ["i2.1 validation passed with hints, 2026-01-03"]
    done = progress(i2_1=exercise(hints, solution, best=Status.PASSED))
    (row, _) = assessed(done).exercises
    assert row.help is Help.SOLUTION
    assert "passed with solution, 2026-01-03 |" in render_checklist(assessed(done), "markdown", at=NOON)
    page = Page(render_checklist(assessed(done), "html", at=NOON))
    assert "passed with solution," in page.texts_in("td")
    assert "i2.1 validation passed with hints, 2026-01-03" in page.texts_in("span")
    document = json.loads(render_checklist(assessed(done), "json", at=NOON))
    assert document["exercises"][0]["help"] == "solution"
    assert document["groups"][0]["items"][1]["evidence"][0]["help"] == "hints"


def test_an_exercise_that_was_passed_with_other_files_says_so() -> None:
    done = progress(i2_1=exercise(passed("defaults", "validation", version="before"), best=Status.PASSED))
    assert "| passed, 2026-01-03, since changed |" in render_checklist(assessed(done), "markdown", at=NOON)
    assert ", since changed" in Page(render_checklist(assessed(done), "html", at=NOON)).texts_in("td")
    exercises = json.loads(render_checklist(assessed(done), "json", at=NOON))["exercises"]
    assert [each["since_changed"] for each in exercises] == [True, None]


def test_the_whole_exercise_is_evidence_for_an_item_that_no_criterion_covers() -> None:
    done = progress(i2_2=exercise(passed("defaults", "validation"), best=Status.PASSED))
    assert evidence(done, "launch") == (Evidence("i2.2", "", LATER),)
    assert evidence(progress(i2_2=exercise(failed("defaults"))), "launch") == ()


def test_what_was_reached_with_the_least_help_comes_first() -> None:
    alone, copied = failed("defaults"), failed("defaults", at=LATER, help=Help.SOLUTION)
    done = progress(i2_1=exercise(copied), i2_2=exercise(alone))
    assert [(each.exercise, each.help) for each in evidence(done, "declare")] == [
        ("i2.2", None),
        ("i2.1", Help.SOLUTION),
    ]


def test_what_holds_now_comes_first_and_an_old_pass_is_remembered() -> None:
    done = progress(
        i2_1=exercise(failed("defaults")),
        i2_2=exercise(failed("defaults", at=LATER, version="before"), best=Status.PASSED),  # its pass is not kept
    )
    assert [each.exercise for each in evidence(done, "declare")] == ["i2.1", "i2.2", "i2.2"]
    assert evidence(done, "declare")[-1] == Evidence("i2.2", "validation", "", changed=None)


def test_sources_of_possible_evidence() -> None:
    sources = {each.id: each.sources for each in assessed(Progress()).items}
    assert sources["declare"] == (
        Source("i2.1", ("defaults", "validation")),
        Source("i2.2", ("defaults", "validation")),
    )
    assert sources["launch"] == (Source("i2.2", ()),)
    assert sources["judge"] == ()
    assert describe_sources(sources["declare"]) == ["i2.1 defaults and validation", "i2.2 defaults and validation"]
    assert describe_sources(sources["launch"]) == ["i2.2"]


def test_days_are_formatted_for_people() -> None:
    today = date.fromisoformat(calendar_day(NOON))
    assert near_day(NOON, today) == "today"
    assert near_day(NOON, date.fromordinal(today.toordinal() + 1)) == "yesterday"
    assert near_day(NOON, date.fromordinal(today.toordinal() + 2)) == "2026-01-02"
    assert near_day("long ago", today) == calendar_day("long ago") == "long ago"


def test_evidence_is_one_phrase_per_exercise_and_day() -> None:
    found = [
        Evidence("i2.1", "defaults", LATER),
        Evidence("i2.1", "timer", LATER),
        Evidence("i2.1", "validation", LATER),
        Evidence("i2.1", "shutdown", NOON),
        Evidence("i2.2", "", ""),
    ]
    assert describe_evidence(found, calendar_day) == [
        "i2.1 defaults, timer and validation passed, 2026-01-03",
        "i2.1 shutdown passed, 2026-01-02",
        "i2.2 passed",
    ]
    assert describe_evidence(found, calendar_day, max_items=1) == [
        "i2.1 defaults, timer and validation passed, 2026-01-03",
        "2 more",
    ]


PASSED = exercise(failed("validation"), passed("defaults", "validation"), best=Status.PASSED)
HALF = progress("declare gone", i2_1=PASSED)
ALL = progress("declare validate end launch judge", i2_1=PASSED)


def test_ready_means_that_every_item_is_ticked() -> None:
    assert not assessed(HALF).ready
    assert assessed(HALF).ticked == 1  # a tick for an item that the course does not have is ignored
    assert assessed(ALL).ready
    assert not assessed(ALL, Course(LESSONS, Checklist())).ready


def test_markdown_is_a_task_list_for_github_with_a_table_of_the_exercises() -> None:
    text = render_checklist(assessed(HALF), "markdown", at=NOON)
    assert text.startswith("# Self-assessment checklist\n\n1 of 5 ticked, 1 of 2 exercises passed (2026-01-02).\n")
    assert (
        "## Group \\<1\\> @<!-- -->all\n\n- [x] Declare a & b (i2.1 defaults and validation passed, 2026-01-03)\n"
        in text
    )
    assert "- [ ] Refuse \\*bad\\* values (i2.1 validation passed, 2026-01-03)\n- [ ] End cleanly\n" in text
    assert "| i2.1 Parameters \\<b\\> | easy | passed, 2026-01-03 | 2 of 2 | 0 of 1 | 2 |\n" in text
    assert "| i2.2 Launch \\| go | easy | not started | 0 of 2 |  | 0 |\n" in text
    assert "Ready?" not in text
    assert "## Ready?\n\nYes, go \\<on\\>.\n" in render_checklist(assessed(ALL), "markdown", at=NOON)


def test_json_has_a_schema_and_all_items() -> None:
    document = json.loads(render_checklist(assessed(HALF), "json", at=NOON))
    assert list(document) == ["schema", "exported_at", "ticked", "total", "ready", "groups", "exercises"]
    assert (document["schema"], document["exported_at"]) == ("ros-tutor/checklist/1", NOON)
    assert (document["ticked"], document["total"], document["ready"]) == (1, 5, False)
    one = document["groups"][0]
    assert (one["id"], one["title"], one["ticked"], one["total"]) == ("one", "Group <1> @all", 1, 3)
    first, second, _ = one["items"]
    assert (first["ticked"], first["ticked_at"]) == (True, NOON)
    assert (second["id"], second["text"]) == ("validate", "Refuse *bad* values")
    assert (second["ticked"], second["ticked_at"]) == (False, None)
    assert second["evidence"] == [
        {
            "exercise": "i2.1",
            "criterion": "validation",
            "predictions": [],
            "passed_at": LATER,
            "since_changed": False,
            "help": None,
        }
    ]
    assert document["exercises"][0] == {
        "id": "i2.1",
        "title": "Parameters <b>",
        "difficulty": "easy",
        "beyond": False,
        "standing": "passed",
        "passed": True,
        "passed_at": LATER,
        "since_changed": False,
        "help": None,
        "criteria": {"passed": 2, "total": 2},
        "bonus": {"passed": 0, "total": 1},
        "attempts": 2,
        "last_attempt_at": LATER,
    }
    assert document["exercises"][1]["standing"] == "not started"
    assert json.loads(render_checklist(assessed(ALL), "json", at=NOON))["ready"] is True


class Page(HTMLParser):
    """The elements and texts of a page. Fails if elements are not closed in order."""

    VOID = frozenset({"meta", "input"})

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.words: list[tuple[str, str]] = []
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if data.strip():
            self.words.append((self.open[-1] if self.open else "", data.strip()))

    def texts_in(self, tag: str) -> list[str]:
        return [words for where, words in self.words if where == tag]


def test_html_is_a_single_page_that_loads_nothing() -> None:
    text = render_checklist(assessed(ALL), "html", at=NOON)
    page = Page(text)
    assert not {tag for tag, _ in page.elements} & {"script", "link", "img", "iframe", "object", "a"}
    for _, attributes in page.elements:
        assert not {"src", "href", "style", "onclick"} & attributes.keys()
    (style,) = page.texts_in("style")
    assert "url(" not in style
    assert "@import" not in style
    assert "prefers-color-scheme: dark" in style
    assert "@media print" in style


def test_html_is_accessible_to_screen_readers() -> None:
    page = Page(render_checklist(assessed(ALL), "html", at=NOON))
    assert page.texts_in("h1") == page.texts_in("title") == ["Self-assessment checklist"]
    assert page.texts_in("h2") == ["Ready?", "Group <1> @all", "Two", "Exercises"]
    assert "Yes, go <on>." in page.texts_in("p")
    assert page.texts_in("small") == ["3 of 3", "2 of 2", "1 of 2 passed"]
    ids = {attributes["id"] for _, attributes in page.elements if "id" in attributes}
    assert {a["aria-labelledby"] for tag, a in page.elements if tag == "section"} == ids
    boxes = [attributes for tag, attributes in page.elements if tag == "input"]
    assert len(boxes) == 5
    assert all("checked" in box for box in boxes)
    assert "Refuse *bad* values" in page.texts_in("label")
    assert "i2.1 validation passed, 2026-01-03" in page.texts_in("span")
    assert ("html", {"lang": "en"}) in page.elements
    headers = [attributes["scope"] for tag, attributes in page.elements if tag == "th"]
    assert headers == ["col"] * 6 + ["row"] * 2


def test_html_does_not_mention_ready_before_everything_is_ticked() -> None:
    page = Page(render_checklist(assessed(HALF), "html", at=NOON))
    assert "Ready?" not in page.texts_in("h2")
    assert ["checked" in attributes for tag, attributes in page.elements if tag == "input"] == [True] + [False] * 4


@settings(max_examples=30, deadline=None)
@given(st.text(alphabet=st.sampled_from("<>&\"'`|*_[]@#\\\n\r\t\x00\x1b\ud800a é中"), min_size=1, max_size=12))
def test_no_text_breaks_a_document(text: str) -> None:
    checklist = Checklist((ChecklistGroup("g", text, (ChecklistItem("i", text),)),), text, text)
    lesson = Lesson("x1.1", text, Difficulty.EASY, text, text, (), (), (), ("i",), "", Path("lessons"))
    done = Progress({"x1.1": exercise(passed(at=text), best=Status.PASSED)}, {"i": text})
    for format in FORMATS:
        rendered = render_checklist(assessed(done, Course((lesson,), checklist)), format, at=text)
        assert rendered.endswith("\n")
        assert not re.search("[\x00-\x08\x0b-\x1f\x7f-\x9f]", rendered)
        if format == "json":
            assert json.loads(rendered)["groups"][0]["title"] == text
        else:
            rendered.encode("utf-8")
        if format == "html":
            Page(rendered)


@pytest.mark.parametrize(
    ("name", "format"),
    [("a.md", "markdown"), ("a.HTML", "html"), ("a.htm", "html"), ("b.json", "json"), ("c.txt", None), ("md", None)],
)
def test_the_suffix_determines_the_format(name: str, format: str | None) -> None:
    assert format_of(Path(name)) == format
