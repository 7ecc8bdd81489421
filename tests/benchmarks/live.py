"""The live page with a fast topic in view: key-to-screen latency, counted against sent messages, CPU and memory.

    uv run python -m tests.benchmarks.live [--rates 1000 10000] [--seconds 20]

The whole app runs in its own terminal (a pty), with a lesson, its criteria and the list of lessons around the live
page. A key is written to it, and the clock stops when the output that shows its effect has arrived. Three kinds of keys
take turns: pause, zoom, switch tabs. The machine's load is printed as well, since a busy machine affects the figures;
the time for which no core was free is reported separately. If `ros2` is installed, `ros2 topic hz` is run on the same
topic.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import shutil
import signal
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from tests.benchmarks.terminal import Terminal, cpu_wait_s, find_watcher, read_usage
from tests.live.private_domain import METRONOME, PrivateDomain, private_domain
from tutor.content import load_course
from tutor.interpreter import reduce_gc_frequency
from tutor.live.updates import TopicUpdate
from tutor.session import Session
from tutor.tui.app import TutorApp
from tutor.workspace import Workspace, start

TARGETS_MS = {1000: 40.0, 10000: 100.0}
MAX_APP_CPU = 0.15
"""The app's share of a core, keys included, at 1 kHz."""

KEYS = (
    (b" ", b"Go on"),
    (b" ", b"Pause"),
    (b"+", b"30 s ago"),
    (b"-", b"10 s ago"),
    (b"]", b"Allowed"),
    (b"[", b"Unfollow"),
)
"""A key, and the text that is drawn only after it."""


def measure(ros_world: PrivateDomain, rate: int, seconds: float) -> bool:
    """Measure one rate; return whether the target was met and every message counted."""
    with tempfile.TemporaryDirectory() as folder:
        return _measure_in(Path(folder), ros_world, rate, seconds)


def _measure_in(folder: Path, ros_world: PrivateDomain, rate: int, seconds: float) -> bool:
    """Measure as `measure` does, with a temporary folder for the report and the workspace."""
    report, workspace = folder / "counts.json", Workspace(folder / "ws")
    start(load_course().lessons[0], workspace)
    run = [sys.executable, "-m", "tests.benchmarks.live", "--app", str(report), str(workspace.root)]
    app = Terminal(run, ros_world.environ)
    app.wait_for_text(b"of 6 passed")
    app.press(b"4")
    app.wait_for_text(b"No node runs")
    publisher = ros_world.run(METRONOME, str(rate), str(int(rate * (seconds + 5))))
    app.wait_for_text(b"/ticks")
    app.press(b"\x1b[B")  # move on from the lesson's topic
    app.wait_for_text(b"Not followed")
    app.press(b"\r")
    app.wait_for_text(b"jitter")
    app.drain(1.0)
    pids = app.pid, find_watcher(app.pid)
    before, began = [read_usage(pid) for pid in pids], time.perf_counter()
    took: list[float] = []
    waits: list[float] = []
    while time.perf_counter() - began < seconds:
        for key, effect in KEYS:
            app.drain(random.uniform(0.1, 0.3))
            waited, pressed = cpu_wait_s(app.pid, os.getpid()), time.perf_counter()
            app.press(key)
            took.append((app.wait_for_text(effect) - pressed) * 1000)
            waits.append((cpu_wait_s(app.pid, os.getpid()) - waited) * 1000)
    lasted = time.perf_counter() - began
    after = [read_usage(pid) for pid in pids]
    hz = topic_hz(ros_world)
    sent, _, needed = ros_world.read_line(publisher).partition(" ")
    app.drain(1.5)
    app.close()
    found = json.loads(report.read_text())
    ros_world.end(publisher)
    p95 = statistics.quantiles(took, n=20)[-1]
    own = [max(0.0, whole - wait) for whole, wait in zip(took, waits, strict=True)]
    print(
        f"{rate:>6} Hz  key to screen p50 {statistics.median(took):5.1f} ms, p95 {p95:5.1f} ms, "
        f"worst {max(took):5.1f} ms ({len(took)} keys; target: p95 under {TARGETS_MS.get(rate, 100.0):.0f} ms)\n"
        f"           without waiting for a free core: p50 {statistics.median(own):.1f} ms, "
        f"p95 {statistics.quantiles(own, n=20)[-1]:.1f} ms\n"
        f"           sent {int(sent):,} in {float(needed):.2f} s, counted {found['count']:,}, "
        f"reported lost {found['lost']}"
    )
    for name, a, b in zip(("app", "watcher process"), before, after, strict=True):
        print(f"           {name}: {(b.cpu_s - a.cpu_s) / lasted:6.1%} CPU, {b.memory_mb:.0f} MB")
    print(f"           target for the app at 1 kHz, keys included: {MAX_APP_CPU:.0%}")
    print(
        f"           {hz}\n           load of the machine: {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores",
        flush=True,
    )
    return p95 < TARGETS_MS.get(rate, 100.0) and found["count"] == int(sent)


def topic_hz(ros_world: PrivateDomain) -> str:
    """Return what `ros2 topic hz` prints and the resources it uses, if it is installed."""
    if (ros2 := shutil.which("ros2")) is None:
        return "ros2 topic hz: not installed here"
    process = subprocess.Popen(
        [ros2, "topic", "hz", "/ticks"],
        env=ros_world.environ,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    )
    assert process.stdout is not None
    answer = next((line.strip() for line in process.stdout if "average rate" in line), "nothing")
    used = read_usage(process.pid)
    process.send_signal(signal.SIGINT)
    process.communicate()
    return f"ros2 topic hz: {answer}, {used.cpu_s:.1f} s CPU until then, {used.memory_mb:.0f} MB"


class WatchedApp(TutorApp):
    """The app, which keeps its message count when it is left."""

    counted: TopicUpdate | None = None

    def leave(self) -> None:
        """Save the count, then leave."""
        if self.main is not None and (live := self.main.pages.live) is not None:
            self.counted = live.state.topics["/ticks"].update if "/ticks" in live.state.topics else None
        super().leave()


def run_app(report: Path, workspace: Path) -> None:
    """Run the app under test, started as `ros-tutor` starts it, and write its counts to `report`."""
    reduce_gc_frequency()
    app = WatchedApp(Session(load_course(), Workspace(workspace)))
    app.run()
    assert app.counted is not None
    report.write_text(json.dumps({"count": app.counted.count, "lost": app.counted.lost}))


def main() -> int:
    """Print the figures for each rate. Return exit code 1 if a target was missed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rates", type=int, nargs="+", default=[1000, 10000])
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--app", type=Path, nargs=2, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.app is not None:
        run_app(*arguments.app)
        return 0
    with private_domain() as ros_world:
        met = [measure(ros_world, rate, arguments.seconds) for rate in arguments.rates]
    return 0 if all(met) else 1


if __name__ == "__main__":
    sys.exit(main())
