"""How long a check of our solutions takes, beside the longest wait that its scenarios ask for.

    uv run python -m tests.benchmarks.checks [EXERCISE ...] [--times 5]

Each check runs in a process of its own, from its start to its end: Python, ROS, every scenario, the clean-up.
"""

from __future__ import annotations

import argparse
import statistics
import subprocess
import sys
import time

from tutor.content import load_course
from tutor.engine.modules import load_check

PROGRAM = "import sys; from tutor.cli import main; sys.exit(main())"


def main() -> int:
    """Print one line for each exercise. Exit code 1 where a check did not pass: its time would mean nothing."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("exercises", nargs="*")
    parser.add_argument("--times", type=int, default=5)
    arguments = parser.parse_args()
    course = load_course()
    chosen = [course.find(each) for each in arguments.exercises] or list(course.lessons)
    print(f"{'exercise':<10}{'asks':>8}{'allowed':>9}{'min':>8}{'median':>8}{'max':>8}{'overhead':>10}   (s)")
    for lesson in chosen:
        took: list[float] = []
        for _ in range(arguments.times):
            started = time.perf_counter()
            ended = subprocess.run(
                [sys.executable, "-c", PROGRAM, "check", lesson.id, "--solution", "--format", "json"],
                capture_output=True,
                check=False,
            )
            took.append(time.perf_counter() - started)
            if ended.returncode != 0:
                print(ended.stdout.decode(), ended.stderr.decode(), sep="\n", file=sys.stderr)
                return 1
        asks = load_check(lesson).expected_s
        median = statistics.median(took)
        print(
            f"{lesson.id:<10}{asks:>8.1f}{1.5 * asks + 1.5:>9.2f}{min(took):>8.2f}{median:>8.2f}{max(took):>8.2f}"
            f"{median - asks:>10.2f}",
            flush=True,
        )
    return 0


if __name__ == "__main__":
    sys.exit(main())
