"""Which checklist items a submission shows nothing of, though it passes a criterion: it meets it by other means."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Mapping

from tutor.content import Lesson
from tutor.engine.source import read_sources
from tutor.judge.result import CriterionResult
from tutor.judge.submission import Submission
from tutor.source.tree import parse


def read_all_sources(submission: Submission) -> Mapping[str, str]:
    """Map file names to the texts of the submission's files, and of the modules beside them that they import."""
    return {name: text for path in submission.files.values() for name, text in read_sources(path).items()}


def items_not_shown(lesson: Lesson, sources: Mapping[str, str], results: Iterable[CriterionResult]) -> tuple[str, ...]:
    """Return the ids of the items whose method (see `CriterionText.calls`) is not called, or in a node without spin.

    Of a submission that cannot be read, nothing is said.
    """
    used = {name for text in sources.values() for name in _names_in(text)}
    idle = {result.id for result in results if result.verdict.spins is False}
    return tuple(
        dict.fromkeys(
            item
            for criterion in lesson.criteria
            for item, method in criterion.calls
            if criterion.id in idle or (used and method not in used)
        )
    )


def _names_in(text: str) -> set[str]:
    try:
        nodes = list(ast.walk(parse(text)))
    except (SyntaxError, ValueError, RecursionError):
        return set()
    attributes = {node.attr for node in nodes if isinstance(node, ast.Attribute)}
    return attributes | {node.id for node in nodes if isinstance(node, ast.Name)}
