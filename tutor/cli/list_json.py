"""`ros-tutor list --format json`: a document of the schema `ros-tutor/list/1`, described in docs/formats.md."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from tutor.cli.course_states import next_command, next_lesson

if TYPE_CHECKING:
    from tutor.content import Course, Lesson
    from tutor.workspace import ExerciseProgress, ExerciseState, Progress, Workspace

SCHEMA = "ros-tutor/list/1"


def render(course: Course, progress: Progress, workspace: Workspace) -> str:
    """Return the document as JSON text with a final newline."""
    from tutor.workspace import domain_of, states_of

    states = states_of(course.lessons, progress, workspace)
    following = next_lesson(course.lessons, states)
    document = {
        "schema": SCHEMA,
        "workspace": {
            "path": str(workspace.root),
            "exists": workspace.exists,
            "ros_domain_id": domain_of(workspace) if workspace.exists else None,
        },
        "passed": sum(exercise_state.is_passed for exercise_state in states.values()),
        "next": {"exercise": None if following is None else following.id, "command": next_command(following, states)},
        "exercises": [
            _exercise(lesson, progress.of(lesson.id), states[lesson.id], workspace) for lesson in course.lessons
        ],
    }
    return json.dumps(document, ensure_ascii=False, indent=2) + "\n"


def _exercise(
    lesson: Lesson, progress: ExerciseProgress, exercise_state: ExerciseState, workspace: Workspace
) -> dict[str, Any]:
    last = progress.last
    return {
        "id": lesson.id,
        "course": lesson.course,
        "title": lesson.title,
        "difficulty": lesson.difficulty.value,
        "beyond": lesson.beyond,
        "standing": exercise_state.state.value,
        "files": [str(workspace.path_of(file.name)) for file in lesson.files],
        "criteria": [{"id": criterion.id, "bonus": criterion.bonus} for criterion in lesson.criteria],
        "hints_shown": progress.hints,
        "attempts": len(progress.attempts),
        "last_attempt": None
        if last is None
        else {
            "at": last.at,
            "verdict": last.verdict.value,
            "judged": last.judged_of(criterion.id for criterion in lesson.criteria),
            "passed": list(last.passed),
        },
    }
