"""The engine as a separate process: `python -m tutor.engine EXERCISE PATH` prints events as JSON lines.

The terminal app runs checks this way, so that it never shares a process with ROS.
"""

from __future__ import annotations

import argparse
import contextlib
import signal
import sys
from pathlib import Path

from tutor.content import load_course
from tutor.engine import run_check
from tutor.errors import ContentError, EngineError, SubmissionError, UnknownExercise
from tutor.interpreter import reduce_gc_frequency
from tutor.judge.events import Event, encode
from tutor.process.prctl import die_with_parent
from tutor.stop_signals import Stopped, run_until_stopped
from tutor.workspace import find_submission


def main() -> int:
    """Run one check.

    Exit code 0: judged, whatever the verdict; 2: wrong usage; 3: a fault; 130: interrupted. 2 and 3 are explained on
    stderr.
    """
    reduce_gc_frequency()
    parser = argparse.ArgumentParser(prog="python -m tutor.engine")
    parser.add_argument("exercise")
    parser.add_argument("path", type=Path)
    parser.add_argument("--criterion", action="append")
    parser.add_argument("--first", action="store_true")
    parser.add_argument("--lessons", type=Path)
    arguments = parser.parse_args()
    try:
        course = load_course(arguments.lessons)
        submission = find_submission(course.find(arguments.exercise), arguments.path, None)
    except (ContentError, SubmissionError, UnknownExercise) as error:
        print(error, file=sys.stderr)
        return 2
    only = frozenset(arguments.criterion) if arguments.criterion else None
    die_with_parent(signal.SIGINT)  # a killed app takes its check with it; SIGINT ends the check cleanly

    def print_event(event: Event) -> None:
        try:
            print(encode(event), flush=True)
        except BrokenPipeError:  # the reader is gone: only cleanup is left to do
            signal.raise_signal(signal.SIGINT)

    try:
        run_until_stopped(
            lambda: run_check([submission], course, only=only, on_event=print_event, first=arguments.first)
        )
    except EngineError as error:
        print(f"{error}. {error.hint}", file=sys.stderr)
        return 3
    except Stopped:
        return 130
    return 0


if __name__ == "__main__":
    with contextlib.suppress(KeyboardInterrupt):
        sys.exit(main())
    sys.exit(130)
