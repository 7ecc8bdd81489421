"""How long `check all --solution` takes, compared with its slowest exercise alone.

    uv run python -m tests.benchmarks.all_at_once [--times 3]

At most 1.3 times the slowest exercise plus 2 s is allowed. Also prints the CPU time of our own process (which observes)
and of its children (learners' processes and their supervisors). The figures mean little on a busy machine.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
import time
from dataclasses import dataclass

from tutor.content import load_course

# Only the engine's own process can tell its CPU time from that of its children, so it prints both.
PROGRAM = """
import json, resource, sys
from tutor.cli import main
code = main()
used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
print(json.dumps([each.ru_utime + each.ru_stime for each in used]), file=sys.stderr)
sys.exit(code)
"""


@dataclass(frozen=True)
class Timing:
    """One run: wall-clock time, and CPU time of the engine and of its children, in seconds."""

    wall_s: float
    ours_s: float
    started_s: float


def time_check(exercise: str) -> Timing:
    """Check our own solution. Raises SystemExit if it does not pass: its time would mean nothing."""
    began = time.perf_counter()
    ended = subprocess.run(
        [sys.executable, "-c", PROGRAM, "check", exercise, "--solution", "--format", "json"],
        capture_output=True,
        text=True,
        check=False,
    )
    took = time.perf_counter() - began
    if ended.returncode != 0:
        raise SystemExit(f"{exercise} did not pass:\n{ended.stdout}\n{ended.stderr}")
    ours, started = json.loads(ended.stderr.splitlines()[-1])
    return Timing(took, ours, started)


def main() -> int:
    """Print a line for each exercise alone, and for all at once. Return exit code 1 if all take too long."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--times", type=int, default=3)
    times: int = parser.parse_args().times
    cores = len(os.sched_getaffinity(0))
    print(f"{cores} cores, load {os.getloadavg()[0]:.1f}; medians of {times}, in seconds")
    print(f"{'':<10}{'clock':>8}{'CPU: ours':>12}{'started':>10}")
    median_s: dict[str, float] = {}
    for name in [*(lesson.id for lesson in load_course().lessons), "all"]:
        timings = [time_check(name) for _ in range(times)]
        median_s[name] = statistics.median(each.wall_s for each in timings)
        ours = statistics.median(each.ours_s for each in timings)
        started = statistics.median(each.started_s for each in timings)
        print(f"{name:<10}{median_s[name]:>8.2f}{ours:>12.2f}{started:>10.2f}", flush=True)
    slowest = max(value for name, value in median_s.items() if name != "all")
    allowed = 1.3 * slowest + 2
    print(f"all at once: {median_s['all']:.2f} s, allowed {allowed:.2f} s (1.3 x {slowest:.2f} s + 2 s)")
    return 0 if median_s["all"] <= allowed else 1


if __name__ == "__main__":
    sys.exit(main())
