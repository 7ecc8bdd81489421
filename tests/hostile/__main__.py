"""Check every hostile submission, one at a time, and print its result, its cost and what it left behind.

    uv run python -m tests.hostile [--isolate] [EXERCISE[/hostile/NAME] ...]

Each exercise's solution is checked first, as the ordinary check with which memory use is compared. Exit code 1 if
anything is not as expected: the verdict, the exit code, memory, the report's size, or what is left behind.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tests.hostile import find_hostile
from tests.judging import compare
from tutor.content.submissions import Case, Expected
from tutor.interpreter import module_command
from tutor.judge.result import CriterionResult, ExerciseResult
from tutor.judge.verdict import Status, Verdict
from tutor.process import prctl
from tutor.process.process_table import descendants

LIMIT_S = 180.0
POLL_S = 0.02
MAX_EXTRA_MB = 150.0
MAX_REPORT_KB = 1024.0
OUR_PROGRAMS = (b"tutor", b"tutor.engine", b"supervisor.py")


@dataclass
class Checked:
    """One check. `peak_mb` is the peak resident memory of our own processes together."""

    name: str
    exit: int = 0
    took_s: float = 0.0
    peak_mb: float = 0.0
    report_kb: float = 0.0
    left: list[str] = field(default_factory=list)
    wrong: list[str] = field(default_factory=list)


class PeakMemory:
    """The peak resident memory of our processes that are alive at one time, by the kernel's high-water marks."""

    def __init__(self) -> None:
        self.mb = 0.0

    def update(self, root: int) -> None:
        """Read the memory of `root` and those of its descendants that are ours.

        A fork before its exec still has its parent's command line and memory; it is not counted.
        """
        total_kb = 0
        commands: dict[int, bytes] = {}
        for pid, parent in ((root, 0), *((p.pid, p.parent) for p in descendants(root))):
            try:
                commands[pid] = Path(f"/proc/{pid}/cmdline").read_bytes()
                is_ours = any(word.endswith(OUR_PROGRAMS) for word in commands[pid].split(b"\0"))
                if not is_ours or commands[pid] == commands.get(parent):
                    continue
                status = Path(f"/proc/{pid}/status").read_text()
            except OSError:  # it has just ended
                continue
            peak = next((line.split()[1] for line in status.splitlines() if line.startswith("VmHWM")), "0")
            total_kb += int(peak)
        self.mb = max(self.mb, total_kb / 1024)


def check(name: str, exercise: str, arguments: Iterable[str], folder: Path | None) -> tuple[Checked, bytes]:
    """Check a copy of the folder from the command line; return what it cost, and the report."""
    with tempfile.TemporaryDirectory(prefix="hostile-") as temporary:
        base = Path(temporary)
        for inner in ("tmp", "home"):
            (base / inner).mkdir()
        work = shutil.copytree(folder, base / "work") if folder else base
        shared_before, running_before = set(os.listdir("/dev/shm")), _running()
        command = [*module_command("tutor"), "check", exercise, *arguments, "--format", "json"]
        if folder:
            command.append(str(work))
        started, peak = time.monotonic(), PeakMemory()
        report = base / "report"
        with report.open("wb") as out, (base / "errors").open("wb") as errors:
            environment = {**os.environ, "TMPDIR": str(base / "tmp"), "HOME": str(base / "home")}
            process = subprocess.Popen(command, stdout=out, stderr=errors, cwd=work, env=environment)
            while process.poll() is None and time.monotonic() - started < LIMIT_S:
                peak.update(process.pid)
                time.sleep(POLL_S)
        took_s = time.monotonic() - started
        found = Checked(name, process.poll() or 0, took_s, peak.mb, report.stat().st_size / 1024)
        if process.returncode is None:
            found.wrong.append(f"it has not ended after {LIMIT_S:g} s")
            process.kill()
            process.wait()
        found.left = [*_end_orphans(running_before), *_find_files(base / "tmp")]
        found.left += [f"/dev/shm/{name}" for name in sorted(set(os.listdir("/dev/shm")) - shared_before)]
        if found.exit not in (0, 1, 3):
            found.wrong.append((base / "errors").read_text(errors="replace")[-300:].strip())
        return found, report.read_bytes()


def _running() -> frozenset[int]:
    return frozenset(process.pid for process in descendants(os.getpid()))


def _end_orphans(before: frozenset[int]) -> list[str]:
    """Kill the orphans that we, as the subreaper, have inherited, except `before`, and return their command lines."""
    left = []
    for orphan in descendants(os.getpid()):
        if orphan.pid in before:
            continue
        command = Path(f"/proc/{orphan.pid}/cmdline").read_bytes().replace(b"\0", b" ").decode(errors="replace")
        if orphan.alive:
            left.append(command.strip() or f"process {orphan.pid}")
            os.kill(orphan.pid, signal.SIGKILL)
        with suppress(ChildProcessError):
            os.waitpid(orphan.pid, 0)
    return left


def _find_files(folder: Path) -> list[str]:
    """List what is left in a temporary folder, except for our own base folder and its logs."""
    own = folder / f"ros-tutor-{os.getuid()}"
    left = [each for each in folder.iterdir() if each != own]
    left += [each for each in own.iterdir() if each.name != "log"] if own.exists() else []
    return [str(each.relative_to(folder.parent)) for each in sorted(left)]


def compare_with_expected(case: Case, found: Checked, report: bytes, ordinary_mb: float) -> None:
    """Add to `found.wrong` whatever violates the case's expectations or our limits."""
    expected = case.expected.exit if case.expected.exit is not None else (0 if case.expected.passes else 1)
    if found.exit != expected:
        found.wrong.append(f"exit code {found.exit}, not {expected}")
    try:
        judged = json.loads(report)["exercises"]
    except (ValueError, KeyError):
        judged = []
        if expected != 3:
            found.wrong.append("no report")
    for each in judged:
        found.wrong += compare(case, _parse_result(each)).wrong
    if found.peak_mb > ordinary_mb + MAX_EXTRA_MB:
        found.wrong.append(f"{found.peak_mb - ordinary_mb:.0f} MB above an ordinary check")
    if found.report_kb > MAX_REPORT_KB:
        found.wrong.append(f"a report of {found.report_kb:.0f} KB")
    if found.left:
        found.wrong.append("left behind: " + ", ".join(found.left))


def _parse_result(report: Mapping[str, Any]) -> ExerciseResult:
    """Build an exercise's result from the report, as far as `compare` needs it."""
    return ExerciseResult(
        report["id"],
        "",
        (),
        tuple(
            CriterionResult(
                each["id"],
                each["id"],
                each["bonus"],
                Verdict(
                    Status(each["status"]),
                    observed=each.get("observed") or "",
                    cause=each.get("cause") or "",
                    step=each.get("step") or "",
                ),
                0.0,
            )
            for each in report["criteria"]
        ),
        0.0,
    )


def table(rows: Iterable[Checked]) -> str:
    """Format one line for each check."""
    lines = [f"{'check':<44}{'exit':>5}{'s':>7}{'MB':>6}{'report KB':>11}  as expected"]
    lines += [
        f"{row.name:<44}{row.exit:>5}{row.took_s:>7.1f}{row.peak_mb:>6.0f}{row.report_kb:>11.1f}  "
        + ("; ".join(row.wrong) if row.wrong else "yes")
        for row in rows
    ]
    return "\n".join(lines)


def main() -> int:
    """Return exit code 0 if everything is as expected, 1 if not, 2 if no submission matches."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("wanted", nargs="*")
    parser.add_argument("--isolate", action="store_true", help="run all checks with --isolate")
    arguments = parser.parse_args()
    wanted, options = arguments.wanted, ["--isolate"] if arguments.isolate else []
    cases = [case for case in find_hostile() if not wanted or str(case).startswith(tuple(wanted))]
    if not cases:
        print(f"no hostile submission is named {' or '.join(wanted) or 'anything'}", file=sys.stderr)
        return 2
    prctl.adopt_orphans(True)
    rows: list[Checked] = []
    ordinary: dict[str, float] = {}
    for exercise in sorted({case.exercise for case in cases}):
        row, _ = check(f"{exercise} solution", exercise, ["--solution", *options], None)
        compare_with_expected(Case(exercise, "right", Path(), Expected("", passes=True)), row, b'{"exercises":[]}', 1e9)
        ordinary[exercise] = row.peak_mb
        rows.append(row)
    for case in cases:
        print(case, file=sys.stderr)
        row, report = check(str(case), case.exercise, options, case.folder)
        compare_with_expected(case, row, report, ordinary[case.exercise])
        rows.append(row)
    print(table(rows))
    hostile = rows[len(ordinary) :]
    print(
        f"{len(hostile)} hostile submissions: at most {max(row.took_s for row in hostile):.1f} s, "
        f"{max(row.peak_mb for row in hostile):.0f} MB, {max(row.report_kb for row in hostile):.0f} KB of report; "
        f"{sum(bool(row.wrong) for row in hostile)} not as expected"
    )
    return 1 if any(row.wrong for row in rows) else 0


if __name__ == "__main__":
    sys.exit(main())
