"""What opens below a learner's row: what did not pass, and why."""

from __future__ import annotations

from collections.abc import Iterator
from urllib.parse import quote

from tutor.content import Lesson
from tutor.grade.formats.csv_table import number
from tutor.grade.formats.html.diagnosis import following, points_of, remarks, told, verdict_details
from tutor.grade.formats.html.explanations import Explanations
from tutor.grade.formats.html.markup import Html, element, inline, joined
from tutor.grade.formats.html.matrix import WORDS
from tutor.grade.gradebook import Gradebook
from tutor.grade.learners import Learner
from tutor.grade.points import Score
from tutor.grade.results import Result
from tutor.judge.result import CriterionResult
from tutor.report.plain import REMARKS_HEADING, missing_lines


def details(gradebook: Gradebook, explanations: Explanations) -> Iterator[Html]:
    """Yield a template for each learner, which the page's script shows when a row is opened."""
    for index, learner in enumerate(gradebook.learners):
        yield element("template", *_learner(gradebook, learner, explanations), id=f"details-{index}")


def feedback_address(learner: Learner) -> str:
    """Return where a learner's page of feedback is, seen from the page of the class."""
    return f"{quote(learner.id, safe='')}/feedback.html"


def _learner(gradebook: Gradebook, learner: Learner, explanations: Explanations) -> Iterator[Html]:
    facts = [fact for fact in (learner.number, learner.email) if fact]
    link = element("a", "page of feedback", href=feedback_address(learner))
    name = element("h3", element("bdi", learner.name))
    yield element("header", name, element("p", joined([*facts, link], ", ")))
    sections, clean = [], []
    for lesson in gradebook.lessons:
        result, score = gradebook.result(learner, lesson), gradebook.score(learner, lesson)
        if result is None or score is None:
            continue
        parts = list(_exercise(result, score, explanations))
        if parts:
            sections.append(element("section", _heading(lesson, result, score), *parts))
        else:
            clean.append(lesson.id)
    if sections:
        yield element("div", *sections, class_="exercises")
    if clean:
        yield element("p", f"Everything passed in {', '.join(clean)}.", class_="quiet")


def _heading(lesson: Lesson, result: Result, score: Score) -> Html:
    points = "not known" if score.score is None else number(score.score)
    after = f"{WORDS[result.status]}, {points} of {number(score.max_score)} points"
    return element("h4", f"{lesson.id} {lesson.title}", " ", element("span", after, class_=f"status {result.status}"))


def _exercise(result: Result, score: Score, explanations: Explanations) -> Iterator[Html]:
    judged = result.judged
    if judged is None:
        yield element("p", result.report.message)
        return
    if judged.missing:
        yield joined(element("p", line) for line in missing_lines(judged))
        return
    criteria = [_criterion(criterion, score, explanations) for criterion in told(judged)]
    yield from criteria
    yield from filter(None, [following(judged)])
    for remark, line in remarks(judged):
        yield element("p", element("strong", REMARKS_HEADING), " ", inline(line), class_="remark")
        yield _about(remark.mistake, explanations)


def _criterion(criterion: CriterionResult, score: Score, explanations: Explanations) -> Html:
    points = points_of(score, criterion.id)
    bonus = [element("span", " (bonus)", class_="quiet")] if criterion.bonus else []
    heading = [element("span", element("code", criterion.id), " ", criterion.text, *bonus)]
    heading += [element("span", f" {points} points", class_="points")] if points else []
    mistake = criterion.verdict.mistake
    about = _about(mistake, explanations)
    return element("article", element("h5", *heading), verdict_details(criterion.verdict), about)


def _about(mistake: str, explanations: Explanations) -> Html:
    """Return a place for a mistake's page, which the page's script copies from the end of the page."""
    if mistake not in explanations:
        return Html()
    return element(
        "details", element("summary", f"About this mistake: {explanations.title(mistake)}"), data_copy=mistake
    )
