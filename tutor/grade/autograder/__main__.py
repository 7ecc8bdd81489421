"""Judges one learner's submission where an autograder runs: `python -m tutor.grade.autograder SYSTEM ...`.

It prints a JSON object: from the names of the files that the system expects to their texts. Who started this process
writes these, so that the submission cannot. Exit code 0: judged, whatever the verdict; 3: a fault, told on stderr.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from tutor.content import load_course
from tutor.errors import EngineError, TutorError
from tutor.grade.autograder import COURSE, POINTS, SETTINGS, Settings
from tutor.grade.autograder.judging import judge, say
from tutor.grade.formats.classroom50 import result_document
from tutor.grade.formats.feedback_text import fault_of
from tutor.grade.formats.gradescope import results_document
from tutor.grade.points import Points
from tutor.grade.results import Result
from tutor.interpreter import reduce_gc_frequency
from tutor.judge.result import ExerciseResult, Report
from tutor.report import markdown
from tutor.stop_signals import Stopped

_FAULT, _INTERRUPTED = 3, 130


def main() -> int:
    """Judge, and print the files."""
    reduce_gc_frequency()
    arguments = _parse(sys.argv[1:])
    try:
        files = _run(_FILES_OF[arguments.system], arguments.bundle, arguments.submission)
    except Stopped:
        return _INTERRUPTED
    except (TutorError, OSError) as error:
        hint = getattr(error, "hint", "")
        say(f"{error}; {hint}" if hint else str(error))
        return _FAULT
    print(json.dumps(files))
    return 0


def _parse(words: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m tutor.grade.autograder")
    parser.add_argument("system", choices=tuple(_FILES_OF))
    parser.add_argument("--bundle", type=Path, required=True, help="what was packed for this system, unpacked")
    parser.add_argument("--submission", type=Path, required=True, help="the learner's folder")
    return parser.parse_args(words)


_Render = Callable[[Sequence[Result], Points, Settings], dict[str, str]]


def _run(render: _Render, bundle: Path, submission: Path) -> dict[str, str]:
    settings = Settings.read(bundle / SETTINGS)
    lessons = bundle / COURSE if (bundle / COURSE).is_dir() else None
    course = load_course(lessons)
    points = Points.read(bundle / POINTS, course) if (bundle / POINTS).is_file() else Points()
    return render(judge(submission, settings, course, lessons), points, settings)


def _gradescope(results: Sequence[Result], points: Points, settings: Settings) -> dict[str, str]:
    return {"results.json": _text(results_document(results, points, steps=settings.steps))}


def _classroom50(results: Sequence[Result], points: Points, settings: Settings) -> dict[str, str]:
    """Raises EngineError if anything could not be judged: to Classroom 50 that is an error, and no score."""
    faults = [f"{result.exercise}: {fault_of(result)}" for result in results if result.status == "error"]
    if faults:
        raise EngineError(f"not judged: {', '.join(faults)}", "run the job again")
    document = result_document(results, points, os.environ, steps=settings.steps)
    exercises = [result.judged for result in results if result.judged is not None]
    if not settings.steps:
        exercises = [_without_steps(exercise) for exercise in exercises]
    duration_s = sum(result.report.duration_s for result in results)
    report = Report(results[0].report.environment, tuple(exercises), duration_s)
    heading = f"**{document['score']} of {document['max-score']} points**\n\n"
    return {"result.json": _text(document), "release-body.md": heading + markdown.render(report)}


def _without_steps(exercise: ExerciseResult) -> ExerciseResult:
    criteria = (
        replace(criterion, verdict=replace(criterion.verdict, step="", mistake="")) for criterion in exercise.criteria
    )
    return replace(exercise, criteria=tuple(criteria))


def _text(document: Mapping[str, object]) -> str:
    return json.dumps(document, ensure_ascii=False, indent=1, allow_nan=False) + "\n"


_FILES_OF: dict[str, _Render] = {"gradescope": _gradescope, "classroom50": _classroom50}


if __name__ == "__main__":
    sys.exit(main())
