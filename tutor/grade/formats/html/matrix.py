"""The table of a class: a row for each learner, a column for each criterion, grouped by exercise."""

from __future__ import annotations

from collections.abc import Iterator

from tutor.content import CriterionText, Lesson
from tutor.grade.formats.csv_table import number
from tutor.grade.formats.html.markup import Html, element
from tutor.grade.gradebook import Gradebook
from tutor.grade.learners import Learner
from tutor.grade.results import Result
from tutor.judge.verdict import Status
from tutor.report.plain import one_line

WORDS = {"passed": "passed", "failed": "failed", "missing": "nothing to judge", "error": "not judged"}
"""What a page says of each status of a result."""


def matrix_of(gradebook: Gradebook) -> Html:
    """Return the table. Its rows and cells have data attributes by which the page's script sorts and filters them."""
    groups = [element("colgroup", element("col", span=2))]
    groups += [element("colgroup", element("col", span=1 + len(lesson.criteria))) for lesson in gradebook.lessons]
    caption = element("caption", "Learners and criteria", class_="unseen")
    rows = [_row(gradebook, index, learner) for index, learner in enumerate(gradebook.learners)]
    body = element("tbody", *rows)
    return element("table", caption, *groups, _head(gradebook), body, _foot(gradebook), id="matrix")


def criterion_state(result: Result | None, criterion: str) -> tuple[str, str, str]:
    """Return how a criterion ended: a kind for its looks, words, and the mistake by which it failed ("" if none)."""
    if result is None:
        return "none", "not graded", ""
    judged = result.judged
    if judged is None:
        return "error", WORDS["error"], ""
    if judged.missing:
        return "missing", WORDS["missing"], ""
    verdict = next((outcome.verdict for outcome in judged.criteria if outcome.id == criterion), None)
    if verdict is None:
        return "none", "not graded", ""
    if verdict.status is Status.ERROR:
        return "error", WORDS["error"], ""
    if verdict.same_as:
        return "same", f"failed, as {verdict.same_as}", verdict.mistake
    return verdict.status.value, verdict.status.value, verdict.mistake


def statuses(gradebook: Gradebook, learner: Learner) -> list[str]:
    """Return what a learner is found by: "i1.1=passed" for each exercise, and "passed" if that is so for all."""
    found = {
        lesson.id: result.status
        for lesson in gradebook.lessons
        if (result := gradebook.result(learner, lesson)) is not None
    }
    passed_all = ["passed"] if list(found.values()) == ["passed"] * len(gradebook.lessons) else []
    others = [status for status in WORDS if status != "passed" and status in found.values()]
    return [*passed_all, *others, *(f"{exercise}={status}" for exercise, status in found.items())]


# --- head and foot ---


def _head(gradebook: Gradebook) -> Html:
    top = [
        element("th", _sort_button(0, "Learner"), scope="col", rowspan=2, class_="name", aria_sort="ascending"),
        element("th", _sort_button(1, "Points"), scope="col", rowspan=2, class_="total"),
    ]
    below = []
    column = 2
    for lesson in gradebook.lessons:
        title = (element("span", lesson.id, class_="id"), " ", element("span", lesson.title, class_="title"))
        top.append(element("th", *title, scope="colgroup", colspan=1 + len(lesson.criteria), class_="start"))
        label = (_unseen(f"{lesson.id} "), "points")
        below.append(element("th", _sort_button(column, *label), scope="col", class_="points start"))
        for criterion in lesson.criteria:
            column += 1
            below.append(_criterion_head(column, lesson, criterion))
        column += 1
    return element("thead", element("tr", *top), element("tr", *below))


def _criterion_head(column: int, lesson: Lesson, criterion: CriterionText) -> Html:
    text = criterion.text + (" (bonus)" if criterion.bonus else "")
    label = [_unseen(f"{lesson.id} "), criterion.id]
    label += [_unseen(" (bonus)")] if criterion.bonus else []
    kind = "criterion bonus" if criterion.bonus else "criterion"
    return element("th", _sort_button(column, *label), scope="col", class_=kind, title=text)


def _sort_button(column: int, *label: str) -> Html:
    return element("button", element("span", *label), type="button", data_column=column)


def _foot(gradebook: Gradebook) -> Html:
    """Return the row that counts how many learners passed each criterion."""
    cells = [element("th", "Passed", scope="row", class_="name"), element("td")]
    for lesson in gradebook.lessons:
        results = [gradebook.result(learner, lesson) for learner in gradebook.learners]
        counts = [sum(result is not None and result.status == "passed" for result in results)]
        counts += [
            sum(criterion_state(result, criterion.id)[0] == "passed" for result in results)
            for criterion in lesson.criteria
        ]
        cells += [
            element("td", str(count), class_="points start" if place == 0 else False)
            for place, count in enumerate(counts)
        ]
    return element("tfoot", element("tr", *cells))


# --- rows ---


def _row(gradebook: Gradebook, index: int, learner: Learner) -> Html:
    total = gradebook.total(learner)
    cells = [_name(index, learner)]
    points = number(total.score) + ("" if total.complete else " ?")
    cells.append(element("td", points, class_="points total", data_value=number(total.score)))
    for lesson in gradebook.lessons:
        cells += _cells(gradebook, learner, lesson)
    mistakes = [
        f"{lesson.id}/{mistake}"
        for lesson in gradebook.lessons
        if (result := gradebook.result(learner, lesson)) is not None and result.judged is not None
        for mistake in result.judged.mistakes
    ]
    return element(
        "tr",
        *cells,
        data_learner=learner.id,
        data_find=one_line(f"{learner.name} {learner.id} {learner.number} {learner.email}"),
        data_status=" ".join(statuses(gradebook, learner)),
        data_mistakes=" ".join(mistakes),
    )


def _name(index: int, learner: Learner) -> Html:
    name = element("bdi", one_line(learner.name, 100))
    button = element("button", name, type="button", aria_expanded="false", data_details=f"details-{index}")
    return element("th", button, scope="row", class_="name")


def _cells(gradebook: Gradebook, learner: Learner, lesson: Lesson) -> Iterator[Html]:
    result, score = gradebook.result(learner, lesson), gradebook.score(learner, lesson)
    if result is None or score is None:
        yield element("td", _unseen("not graded"), class_="points start none", data_value=-2)
    else:
        value = "?" if score.score is None else number(score.score)
        kind = f"points start {result.status}"
        order = "-1" if score.score is None else value
        yield element("td", _unseen(f"{WORDS[result.status]} "), value, class_=kind, data_value=order)
    for criterion in lesson.criteria:
        kind, words, mistake = criterion_state(result, criterion.id)
        key = f"{lesson.id}/{mistake}" if mistake else False
        bonus = " bonus" if criterion.bonus else ""
        yield element("td", words, class_=f"mark {kind}{bonus}", data_mistake=key)


def _unseen(words: str) -> Html:
    return element("span", words, class_="unseen")
