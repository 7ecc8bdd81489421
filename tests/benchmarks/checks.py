"""How long a check of our solutions takes, compared with the longest wait that its scenarios require.

    uv run python -m tests.benchmarks.checks [EXERCISE ...] [--times 5]

Each check runs in its own process, timed from start to end: Python, ROS, every scenario, the clean-up.
"""

from __future__ import annotations

import argparse
import statistics
import subprocess
import sys
import time

from tutor.content import load_course
from tutor.engine.loading import load_check

PROGRAM = "import sys; from tutor.cli import main; sys.exit(main())"


def main() -> int:
    """Print one line for each exercise. Return exit code 1 if a check did not pass: its time would mean nothing."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("exercises", nargs="*")
    parser.add_argument("--times", type=int, default=5)
    arguments = parser.parse_args()
    course = load_course()
    chosen = [course.find(each) for each in arguments.exercises] or list(course.lessons)
    print(f"{'exercise':<10}{'waits':>8}{'allowed':>9}{'min':>8}{'median':>8}{'max':>8}{'overhead':>10}   (s)")
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
        wait_s = load_check(lesson).expected_s
        median = statistics.median(took)
        print(
            f"{lesson.id:<10}{wait_s:>8.1f}{1.5 * wait_s + 1.5:>9.2f}{min(took):>8.2f}{median:>8.2f}{max(took):>8.2f}"
            f"{median - wait_s:>10.2f}",
            flush=True,
        )
    return 0


if __name__ == "__main__":
    sys.exit(main())
