"""Runs recorded commands with our `ros2` and compares the outputs.

    python -m tests.ros2cli.replay FOLDER [--only TEXT] [--session N] [--diff]

Prints a line per record ("same", "deliberate" for a known difference, "not supported" or "differs") and a table.
Exits with 1 if anything differs without a reason.
"""

from __future__ import annotations

import argparse
import difflib
import os
import pty
import re
import select
import signal
import subprocess
import sys
import tempfile
import time
import tomllib
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path

from tests.ros2cli import sessions
from tests.ros2cli.normalising import TRACEBACK, drop_early_warning, drop_missing_packages, normalise
from tests.ros2cli.records import Output, Record, read_all

LIMIT_S = 60.0
_WAITING = "stdout: waiting for service to become available..."
SAME, DELIBERATE, UNSUPPORTED, DIFFERS = "same", "deliberate", "not supported", "differs"
_NODE_END = re.compile(rf"\[[\w.]+-\d+\] ({TRACEBACK}|KeyboardInterrupt|Exception ignored in: .*|\S+Error: .*)$")
_HINT = re.compile(r" \(is it [^()]+\?\)")
_UNORDERED = re.compile(r"ros2 (launch|interface package) |bash -c")
_STREAMING = re.compile(r"ros2 (topic (echo|hz|bw|delay|pub)|service (call -r|echo)|run|launch)\b")


@dataclass(frozen=True, slots=True)
class Result:
    """Outcome of a record: its kind, the reason for a difference if there is one, and the lines of the diff."""

    record: Record
    kind: str
    reason: str
    diff: tuple[str, ...]


def main(arguments: Sequence[str] | None = None) -> int:
    """Replay a folder of records, and print the results."""
    parser = argparse.ArgumentParser(prog="python -m tests.ros2cli.replay", description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=Path, help="the folder with the records")
    parser.add_argument(
        "--only", default="", metavar="TEXT", help="only records whose file name or command contains TEXT"
    )
    parser.add_argument("--session", type=int, help="only this session")
    parser.add_argument("--diff", action="store_true", help="print all differences, including deliberate ones")
    options = parser.parse_args(arguments)

    records = [
        record
        for record in read_all(options.folder)
        if (options.only in record.name or options.only in record.command) and options.session in (None, record.session)
    ]
    counts: Counter[str] = Counter()
    for result in replay(records):  # print each as it completes
        counts[result.kind] += 1
        print(f"{result.kind:13}  {result.record.name[:7].rstrip('_'):7} {result.record.command}", flush=True)
        if result.reason:
            print(f"{'':23} {result.reason}")
        if result.kind == DIFFERS or options.diff:
            for line in result.diff:
                print(f"{'':23} {line}")
    total = sum(counts.values())
    print()
    for kind in (SAME, DELIBERATE, UNSUPPORTED, DIFFERS):
        print(f"{kind:13} {counts[kind]:5} {100 * counts[kind] / max(total, 1):6.1f} %")
    print(f"{'records':13} {total:5}")
    return 1 if counts[DIFFERS] else 0


def replay(records: Sequence[Record]) -> Iterator[Result]:
    """Run each record's command with the nodes that were up at the time, and compare its output with the record."""
    with tempfile.TemporaryDirectory(prefix="ros2-replay-") as name:
        folder = Path(name)
        workspace = sessions.make_workspace(folder)
        env = {
            **sessions.shell_environment(workspace, folder / "tools"),
            "TMP": str(folder),
            "WORKSPACE": str(workspace),
        }
        files = folder / "files"
        files.mkdir()
        for file, text in sessions.FILES.items():
            (files / file).write_text(text, encoding="utf-8")
        for running, group in groupby(records, key=lambda record: record.running):
            with sessions.running(sessions.start_commands(running), env, files):
                for record in group:
                    output = run(record, env, files)
                    yield compare(record, output, {str(workspace): "$WORKSPACE", **_prefixes()})


def run(record: Record, env: Mapping[str, str], cwd: Path) -> Output:
    """Run the command as recorded: on a terminal or with pipes, and with Ctrl+C after the same time."""
    return _on_terminal(record, env, cwd) if record.on_terminal else _with_pipes(record, env, cwd)


def _with_pipes(record: Record, env: Mapping[str, str], cwd: Path) -> Output:
    process = subprocess.Popen(
        ["bash", "-c", record.command], env=env, cwd=cwd, start_new_session=True,
        stdin=subprocess.PIPE if record.stdin is not None else subprocess.DEVNULL,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE,
    )  # fmt: skip
    try:
        stdout, stderr = process.communicate(record.stdin, timeout=record.interrupt_after_s or LIMIT_S)
    except subprocess.TimeoutExpired:
        if record.interrupt_after_s is not None:
            os.killpg(process.pid, signal.SIGINT)
        try:
            stdout, stderr = process.communicate(timeout=15)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            stdout, stderr = process.communicate()
    return Output(stdout.decode(errors="replace"), stderr.decode(errors="replace"), process.returncode)


def _on_terminal(record: Record, env: Mapping[str, str], cwd: Path) -> Output:
    pid, terminal = pty.fork()
    if pid == 0:
        os.chdir(cwd)
        os.execve("/bin/bash", ["bash", "-c", record.command], dict(env))
    started = time.monotonic()
    pressed = False
    seen = b""
    while time.monotonic() < started + LIMIT_S:
        if not pressed and record.interrupt_after_s and time.monotonic() > started + record.interrupt_after_s:
            os.write(terminal, b"\x03")
            pressed = True
        if select.select([terminal], [], [], 0.1)[0]:
            try:
                seen += os.read(terminal, 65536)
            except OSError:  # the last process that had the terminal open is gone
                break
    else:
        os.kill(pid, signal.SIGKILL)
    _, status = os.waitpid(pid, 0)
    os.close(terminal)
    return Output(seen.decode(errors="replace"), "", os.waitstatus_to_exitcode(status))


def compare(record: Record, ours: Output, paths: Mapping[str, str]) -> Result:
    """Compare our output with the recorded one, line by line and apart from what differs from run to run."""
    recorded, printed = _lines(record, record.output, paths), _lines(record, ours, paths)
    if recorded == printed:
        return Result(record, SAME, "", ())
    diff = tuple(difflib.unified_diff(recorded, printed, "recorded", "ours", lineterm="", n=1))
    if ours.code == 2 and "not supported" in ours.stderr:
        return Result(record, UNSUPPORTED, ours.stderr.strip().splitlines()[-1], diff)
    reason = _improvement(record, recorded, printed) or _deliberate(record.command, recorded, printed)
    return Result(record, DELIBERATE, reason, diff) if reason else Result(record, DIFFERS, "", diff)


def _lines(record: Record, output: Output, paths: Mapping[str, str]) -> list[str]:
    streams = bool(_STREAMING.search(record.command))
    lines = []
    for name, text in (("stdout", output.stdout), ("stderr", output.stderr)):
        found = normalise(text, paths, streams=streams)
        if " launch " in record.command:  # how a node ends depends on what it is doing when Ctrl+C arrives
            found = [line for line in found if not _NODE_END.match(line)]
        found = drop_missing_packages(record.command, found)
        lines += [f"{name}: {line}" for line in (sorted(found) if _UNORDERED.match(record.command) else found)]
    return [*drop_early_warning(record.command, lines), f"exit code: {output.code}"]


def _improvement(record: Record, recorded: Sequence[str], printed: Sequence[str]) -> str:
    """Return why ours may differ, whatever the command, or "" if it may not. The exit code must always agree."""
    if recorded[-1] != printed[-1]:
        return ""
    if TRACEBACK in " ".join(recorded) and TRACEBACK not in " ".join(printed):
        return "one line instead of a traceback, with the same exit code"
    if list(recorded) == [_HINT.sub("", line) for line in printed]:
        return "ours suggests a similar name"
    rest = iter(printed)
    needed = [line for line in recorded if line != _WAITING]  # ours prints this too, but only if it has to wait
    if record.interrupt_after_s and all(line in rest for line in needed):  # `in` resumes after the line found last
        return f"within the {record.interrupt_after_s:g} s until Ctrl+C, ours got further"
    return ""


def _deliberate(command: str, recorded: Sequence[str], printed: Sequence[str]) -> str:
    """Return the reason that deliberate.toml gives for the difference, or "" if there is none."""
    known = tomllib.loads((Path(__file__).parent / "deliberate.toml").read_text(encoding="utf-8"))["deliberate"]
    for each in known:
        if not re.fullmatch(each["command"], command):
            continue
        reason: str = each["reason"]
        if "lacks" in each:
            lacks = [f"stdout: {line}" for line in each["lacks"]]
            return reason if [line for line in recorded if line not in lacks] == list(printed) else ""
        if "adds" in each:
            more = re.compile(rf"stdout: +{each['adds']}")
            kept = [line for line in printed if line in recorded or not more.fullmatch(line)]
            return reason if kept == list(recorded) else ""
        return reason
    return ""


def _prefixes() -> dict[str, str]:
    """Return the folders of the bundled ROS, with their name in the records."""
    site = Path(sys.prefix) / "lib" / f"python3.{sys.version_info[1]}" / "site-packages"
    return {str(site): "$ROS", sys.prefix: "$ROS", str(sessions.ROOT): "$ROS"}


if __name__ == "__main__":
    sys.exit(main())
