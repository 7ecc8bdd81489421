"""Check our solutions while a hostile submission joins every domain it can, and one exercise many times at once.

    uv run python -m tests.hostile.beside [--checks 24] [--at-once 4] [--isolate]

Prints, for each exercise, how its checks ended. Exit code 1 if one did not pass. On a busy machine a check may give up
with an error, which is marked as such.
"""

from __future__ import annotations

import argparse
import json
import signal
import subprocess
import sys
import tempfile
import threading
from collections import Counter
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from tutor.content import load_course
from tutor.interpreter import module_command

JOINS_ALL = Path(__file__).with_name("submissions") / "i1_1" / "joins-them-all"
REPEATED = ("i2.1", 12)
BUSY_MACHINE = "this machine"
"""Text that only the error of a check that gave up on a busy machine contains."""


@dataclass(frozen=True)
class CheckEnd:
    """How a check ended: its exit code, and why it is not 0."""

    exercise: str
    exit: int
    why: str = ""


def check(exercise: str, *arguments: str) -> CheckEnd:
    """Run a check from the command line, in an empty folder."""
    with tempfile.TemporaryDirectory(prefix="beside-") as folder:
        ended = subprocess.run(
            [*module_command("tutor"), "check", exercise, "--format", "json", *arguments],
            capture_output=True, text=True, cwd=folder, check=False,
        )  # fmt: skip
    if ended.returncode == 0:
        return CheckEnd(exercise, 0)
    try:
        criteria = [each for one in json.loads(ended.stdout)["exercises"] for each in one["criteria"]]
    except ValueError:
        return CheckEnd(exercise, ended.returncode, ended.stderr[-300:].strip())
    why = [f"{each['id']}: {each['cause']}" for each in criteria if each["status"] in ("failed", "error")]
    return CheckEnd(exercise, ended.returncode, "; ".join(why))


@contextmanager
def hostile_checks(*arguments: str) -> Iterator[list[int]]:
    """Check the hostile submission repeatedly in a thread; yield the list of exit codes, complete on leaving."""
    stop, codes = threading.Event(), list[int]()
    with tempfile.TemporaryDirectory(prefix="beside-") as folder:
        command = [*module_command("tutor"), "check", "i1.1", str(JOINS_ALL), *arguments]

        def work() -> None:
            while not stop.is_set():
                checking = subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                while checking.poll() is None:
                    if stop.wait(0.1):
                        checking.send_signal(signal.SIGINT)
                        checking.wait()
                codes.append(checking.returncode)

        thread = threading.Thread(target=work)
        thread.start()
        try:
            yield codes
        finally:
            stop.set()
            thread.join()


def check_solutions(exercises: Sequence[str], at_once: int, *arguments: str) -> list[CheckEnd]:
    """Check our solutions of these exercises, `at_once` at a time."""
    with ThreadPoolExecutor(at_once) as pool:
        return list(pool.map(lambda exercise: check(exercise, "--solution", *arguments), exercises))


def _print_table(title: str, ended: Sequence[CheckEnd]) -> None:
    print(f"{title}\n{'':8}{'checks':>8}{'passed':>8}{'failed':>8}{'error':>8}")
    for exercise in dict.fromkeys(one.exercise for one in ended):
        codes = Counter(one.exit for one in ended if one.exercise == exercise)
        others = codes.total() - codes[0] - codes[1]
        print(f"{exercise:8}{codes.total():>8}{codes[0]:>8}{codes[1]:>8}{others:>8}")
    for one in ended:
        if one.exit:
            print(f"  {one.exercise}, exit {one.exit}{' (busy machine)' * (BUSY_MACHINE in one.why)}: {one.why}")
    sys.stdout.flush()


def main() -> int:
    """Print two tables. Return exit code 1 if a check did not pass."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--checks", type=int, default=24, help="number of checks of our solutions (24)")
    parser.add_argument("--at-once", type=int, default=4, help="checks run in parallel (4)")
    parser.add_argument("--isolate", action="store_true", help="run all checks with --isolate")
    arguments = parser.parse_args()
    options = ["--isolate"] if arguments.isolate else []
    exercises = [lesson.id for lesson in load_course().lessons]
    with hostile_checks(*options) as codes:
        beside = check_solutions(
            [exercises[i % len(exercises)] for i in range(arguments.checks)], arguments.at_once, *options
        )
    _print_table(f"while a hostile submission that joins every domain is checked (exit codes {codes}):", beside)
    exercise, times = REPEATED
    together = check_solutions([exercise] * times, times, *options)
    _print_table(f"{times} checks at once:", together)
    return 1 if any(one.exit for one in [*beside, *together]) else 0


if __name__ == "__main__":
    sys.exit(main())
