"""`ros-tutor autograder`: make what Gradescope or Classroom 50 runs to judge each submission when it is handed in."""

from __future__ import annotations

import argparse
import math
import platform
from pathlib import Path

from tutor.cli import context, terminal
from tutor.cli.errors import PASSED
from tutor.errors import StorageError, UsageError

_SYSTEMS = ("gradescope", "classroom50")
_STEPS = ("none", "words")
_THEIR_MACHINES = "x86_64"

_NEXT = {
    "gradescope": """\
Upload {file} under Configure Autograder. Under Autograder Settings there, choose a container with 1 CPU and 1.5 GB or
more, and a time limit of {minutes:g} minutes.
""",
    "classroom50": """\
Put {file} into your classroom50 repository as CLASSROOM/autograders/ASSIGNMENT/autograder.py.
""",
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add `SYSTEM --exercise ID... --output FILE [--points FILE] [--steps none|words] [--time-limit MINUTES]`."""
    parser.add_argument("system", metavar="SYSTEM", choices=_SYSTEMS, help=" or ".join(_SYSTEMS))
    parser.add_argument("--exercise", metavar="ID", action="append", required=True, help="what to judge (repeatable)")
    parser.add_argument(
        "--output", metavar="FILE", type=Path, required=True, help="the zip (gradescope) or script (classroom50)"
    )
    parser.add_argument("--points", metavar="FILE", type=Path, help="what criteria are worth (points.toml)")
    parser.add_argument("--steps", choices=_STEPS, default="words", help="tell learners no next step (none), or words")
    parser.add_argument(
        "--time-limit", metavar="MINUTES", type=float, help="what the system is set to (gradescope 10, classroom50 15)"
    )


def run(arguments: argparse.Namespace) -> int:
    """Write the file, and say where it goes."""
    from tutor.grade.autograder import TIME_LIMITS_MIN, Settings, make, time_to_judge_s
    from tutor.grade.points import Points

    courses = context.choose_courses(arguments)
    course = context.load(courses)
    exercises = tuple(dict.fromkeys(course.find(exercise).id for exercise in arguments.exercise))
    if arguments.points is not None:
        Points.read(arguments.points, course)  # what is wrong in it is reported here, not to a learner
    system, output = arguments.system, arguments.output
    minutes = TIME_LIMITS_MIN[system] if arguments.time_limit is None else arguments.time_limit
    seconds = time_to_judge_s(system, minutes)
    if not 0 < seconds < math.inf:
        raise UsageError(
            f"--time-limit {minutes:g}: that leaves no time to judge; {TIME_LIMITS_MIN[system]:g} is usual"
        )
    if output.is_dir():
        raise UsageError(f"--output {output}: this is a folder, not a file")
    if platform.machine() != _THEIR_MACHINES:
        terminal.say(f"warning: this works on {platform.machine()} only, and {system} usually has {_THEIR_MACHINES}")
    settings = Settings(exercises, arguments.steps == "words", seconds)
    content = make(system, settings, arguments.points, context.only_folder(courses))
    try:
        output.write_bytes(content)
    except OSError as error:
        raise StorageError.of(f"write {output}", error) from error
    terminal.out(_NEXT[system].format(file=context.display_path(output), minutes=minutes))
    return PASSED
