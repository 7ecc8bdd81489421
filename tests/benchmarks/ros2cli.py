"""Our `ros2 topic hz` and `echo` on a fast topic: CPU, lost messages, time to the first line.

    uv run python -m tests.benchmarks.ros2cli [--rates 1000 10000] [--seconds 10]

CPU is that of the `ros2` process between its first line and its last, as a fraction of one core. The target is half of
what ros2cli takes at 1 kHz: 16.5 % for hz, 28 % for echo. The machine's load is printed as well. ros2cli's first line
comes after 0.3 to 1.5 s; the time of a program that only creates a node is printed first, for comparison.
"""

from __future__ import annotations

import argparse
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

from tests.benchmarks.terminal import read_usage
from tests.ros2cli.bench import Bench, bench, command

TARGETS = {("hz", 1000): 0.165 / 2, ("echo", 1000): 0.28 / 2}
LIMIT_S = 60.0

METRONOME = """
import time
from std_msgs.msg import String

RATE, COUNT = {rate}, {count}
node = rclpy.create_node("metronome")
publisher = node.create_publisher(String, "ticks", 1000)
print("ready", flush=True)
while not publisher.get_subscription_count():
    time.sleep(0.01)
time.sleep({pause})
start = time.perf_counter()
for number in range(COUNT):
    while (left := start + number / RATE - time.perf_counter()) > 0:
        time.sleep(min(left, 0.001))
    publisher.publish(String(data=f"Hello World: {{number}}"))
print(f"{{COUNT / (time.perf_counter() - start):.1f}}", flush=True)
time.sleep(1.5)
publisher.publish(String(data=f"Hello World: {{COUNT}}"))
time.sleep(1.0)
print("done", flush=True)
time.sleep(60)
"""


@dataclass(frozen=True)
class Figures:
    """One run: `rate_hz` as actually published, `cpu` as a fraction of a core, `first_s` until the first line."""

    sent: int
    rate_hz: float
    seen: int
    cpu: float
    memory_mb: float
    first_s: float


def measure(ros_bench: Bench, verb: str, rate: int, seconds: float) -> Figures:
    """Run the verb while a node publishes at `rate` Hz for this many seconds."""
    count, out = int(rate * seconds), ros_bench.folder / "out"
    words = [*command("topic", verb, "/ticks"), *(["-w", "10000000"] if verb == "hz" else [])]
    code = METRONOME.format(rate=rate, count=count, pause=0.5)
    with ros_bench.node(code) as metronome, out.open("wb") as to:
        ros2 = subprocess.Popen(words, env=ros_bench.env, cwd=ros_bench.folder, stdout=to)
        try:
            await_output(out)
            before, began = read_usage(ros2.pid), time.perf_counter()
            published = float(metronome.line())
            after, lasted = read_usage(ros2.pid), time.perf_counter() - began
            assert metronome.line() == "done"
        finally:
            ros2.send_signal(signal.SIGINT)
            ros2.wait(LIMIT_S)
    text = out.read_text()
    seen = int(re.findall(r"window: (\d+)", text)[-1]) + 1 if verb == "hz" else text.count("data: ")
    cpu = (after.cpu_s - before.cpu_s) / lasted
    return Figures(count + 1, published, seen, cpu, after.memory_mb, time_first_line(ros_bench, verb, rate))


def time_first_line(ros_bench: Bench, verb: str, rate: int) -> float:
    """Return the seconds from the start to the first line, on a topic that is already being published."""
    out = ros_bench.folder / "first"
    with (
        ros_bench.node(METRONOME.format(rate=rate, count=rate * 60, pause=0)),
        ros_bench.running("topic", "echo", "/ticks") as other,
    ):
        other.line()
        with out.open("wb") as to:
            began = time.perf_counter()
            ros2 = subprocess.Popen(
                command("topic", verb, "/ticks"), env=ros_bench.env, cwd=ros_bench.folder, stdout=to
            )
            try:
                await_output(out)
                return time.perf_counter() - began
            finally:
                ros2.send_signal(signal.SIGINT)
                ros2.wait(LIMIT_S)


def time_bare_node(ros_bench: Bench) -> float:
    """Return the seconds that a program takes, start to end, that only creates a node with rclpy."""
    began = time.perf_counter()
    program = "import rclpy; rclpy.init(); rclpy.create_node('bare')"
    subprocess.run([sys.executable, "-P", "-c", program], env=ros_bench.env, cwd=ros_bench.folder, check=True)
    return time.perf_counter() - began


def await_output(path: Path) -> None:
    """Wait until the file is not empty."""
    deadline = time.monotonic() + LIMIT_S
    while not path.stat().st_size:
        assert time.monotonic() < deadline, "nothing was printed"
        time.sleep(0.005)


def main() -> int:
    """Print the figures for each verb and rate. Return exit code 1 if a target was missed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rates", type=int, nargs="+", default=[1000, 10000])
    parser.add_argument("--seconds", type=float, default=10.0)
    arguments = parser.parse_args()
    met = True
    with tempfile.TemporaryDirectory() as folder, bench(Path(folder)) as ros_bench:
        print(
            f"a program that only creates a node: {min(time_bare_node(ros_bench) for _ in range(3)):.2f} s", flush=True
        )
    for verb in ("hz", "echo"):
        for rate in arguments.rates:
            with tempfile.TemporaryDirectory() as folder, bench(Path(folder)) as ros_bench:
                found = measure(ros_bench, verb, rate, arguments.seconds)
            target = TARGETS.get((verb, rate))
            met = met and (target is None or found.cpu < target)
            goal = "" if target is None else f" (target: under {target:.1%})"
            print(
                f"{verb:<4} {rate:>6} Hz  {found.cpu:6.1%} CPU{goal}, "
                f"{found.memory_mb:.0f} MB, {found.sent - found.seen} of {found.sent} messages lost, "
                f"published at {found.rate_hz:.0f} Hz, first line after {found.first_s:.2f} s; "
                f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores",
                flush=True,
            )
    return 0 if met else 1


if __name__ == "__main__":
    sys.exit(main())
