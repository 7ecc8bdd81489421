"""The page of a class, for its teacher: which mistakes are frequent, and who passed what."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence

from tutor.grade.formats.html.class_details import details, feedback_address
from tutor.grade.formats.html.explanations import Explanations
from tutor.grade.formats.html.markup import Html, document, element, joined
from tutor.grade.formats.html.matrix import WORDS, matrix_of, statuses
from tutor.grade.formats.html.summary import exercise_summary
from tutor.grade.gradebook import Gradebook
from tutor.judge.wording import counted
from tutor.report.phrases import calendar_day


def render(gradebook: Gradebook, explanations: Explanations) -> str:
    """Render the page of the class."""
    body = (
        element("a", "Skip to the table", href="#learners", class_="skip"),
        element("header", element("h1", gradebook.title), *_about(gradebook)),
        element("main", _exercises(gradebook, explanations), _learners(gradebook), _mistakes(gradebook, explanations)),
        *details(gradebook, explanations),
    )
    return document(gradebook.title, body, styles=("common.css", "class.css"), script="class.js")


def _about(gradebook: Gradebook) -> Iterator[Html]:
    learners, exercises = len(gradebook.learners), len(gradebook.lessons)
    done = sum("passed" in statuses(gradebook, learner) for learner in gradebook.learners)
    parts = [counted(learners, "learner"), counted(exercises, "exercise"), f"{done} passed everything"]
    days = sorted({calendar_day(result.graded_at) for result in gradebook.results.values()})
    if days:
        parts.append(f"judged on {days[0]}" if len(days) == 1 else f"judged from {days[0]} to {days[-1]}")
    yield element("p", ", ".join(parts), ".")
    if gradebook.errors:
        many = counted(len(gradebook.errors), "result")
        text = f"{many} could not be judged, by a fault of the tool or the machine. The same command tries again. "
        button = element("button", "Show them", type="button", data_set_status="error", aria_pressed="false")
        yield element("p", text, button, class_="fault")


# --- exercises ---


def _exercises(gradebook: Gradebook, explanations: Explanations) -> Html:
    articles = [exercise_summary(gradebook, lesson, explanations) for lesson in gradebook.lessons]
    heading = element("h2", "Where the next lesson can begin", id="exercises")
    return element("section", heading, element("div", *articles, class_="exercises"), aria_labelledby="exercises")


# --- learners ---


def _learners(gradebook: Gradebook) -> Html:
    count = element("output", counted(len(gradebook.learners), "learner"), id="count")
    table = element(
        "div", matrix_of(gradebook), class_="scroll", role="region", aria_labelledby="learners", tabindex=0, id="scroll"
    )
    links = (
        element("li", element("a", element("bdi", learner.name), href=feedback_address(learner)))
        for learner in gradebook.learners
    )
    without_script = element("noscript", element("p", "Feedback for each learner:"), element("ul", *links))
    return element(
        "section",
        element("h2", "Learners", id="learners", tabindex=-1),
        _controls(gradebook, count),
        element("div", id="banner", hidden=True, tabindex=-1),
        table,
        _legend(),
        without_script,
        aria_labelledby="learners",
    )


def _controls(gradebook: Gradebook, count: Html) -> Html:
    name = element("input", type="search", id="find", autocomplete="off", spellcheck="false")
    clear = element("button", "Show all", type="button", id="clear", hidden=True)
    return element(
        "form",
        element("label", "Name", name),
        element("label", "Status", element("select", *_status_options(gradebook), id="status")),
        element("label", "Mistake", element("select", *_mistake_options(gradebook), id="mistake")),
        element("div", count, clear, class_="count"),
        class_="controls",
        role="search",
    )


def _status_options(gradebook: Gradebook) -> Iterator[Html]:
    counts = Counter(token for learner in gradebook.learners for token in statuses(gradebook, learner))
    yield element("option", "any", value="")
    in_all = (
        ("passed", "passed everything"),
        ("failed", "failed something"),
        ("missing", "something to hand in"),
        ("error", "something not judged"),
    )
    yield from (_option(token, words, counts[token]) for token, words in in_all if counts[token])
    for lesson in gradebook.lessons:
        tokens = [(f"{lesson.id}={status}", words) for status, words in WORDS.items()]
        options = [_option(token, f"{lesson.id} {words}", counts[token]) for token, words in tokens if counts[token]]
        yield element("optgroup", *options, label=f"{lesson.id} {lesson.title}")


def _mistake_options(gradebook: Gradebook) -> Iterator[Html]:
    yield element("option", "any", value="")
    for lesson in gradebook.lessons:
        options = [_option(f"{lesson.id}/{id}", name, count) for id, name, count in gradebook.mistakes(lesson)]
        if options:
            yield element("optgroup", *options, label=f"{lesson.id} {lesson.title}")


def _option(value: str, words: str, count: int) -> Html:
    return element("option", f"{words} ({count})", value=value)


def _legend() -> Html:
    marks = (
        ("passed", "passed"),
        ("failed", "failed"),
        ("same", "failed for the reason of another criterion"),
        ("skipped", "not judged, since another one failed"),
        ("missing", WORDS["missing"]),
        ("error", "not judged, by a fault of the tool or the machine"),
    )
    items = (element("li", element("span", class_=f"mark {kind}", aria_hidden="true"), words) for kind, words in marks)
    return element("ul", *items, class_="legend")


# --- mistakes ---


def _mistakes(gradebook: Gradebook, explanations: Explanations) -> Html:
    pages = [
        element(
            "details",
            element("summary", element("span", explanations.title(id), class_="title"), _where(exercises)),
            explanations.page(id),
            data_page=id,
        )
        for id, exercises in sorted(
            _mistakes_made(gradebook).items(), key=lambda pair: explanations.title(pair[0]).casefold()
        )
        if id in explanations
    ]
    if not pages:
        return Html()
    heading = element("h2", "About these mistakes", id="mistakes")
    return element("section", heading, *pages, aria_labelledby="mistakes", class_="mistakes")


def _where(exercises: Sequence[str]) -> Html:
    return joined((" ", element("span", ", ".join(exercises), class_="where")))


def _mistakes_made(gradebook: Gradebook) -> dict[str, list[str]]:
    """Return in which exercises each mistake was made, also in bonus criteria and by what works nevertheless."""
    found: dict[str, dict[str, None]] = {}
    for lesson in gradebook.lessons:
        for learner in gradebook.learners:
            result = gradebook.result(learner, lesson)
            judged = result.judged if result is not None else None
            if judged is None:
                continue
            ids = [criterion.verdict.mistake for criterion in judged.criteria]
            for id in filter(None, [*ids, *(remark.mistake for remark in judged.remarks)]):
                found.setdefault(id, {})[lesson.id] = None
    return {id: list(exercises) for id, exercises in found.items()}
