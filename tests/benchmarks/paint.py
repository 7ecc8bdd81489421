"""Time from the app's start to its first paint, compared with an empty Textual app, and idle resource use.

    uv run python -m tests.benchmarks.paint [--times 10] [--seconds 10]

Both apps are started alternately, each in its own terminal. The clock stops at the first frame: for our app that is its
bar with the title of the opened lesson; `whole` is the lesson with its criteria. At most 1.3 times the empty app's time
is allowed for the first, 3.5 times for the whole, and 2 % of CPU when idle. The fastest start counts: slower ones are
the machine's doing.
"""

from __future__ import annotations

import argparse
import os
import statistics
import sys
import tempfile
import time
from pathlib import Path

from tests.benchmarks.terminal import Terminal, read_usage
from tutor.content import load_course
from tutor.interpreter import FLAGS, module_command
from tutor.workspace import Workspace, start

EMPTY = (sys.executable, *FLAGS, "-c", "from textual.app import App; App().run()")
OURS = module_command("tutor")
"""The command that `ros-tutor` runs, which sets up the garbage collector too."""

FIRST_FRAME = b" " * 100
"""Text that any first frame contains: the blank half of a line."""

MAX_RATIO = 1.3
MAX_WHOLE_RATIO = 3.5
MAX_IDLE_CPU = 0.02


def start_app(*command: str) -> tuple[Terminal, float]:
    """Start this program in a terminal; return it and the start time."""
    began = time.perf_counter()
    return Terminal(list(command), dict(os.environ)), began


def cpu_time_s(pid: int) -> float:
    """Return a process's CPU seconds so far, in ns resolution: the first paint takes less than a second."""
    tasks = Path(f"/proc/{pid}/task").glob("*/schedstat")
    return sum(int(each.read_text().split()[0]) for each in tasks) / 1e9


def measure(workspace: Path, times: int) -> bool:
    """Print the times of both apps; return whether ours is fast enough."""
    took: dict[str, list[tuple[float, float]]] = {"empty app": [], "ros-tutor": [], "whole": []}

    def wait_for_paint(name: str, text: bytes) -> None:
        took[name].append((app.wait_for_text(text) - began, cpu_time_s(app.pid)))

    for _ in range(times):
        app, began = start_app(*EMPTY)
        wait_for_paint("empty app", FIRST_FRAME)
        app.close()
        app, began = start_app(*OURS, "--workspace", str(workspace))
        wait_for_paint("ros-tutor", b"I1.1 Sensor Publisher")
        wait_for_paint("whole", b"of 6 passed")
        app.close()
    empty = min(clock for clock, _ in took["empty app"])
    empty_cpu = min(cpu for _, cpu in took["empty app"])
    for name, found in took.items():
        clock, cpu = ([each[index] for each in found] for index in (0, 1))
        print(
            f"{name:<10} after {min(clock) * 1000:5.0f} ms, median {statistics.median(clock) * 1000:5.0f} ms "
            f"({min(clock) / empty:.2f} times); {min(cpu) * 1000:5.0f} ms of CPU ({min(cpu) / empty_cpu:.2f} times)"
        )
    ratio = min(clock for clock, _ in took["ros-tutor"]) / empty
    whole_ratio = min(clock for clock, _ in took["whole"]) / empty
    print(f"first paint: {ratio:.2f} times an empty app's (target: at most {MAX_RATIO})")
    print(f"whole: {whole_ratio:.2f} times an empty app's first paint (target: at most {MAX_WHOLE_RATIO})")
    return ratio <= MAX_RATIO and whole_ratio <= MAX_WHOLE_RATIO


def measure_idle(workspace: Path, seconds: float) -> bool:
    """Print what the idle app uses; return whether it is little enough."""
    app, _ = start_app(*OURS, "--workspace", str(workspace))
    app.wait_for_text(b"of 6 passed")
    app.drain(2.0)
    before, began = read_usage(app.pid), time.perf_counter()
    app.drain(seconds)
    after, lasted = read_usage(app.pid), time.perf_counter() - began
    app.close()
    used = (after.cpu_s - before.cpu_s) / lasted
    print(f"idle: {used:.1%} CPU over {lasted:.0f} s, {after.memory_mb:.0f} MB (target: under {MAX_IDLE_CPU:.0%})")
    return used < MAX_IDLE_CPU


def main() -> int:
    """Print the figures. Return exit code 1 if a target was missed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--times", type=int, default=10)
    parser.add_argument("--seconds", type=float, default=10.0)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        workspace = Path(folder) / "ws"
        start(load_course().lessons[0], Workspace(workspace))
        met = measure(workspace, arguments.times), measure_idle(workspace, arguments.seconds)
    print(f"load of the machine: {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores", flush=True)
    return 0 if all(met) else 1


if __name__ == "__main__":
    sys.exit(main())
