"""Runs recorded commands against our `ros2` and tells what is the same.

    python -m tests.ros2cli.replay FOLDER [--only TEXT] [--session N] [--diff]

prints a line for each record (same, wanted: differs on purpose, not supported, differs), a table, and ends with 1
where something differs without a reason.
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
from tests.ros2cli.normalising import TRACEBACK, normalise, of_both, without_early_warning
from tests.ros2cli.records import Output, Record, read_all

LIMIT_S = 60.0
_WAITS = "stdout: waiting for service to become available..."
SAME, WANTED, UNSUPPORTED, DIFFERS = "same", "wanted", "not supported", "differs"
_NODES_END = re.compile(rf"\[[\w.]+-\d+\] ({TRACEBACK}|KeyboardInterrupt|Exception ignored in: .*|\S+Error: .*)$")
_HINT = re.compile(r" \(is it [^()]+\?\)")
_UNORDERED = re.compile(r"ros2 (launch|interface package) |bash -c")
_STREAMING = re.compile(r"ros2 (topic (echo|hz|bw|delay|pub)|service (call -r|echo)|run|launch)\b")


@dataclass(frozen=True, slots=True)
class Result:
    """How a record came out, why where that needs a reason, and the difference, a line each."""

    record: Record
    kind: str
    reason: str
    diff: tuple[str, ...]


def main(arguments: Sequence[str] | None = None) -> int:
    """Replay a folder of records, and print what came of it."""
    parser = argparse.ArgumentParser(prog="python -m tests.ros2cli.replay", description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=Path, help="the folder with the records")
    parser.add_argument("--only", default="", metavar="TEXT", help="only records whose file or command holds TEXT")
    parser.add_argument("--session", type=int, help="only this session")
    parser.add_argument("--diff", action="store_true", help="print the differences, also the wanted ones")
    given = parser.parse_args(arguments)

    records = [
        record
        for record in read_all(given.folder)
        if (given.only in record.name or given.only in record.command) and given.session in (None, record.session)
    ]
    counts: Counter[str] = Counter()
    for result in replay(records):  # each as it comes
        counts[result.kind] += 1
        print(f"{result.kind:13}  {result.record.name[:7].rstrip('_'):7} {result.record.command}", flush=True)
        if result.reason:
            print(f"{'':23} {result.reason}")
        if result.kind == DIFFERS or given.diff:
            for line in result.diff:
                print(f"{'':23} {line}")
    total = sum(counts.values())
    print()
    for kind in (SAME, WANTED, UNSUPPORTED, DIFFERS):
        print(f"{kind:13} {counts[kind]:5} {100 * counts[kind] / max(total, 1):6.1f} %")
    print(f"{'records':13} {total:5}")
    return 1 if counts[DIFFERS] else 0


def replay(records: Sequence[Record]) -> Iterator[Result]:
    """Run each record among the nodes that were up, and hold what it prints beside what was recorded."""
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
            with sessions.running(sessions.commands_of(running), env, files):
                for record in group:
                    output = run(record, env, files)
                    yield judge(record, output, {str(workspace): "$WORKSPACE", **_prefixes()})


def run(record: Record, env: Mapping[str, str], cwd: Path) -> Output:
    """Run the command as it was run: on a terminal or with pipes, with Ctrl+C at its moment."""
    return _on_terminal(record, env, cwd) if record.on_terminal else _with_pipes(record, env, cwd)


def _with_pipes(record: Record, env: Mapping[str, str], cwd: Path) -> Output:
    process = subprocess.Popen(
        ["bash", "-c", record.command], env=env, cwd=cwd, start_new_session=True,
        stdin=subprocess.PIPE if record.stdin is not None else subprocess.DEVNULL,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE,
    )  # fmt: skip
    given = record.stdin
    try:
        stdout, stderr = process.communicate(given, timeout=record.interrupt_after_s or LIMIT_S)
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
            except OSError:  # the last one that had it open is gone
                break
    else:
        os.kill(pid, signal.SIGKILL)
    _, status = os.waitpid(pid, 0)
    os.close(terminal)
    return Output(seen.decode(errors="replace"), "", os.waitstatus_to_exitcode(status))


def judge(record: Record, ours: Output, paths: Mapping[str, str]) -> Result:
    """Hold ours beside the recorded output, line by line but for what differs from run to run."""
    recorded, printed = _lines(record, record.output, paths), _lines(record, ours, paths)
    if recorded == printed:
        return Result(record, SAME, "", ())
    diff = tuple(difflib.unified_diff(recorded, printed, "recorded", "ours", lineterm="", n=1))
    if ours.code == 2 and "not supported" in ours.stderr:
        return Result(record, UNSUPPORTED, ours.stderr.strip().splitlines()[-1], diff)
    reason = _kinder(record, recorded, printed) or _wanted(record.command, recorded, printed)
    return Result(record, WANTED, reason, diff) if reason else Result(record, DIFFERS, "", diff)


def _lines(record: Record, output: Output, paths: Mapping[str, str]) -> list[str]:
    streams = bool(_STREAMING.search(record.command))
    told = []
    for name, text in (("stdout", output.stdout), ("stderr", output.stderr)):
        found = normalise(text, paths, streams=streams)
        if " launch " in record.command:  # how a node ends depends on what it is doing when Ctrl+C comes
            found = [line for line in found if not _NODES_END.match(line)]
        found = of_both(record.command, found)
        told += [f"{name}: {line}" for line in (sorted(found) if _UNORDERED.match(record.command) else found)]
    return [*without_early_warning(record.command, told), f"exit code: {output.code}"]


def _kinder(record: Record, recorded: Sequence[str], printed: Sequence[str]) -> str:
    """Why ours may differ, whatever the command; empty where it may not. The exit code is always the recorded one."""
    if recorded[-1] != printed[-1]:
        return ""
    if TRACEBACK in " ".join(recorded) and TRACEBACK not in " ".join(printed):
        return "one line instead of a traceback, with the same exit code"
    if list(recorded) == [_HINT.sub("", line) for line in printed]:
        return "ours adds the name that is much like it"
    rest = iter(printed)
    told = [line for line in recorded if line != _WAITS]  # ours says so, too, but only where it has to wait
    if record.interrupt_after_s and all(line in rest for line in told):  # `in` goes on from the line found last
        return f"within the {record.interrupt_after_s:g} s until Ctrl+C, ours got further"
    return ""


def _wanted(command: str, recorded: Sequence[str], printed: Sequence[str]) -> str:
    known = tomllib.loads((Path(__file__).parent / "wanted.toml").read_text(encoding="utf-8"))["wanted"]
    for each in known:
        lacks = [f"stdout: {line}" for line in each.get("lacks", ())]
        if re.fullmatch(each["command"], command):
            return each["reason"] if not lacks or [it for it in recorded if it not in lacks] == printed else ""
    return ""


def _prefixes() -> dict[str, str]:
    """The folders of the bundled ROS, as the records call them."""
    site = Path(sys.prefix) / "lib" / f"python3.{sys.version_info[1]}" / "site-packages"
    return {str(site): "$ROS", sys.prefix: "$ROS", str(sessions.ROOT): "$ROS"}


if __name__ == "__main__":
    sys.exit(main())
