"""The terminal page with `ros2 topic echo` of a fast topic: key-to-screen latency, CPU and memory.

    uv run python -m tests.benchmarks.shell [--rates 1000] [--seconds 15]

The whole app runs in its own terminal (a pty). First the echo is in view, and the key that scrolls back takes turns
with a letter, which goes to the end again; then it runs out of view, and a letter is typed at the prompt of another
terminal. The time for which no core was free is reported separately, as in `tests.benchmarks.live`.
"""

from __future__ import annotations

import argparse
import os
import random
import statistics
import sys
import tempfile
import time
from collections.abc import Iterator
from itertools import cycle
from pathlib import Path

from tests.benchmarks.terminal import Terminal, cpu_wait_s, read_usage
from tests.live.private_domain import METRONOME, PrivateDomain, private_domain
from tutor.content import load_course
from tutor.workspace import Workspace, start

APP = "import sys; from tutor.cli import main; sys.exit(main())"
LEAVE, SCROLL_UP = b"\x1d", b"\x1b[5;2~"
MAX_P95_MS, MAX_CPU = 50.0, 0.15


def measure(ros_world: PrivateDomain, rate: int, seconds: float, folder: Path) -> bool:
    """Measure one rate, with a temporary folder for the workspace; return whether the targets were met."""
    workspace = Workspace(folder / "ws")
    start(load_course().lessons[0], workspace)
    app = Terminal([sys.executable, "-c", APP, "--workspace", str(workspace.root)], ros_world.environ)
    app.wait_for_text(b"of 6 passed")
    opened = time.perf_counter()
    app.press(b"7")
    print(f"        the first prompt: {(app.wait_for_text(b'(ROS 2: ws)') - opened) * 1000:.0f} ms after the key")
    publisher = ros_world.run(METRONOME, str(rate), str(int(rate * (2 * seconds + 30))))
    app.press(b"ros2 topic echo /ticks\r")
    app.wait_for_text(b"---")
    app.drain(2.0)
    in_view = cycle([(SCROLL_UP, b"more rows below"), (b"x", b"or an F key leaves")])
    met = report(app, f"{rate} Hz in view", in_view, seconds)
    app.press(LEAVE)
    app.wait_for_text(b"1-9 shows")
    app.press(b"+")
    app.wait_for_text(b"(ROS 2: ws)")
    app.press(b"echo ")
    letters = ((letter.encode(), letter.encode()) for letter in cycle("QZXJKVW"))
    met &= report(app, "out of view, typing", letters, seconds)
    app.press(b"\x03" + LEAVE)
    app.wait_for_text(b"1-9 shows")
    app.close()
    ros_world.end(publisher)
    return met


def report(app: Terminal, name: str, keys: Iterator[tuple[bytes, bytes]], seconds: float) -> bool:
    """Press keys and wait for the effect of each; print the figures, and return whether the targets were met."""
    before, began = read_usage(app.pid), time.perf_counter()
    took: list[float] = []
    own: list[float] = []
    while time.perf_counter() - began < seconds or len(took) % 2:
        key, effect = next(keys)
        app.drain(random.uniform(0.1, 0.3))
        waited, pressed = cpu_wait_s(app.pid, os.getpid()), time.perf_counter()
        app.press(key)
        took.append((app.wait_for_text(effect) - pressed) * 1000)
        own.append(max(0.0, took[-1] - (cpu_wait_s(app.pid, os.getpid()) - waited) * 1000))
    lasted, after = time.perf_counter() - began, read_usage(app.pid)
    cpu = (after.cpu_s - before.cpu_s) / lasted
    p95, own_p95 = (statistics.quantiles(times, n=20)[-1] for times in (took, own))
    print(
        f"{name:>20}  key to screen p50 {statistics.median(took):.1f} ms, p95 {p95:.1f} ms ({len(took)} keys); without "
        f"waiting for a free core p95 {own_p95:.1f} ms\n{'':>20}  app: {cpu:.1%} CPU, {after.memory_mb:.0f} MB; "
        f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores",
        flush=True,
    )
    return p95 < MAX_P95_MS and cpu < MAX_CPU


def main() -> int:
    """Print the figures for each rate. Return exit code 1 if a target was missed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rates", type=int, nargs="+", default=[1000])
    parser.add_argument("--seconds", type=float, default=15.0)
    arguments = parser.parse_args()
    met = []
    for rate in arguments.rates:
        with private_domain() as ros_world, tempfile.TemporaryDirectory() as folder:
            met.append(measure(ros_world, rate, arguments.seconds, Path(folder)))
    return 0 if all(met) else 1


if __name__ == "__main__":
    sys.exit(main())
