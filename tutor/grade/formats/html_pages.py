"""The grades as HTML pages: one for the class, and one of feedback for each learner. They load nothing."""

from __future__ import annotations

from tutor.grade.formats.html import class_page, feedback
from tutor.grade.formats.html.explanations import Explanations
from tutor.grade.gradebook import Gradebook


def files(gradebook: Gradebook) -> dict[str, str]:
    """Return the pages: `class.html`, and `feedback.html` in the folder of each learner."""
    explanations = Explanations.of(gradebook)
    pages = {_class_name(gradebook): class_page.render(gradebook, explanations)}
    for learner in gradebook.learners:
        pages[f"{learner.id}/feedback.html"] = feedback.render(gradebook, learner, explanations)
    return pages


def _class_name(gradebook: Gradebook) -> str:
    """Return "class.html", unless a learner's folder is called so."""
    taken = {learner.id.casefold() for learner in gradebook.learners}
    return next(name for name in ("class.html", "class-page.html", "page-of-the-class.html") if name not in taken)
