"""Records checks of the workspace's own files: as attempts in the progress, and what the last one found."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from tutor.judge.result import ExerciseResult
from tutor.judge.verdict import Status
from tutor.workspace.last_checks import LastCheck
from tutor.workspace.layout import Workspace
from tutor.workspace.progress import Progress, now
from tutor.workspace.progress_file import to_stderr


def record(
    results: Sequence[ExerciseResult],
    workspace: Workspace,
    criteria: Mapping[str, Sequence[str]],
    notify: Callable[[str], None] = to_stderr,
) -> Progress:
    """Save the results of checks; return the new progress. `criteria`: the ids of all criteria of each exercise.

    The findings of a check of some criteria only are not kept: they would hide those of the last whole check. Raises
    StorageError.
    """
    whole = {
        result.id for result in results if set(criteria[result.id]) <= {criterion.id for criterion in result.criteria}
    }

    def add(progress: Progress) -> Progress:
        for result in results:
            progress = progress.with_attempt(result, whole=result.id in whole)
        return progress

    progress = workspace.progress(notify).change(add)
    for result in results:
        if result.id in whole:
            last = progress.of(result.id).last
            at = now() if last is None or result.verdict is Status.ERROR else last.at
            workspace.last_checks(notify).write(LastCheck(at, result))
            if result.verdict is Status.PASSED:
                workspace.cases(notify).repaired(result.id)
    return progress
