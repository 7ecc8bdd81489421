"""The grades as JUnit XML: a suite for each learner, a case for each criterion of each exercise."""

from __future__ import annotations

from tutor.grade.formats.csv_table import number
from tutor.grade.gradebook import Gradebook
from tutor.grade.learners import Learner
from tutor.report import junit


def render(gradebook: Gradebook, template: str | None = None) -> str:
    """Render UTF-8 XML. What passes, fails and is skipped is as in the report of a single check."""
    root = junit.new_document(sum(result.report.duration_s for result in gradebook.results.values()))
    for learner in gradebook.learners:
        results = gradebook.results_of(learner)
        suite = junit.add_suite(
            root, learner.name, sum(result.report.duration_s for result in results), _facts(gradebook, learner)
        )
        for result in results:
            # Readers of these files take a case in another suite for the same one, unless the class has another name.
            classname = f"{learner.id}.{result.exercise}"
            if result.judged is None:
                junit.add_unjudged(suite, classname, result.report)
            else:
                junit.add_cases(suite, result.judged, classname, steps=gradebook.steps)
        junit.add_remarks(suite, [result.judged for result in results if result.judged is not None])
    return junit.to_xml(root)


def _facts(gradebook: Gradebook, learner: Learner) -> dict[str, str]:
    facts = {"learner": learner.id, "number": learner.number, "email": learner.email}
    for lesson in gradebook.lessons:
        result, score = gradebook.result(learner, lesson), gradebook.score(learner, lesson)
        if result is not None and score is not None:
            points = "" if score.score is None else f", {number(score.score)} of {number(score.max_score)} points"
            facts[lesson.id] = f"{result.status}{points}"
    return facts
