"""What a report says beside a verdict: why a criterion failed, where to begin, and what a pass does not show."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path

from tutor.content import Lesson
from tutor.content.loader import BUNDLED
from tutor.engine.check_errors import as_check_error, is_ours
from tutor.engine.loading import enter_checks
from tutor.engine.source import read_sources
from tutor.judge.check import Check
from tutor.judge.result import CriterionResult
from tutor.judge.submission import Submission
from tutor.judge.verdict import Failure, Status, Verdict
from tutor.source.tree import parse
from tutor.workspace.regular import read_regular


def explain(verdict: Verdict, check: Check) -> Verdict:
    """The verdict; if it is a failure, with the mistake that explains its symptom."""
    if not isinstance(verdict, Failure):
        return verdict
    from tutor.mistakes import explain as explain_failure  # late: it reads the source, and most criteria pass

    if check.mistakes.startswith("checks."):  # one of ours, which another course may have hidden
        enter_checks(BUNDLED / "checks")
    try:
        return explain_failure(verdict, check)
    except Exception as error:  # an entry of the exercise's own catalogue may be wrong
        module = sys.modules.get(check.mistakes)
        source = Path(module.__file__) if module is not None and module.__file__ else None
        if source is None or is_ours(source):
            raise
        raise as_check_error(error, source.parent) or error from error


def first_todo(lesson: Lesson, submission: Submission) -> str:
    """The place of the first TODO ("server.py, line 8") if every present file is an untouched skeleton, else ""."""
    todos = []
    for file in lesson.files:
        path = submission.files.get(file.name)
        if path is None:
            continue
        try:
            skeleton = file.skeleton.read_bytes()
            if read_regular(path, len(skeleton)) != skeleton:
                return ""
        except OSError:
            return ""
        text = skeleton.decode("utf-8")
        todos += [f"{file.name}, line {n}" for n, line in enumerate(text.splitlines(), 1) if "TODO" in line]
    return todos[0] if todos else ""


def point_to_todo(verdict: Verdict, todo: str, hint: str) -> Verdict:
    """Point a failed verdict on an untouched skeleton (`todo` is not "") to `todo` and the criterion's `hint`.

    This replaces a step that would give away the code. Other verdicts are returned unchanged.
    """
    if verdict.status is not Status.FAILED or not todo:
        return verdict
    return replace(verdict, step=f"work through the TODOs of the skeleton, from {todo} on. {hint}".strip())


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
