"""A learner's page of feedback: what passed, and for the rest what was expected, seen, and what to do next."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from tutor.content import Lesson
from tutor.grade.formats.csv_table import number
from tutor.grade.formats.html.diagnosis import following, points_of, remarks, told, verdict_details
from tutor.grade.formats.html.explanations import Explanations
from tutor.grade.formats.html.markup import Html, document, element, inline, joined
from tutor.grade.gradebook import Gradebook
from tutor.grade.learners import Learner
from tutor.grade.points import Score
from tutor.grade.results import Result
from tutor.judge.result import CriterionResult, ExerciseResult
from tutor.judge.verdict import Status
from tutor.judge.wording import counted
from tutor.report.phrases import calendar_day
from tutor.report.plain import REMARKS_HEADING, missing_lines

_STATUS = {"passed": "passed", "failed": "not there yet", "missing": "nothing to judge", "error": "not judged"}

_FAULT = "This could not be judged this time. It is no fault of yours, and it costs you no points: your teacher knows."


def render(gradebook: Gradebook, learner: Learner, explanations: Explanations) -> str:
    """Render the page of one learner. It says nothing of any other, and nothing that is for the teacher only."""
    found = [
        (lesson, result, score)
        for lesson in gradebook.lessons
        if (result := gradebook.result(learner, lesson)) is not None
        and (score := gradebook.score(learner, lesson)) is not None
    ]
    day = max((calendar_day(result.graded_at) for _, result, _ in found), default="")
    top = element(
        "header",
        element("p", joined([gradebook.title, *([day] if day else [])], ", "), class_="quiet"),
        element("h1", "Feedback for ", element("bdi", learner.name)),
        element("p", _opening([result for _, result, _ in found]), class_="opening"),
    )
    overview = [_overview(gradebook, learner, found)] if len(found) > 1 else []
    sections = (
        _exercise(lesson, result, score, explanations, steps=gradebook.steps) for lesson, result, score in found
    )
    body = (top, element("main", *overview, *sections))
    title = f"Feedback for {learner.name}"
    return document(title, body, styles=("common.css", "feedback.css"))


def _opening(results: Sequence[Result]) -> str:
    statuses = [result.status for result in results]
    passed, total = statuses.count("passed"), len(statuses)
    if passed == total:
        return "Everything passed. Well done!"
    if passed:
        return f"You passed {passed} of {counted(total, 'exercise')}. Here is what would bring you the rest of the way."
    if set(statuses) == {"error"}:
        return "Nothing could be judged this time."
    if set(statuses) == {"missing"}:
        return "There was nothing to judge yet. Here is what was looked for, and what was found."
    return "You are on your way. Here is what was seen, and what to look at next."


# --- all exercises ---


def _overview(gradebook: Gradebook, learner: Learner, found: list[tuple[Lesson, Result, Score]]) -> Html:
    head = element(
        "tr",
        element("th", "Exercise", scope="col"),
        element("th", "Status", scope="col"),
        element("th", "Criteria", scope="col", class_="number criteria"),
        element("th", "Points", scope="col", class_="number"),
    )
    rows = [_overview_row(lesson, result, score) for lesson, result, score in found]
    total = gradebook.total(learner)
    label = element("th", "Total" if total.complete else "So far", scope="row", colspan=2)
    tally = element("td", _tally([result.judged for _, result, _ in found]), class_="number criteria")
    points = element("td", f"{number(total.score)} of {number(total.max_score)}", class_="number")
    table = (element("thead", head), element("tbody", *rows), element("tfoot", element("tr", label, tally, points)))
    caption = element("caption", "Your exercises", class_="unseen")
    return element("div", element("table", caption, *table, class_="overview"), class_="scroll")


def _overview_row(lesson: Lesson, result: Result, score: Score) -> Html:
    link = element("a", element("b", lesson.id), " ", lesson.title, href=f"#{lesson.id}")
    return element(
        "tr",
        element("th", link, scope="row"),
        element("td", _status(result)),
        element("td", _tally([result.judged]), class_="number criteria"),
        element("td", _points(score), class_="number"),
    )


def _status(result: Result) -> Html:
    return element("span", _STATUS[result.status], class_=f"status {result.status}")


def _tally(exercises: Iterable[ExerciseResult | None]) -> str:
    """Return how many of the required criteria passed; "" if none could be judged."""
    required = [
        criterion for judged in exercises if judged is not None for criterion in judged.criteria if not criterion.bonus
    ]
    return f"{sum(criterion.verdict.passed for criterion in required)} of {len(required)}" if required else ""


def _points(score: Score) -> str:
    return f"{'?' if score.score is None else number(score.score)} of {number(score.max_score)}"


# --- one exercise ---


def _exercise(lesson: Lesson, result: Result, score: Score, explanations: Explanations, *, steps: bool) -> Html:
    heading = element("h2", element("span", lesson.id, class_="id"), " ", lesson.title, id=lesson.id)
    about = element("p", _status(result), " ", element("span", f"{_points(score)} points", class_="quiet"))
    judged = result.judged
    if judged is None:
        parts = [element("p", _FAULT)]
    elif judged.missing:
        lines = ["There was nothing to judge here.", *missing_lines(judged)]
        parts = [element("p", line) for line in lines]
    else:
        parts = list(_judged(judged, score, explanations, steps=steps))
    return element("section", element("header", heading, about), *parts, aria_labelledby=lesson.id)


def _judged(judged: ExerciseResult, score: Score, explanations: Explanations, *, steps: bool) -> Iterator[Html]:
    passed = [criterion for criterion in judged.criteria if criterion.verdict.passed]
    if passed:
        yield element("h3", "What works")
        yield element("ul", *(_passed(criterion, score) for criterion in passed), class_="works")
    own, others = told(judged), following(judged)
    if own or others:
        required = [criterion for criterion in own if not criterion.bonus]
        yield element("h3", "What to look at next" if required or others else "Beyond what is asked for")
        yield from (_criterion(criterion, score, explanations, steps=steps) for criterion in own)
    if others:
        yield element("p", "These were not judged on their own:", class_="quiet")
        yield others
    if judged.remarks:
        yield element("h3", REMARKS_HEADING)
        for remark, line in remarks(judged):
            yield element("p", inline(line))
            yield from _about(remark.mistake, explanations)


def _passed(criterion: CriterionResult, score: Score) -> Html:
    points = points_of(score, criterion.id).partition(" ")[0]
    return element("li", element("span", criterion.text, *_bonus(criterion)), *_right(points))


def _criterion(criterion: CriterionResult, score: Score, explanations: Explanations, *, steps: bool) -> Html:
    label = element("span", element("code", criterion.id), " ", criterion.text, *_bonus(criterion))
    heading = element("h4", label, *_right(points_of(score, criterion.id)))
    if criterion.verdict.status is Status.ERROR:
        return element("article", heading, element("p", _FAULT))
    about = _about(criterion.verdict.mistake, explanations)
    return element("article", heading, verdict_details(criterion.verdict, steps=steps), *about)


def _bonus(criterion: CriterionResult) -> Iterator[Html]:
    if criterion.bonus:
        yield element("span", " (bonus)", class_="quiet")


def _right(points: str) -> Iterator[Html]:
    if points:
        yield element("span", f" {points}", element("span", " points", class_="unseen"), class_="points")


def _about(mistake: str, explanations: Explanations) -> Iterator[Html]:
    if mistake in explanations:
        summary = element("summary", f"About this mistake: {explanations.title(mistake)}")
        yield element("details", summary, explanations.page(mistake))
