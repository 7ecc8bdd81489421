"""The grades as a table: one line for each learner and exercise."""

from __future__ import annotations

import csv
from io import StringIO

from tutor.grade.gradebook import Gradebook
from tutor.terminal_text import printable

COLUMNS = (
    "learner",
    "name",
    "number",
    "email",
    "exercise",
    "status",
    "score",
    "max_score",
    "passed",
    "failed",
    "mistakes",
)

_FORMULA = ("=", "+", "-", "@", "\uff1d", "\uff0b", "\uff0d", "\uff20")
"""What begins a formula; the full-width forms do in Japanese."""


def render(gradebook: Gradebook, template: str | None = None) -> str:
    """Render UTF-8 text with a header line. `score` is empty where a fault of the tool left the work unjudged.

    `failed`: the required criteria that were not met, those included that were skipped because of another.
    """
    out = StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(COLUMNS)
    for learner in gradebook.learners:
        for lesson in gradebook.lessons:
            result, score = gradebook.result(learner, lesson), gradebook.score(learner, lesson)
            if result is None or score is None:
                continue
            judged = result.judged
            criteria = judged.criteria if judged is not None else ()
            passed = [criterion.id for criterion in criteria if criterion.verdict.passed]
            failed = [
                criterion.id
                for criterion, worth in zip(criteria, score.criteria, strict=True)
                if not criterion.verdict.passed and not criterion.bonus and worth.score is not None
            ]
            row = (
                learner.id,
                learner.name,
                learner.number,
                learner.email,
                lesson.id,
                result.status,
                "" if score.score is None else number(score.score),
                number(score.max_score),
                " ".join(passed),
                " ".join(failed),
                " ".join(judged.mistakes if judged is not None else ()),
            )
            writer.writerow([as_text(cell) for cell in row])
    return out.getvalue()


def number(value: float) -> str:
    """Return points as people write them: at most two decimals, and none where there are none."""
    return f"{value:.2f}".rstrip("0").rstrip(".")


def as_text(cell: str) -> str:
    """Return a cell that no spreadsheet takes for a formula, without control characters."""
    text = printable(cell)
    return f"'{text}" if text.lstrip().startswith(_FORMULA) else text
