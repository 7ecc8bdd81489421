"""An exercise in a class: how many passed, and which mistakes were made, the most frequent first."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from tutor.content import Lesson
from tutor.grade.formats.html.explanations import Explanations
from tutor.grade.formats.html.markup import Html, element, inline
from tutor.grade.formats.html.matrix import WORDS
from tutor.grade.gradebook import Gradebook

_FREQUENT = 4
"""How many mistakes of an exercise are shown at once."""


def exercise_summary(gradebook: Gradebook, lesson: Lesson, explanations: Explanations) -> Html:
    """Return the summary of an exercise. A click on a mistake filters the table."""
    results = [result for learner in gradebook.learners if (result := gradebook.result(learner, lesson)) is not None]
    counts = Counter(result.status for result in results)
    heading = element("h3", element("span", lesson.id, class_="id"), " ", lesson.title)
    passed = _filter(lesson, "passed", element("strong", str(counts["passed"])), f" of {len(results)} passed")
    mistakes = gradebook.mistakes(lesson)
    return element(
        "article",
        element("header", heading, element("p", passed)),
        _bar(counts),
        _others(lesson, counts),
        _mistakes(lesson, mistakes, explanations),
        class_="exercise",
    )


def _bar(counts: Counter[str]) -> Html:
    """Return a bar in parts as long as their counts; screen readers have the same in words below."""
    total = sum(counts.values()) or 1
    parts, start = [], 0
    for status in WORDS:
        if count := counts[status]:
            parts.append(element("rect", x=start, y=0, width=count, height=1, class_=status))
            start += count
    box = f"0 0 {total} 1"
    return element("svg", *parts, viewBox=box, preserveAspectRatio="none", class_="bar", aria_hidden="true")


def _others(lesson: Lesson, counts: Counter[str]) -> Html:
    buttons = [
        _filter(lesson, status, element("span", class_=f"swatch {status}", aria_hidden="true"), f"{count} {words}")
        for status, words in WORDS.items()
        if (count := counts[status]) and status != "passed"
    ]
    return element("p", *buttons, class_="counts") if buttons else Html()


def _filter(lesson: Lesson, status: str, *label: str) -> Html:
    """Return a button that filters the table to the learners whose exercise has this status."""
    return element("button", *label, type="button", data_set_status=f"{lesson.id}={status}", aria_pressed="false")


def _mistakes(lesson: Lesson, mistakes: Sequence[tuple[str, str, int]], explanations: Explanations) -> Html:
    if not mistakes:
        return element("p", "No mistakes to talk about.", class_="quiet")
    items = [_mistake(lesson, *mistake, explanations) for mistake in mistakes]
    shown, more = items[:_FREQUENT], items[_FREQUENT:]
    if len(more) == 1:
        shown, more = items, []
    lists = [element("ol", *shown, class_="frequent")]
    if more:
        lists.append(
            element("details", element("summary", f"{len(more)} more"), element("ol", *more, class_="frequent"))
        )
    return element("div", *lists)


def _mistake(lesson: Lesson, id: str, name: str, count: int, explanations: Explanations) -> Html:
    title = explanations.title(id) if id in explanations else name
    of_learners = element("span", f" {'learner' if count == 1 else 'learners'}: ", class_="unseen")
    button = element(
        "button",
        element("span", str(count), of_learners, class_="number"),
        element("span", title, class_="title"),
        type="button",
        data_set_mistake=f"{lesson.id}/{id}",
        aria_pressed="false",
    )
    summary = explanations.summary(id)
    return element("li", button, *([element("p", inline(summary))] if summary else []))
