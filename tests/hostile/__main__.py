"""Check every hostile submission, one at a time, and print what came out, what it cost and what it left behind.

    uv run python -m tests.hostile [EXERCISE[/hostile/NAME] ...]

Before them, each exercise's solution, as the ordinary check beside which their memory is measured. Exit code 1 where
anything is not as expected: the verdict, the exit code, memory, the report's size, what is left.
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
from tutor.process.supervisor import descendants

LIMIT_S = 180.0
LOOK_EVERY_S = 0.02
MOST_ABOVE_ORDINARY_MB = 150.0
MOST_REPORT_KB = 1024.0
OURS = (b"tutor", b"tutor.engine", b"supervisor.py")
EXERCISES = ("i1.1", "i1.2", "i1.3", "i2.1", "i2.2", "i2.3")


@dataclass
class Checked:
    """One check. `peak_mb` is the resident memory of our own processes, at most, together."""

    name: str
    exit: int = 0
    took_s: float = 0.0
    peak_mb: float = 0.0
    report_kb: float = 0.0
    left: list[str] = field(default_factory=list)
    wrong: list[str] = field(default_factory=list)


class Peak:
    """The highest resident memory of our processes that live at a time, each by the kernel's own high-water mark."""

    def __init__(self) -> None:
        self.mb = 0.0

    def look(self, root: int) -> None:
        """Read it for `root` and those of its descendants that are ours.

        A fork that is about to become another program has its parent's command line, and its parent's memory, still.
        """
        together_kb = 0
        commands: dict[int, bytes] = {}
        for pid, parent in ((root, 0), *((p.pid, p.parent) for p in descendants(root))):
            try:
                commands[pid] = Path(f"/proc/{pid}/cmdline").read_bytes()
                ours = any(word.endswith(OURS) for word in commands[pid].split(b"\0"))
                if not ours or commands[pid] == commands.get(parent):
                    continue
                status = Path(f"/proc/{pid}/status").read_text()
            except OSError:  # it has just ended
                continue
            peak = next((line.split()[1] for line in status.splitlines() if line.startswith("VmHWM")), "0")
            together_kb += int(peak)
        self.mb = max(self.mb, together_kb / 1024)


def check(name: str, exercise: str, arguments: Iterable[str], folder: Path | None) -> tuple[Checked, bytes]:
    """Check a copy of the folder with the command line. Gives what it cost, and the report."""
    with tempfile.TemporaryDirectory(prefix="hostile-") as made:
        base = Path(made)
        for inner in ("tmp", "home"):
            (base / inner).mkdir()
        work = shutil.copytree(folder, base / "work") if folder else base
        shared = set(os.listdir("/dev/shm"))
        command = [*module_command("tutor"), "check", exercise, *arguments, "--format", "json"]
        if folder:
            command.append(str(work))
        started, peak = time.monotonic(), Peak()
        report = base / "report"
        with report.open("wb") as out, (base / "errors").open("wb") as errors:
            environment = {**os.environ, "TMPDIR": str(base / "tmp"), "HOME": str(base / "home")}
            process = subprocess.Popen(command, stdout=out, stderr=errors, cwd=work, env=environment)
            while process.poll() is None and time.monotonic() - started < LIMIT_S:
                peak.look(process.pid)
                time.sleep(LOOK_EVERY_S)
        took_s = time.monotonic() - started
        found = Checked(name, process.poll() or 0, took_s, peak.mb, report.stat().st_size / 1024)
        if process.returncode is None:
            found.wrong.append(f"it has not ended after {LIMIT_S:g} s")
            process.kill()
            process.wait()
        found.left = [*_end_orphans(), *_files(base / "tmp")]
        found.left += [f"/dev/shm/{name}" for name in sorted(set(os.listdir("/dev/shm")) - shared)]
        if found.exit not in (0, 1, 3):
            found.wrong.append((base / "errors").read_text(errors="replace")[-300:].strip())
        return found, report.read_bytes()


def _end_orphans() -> list[str]:
    """End what has come to us, the subreaper of all that was started here, and say what it was."""
    left = []
    for orphan in descendants(os.getpid()):
        command = Path(f"/proc/{orphan.pid}/cmdline").read_bytes().replace(b"\0", b" ").decode(errors="replace")
        if orphan.alive:
            left.append(command.strip() or f"process {orphan.pid}")
            os.kill(orphan.pid, signal.SIGKILL)
    try:
        while os.waitpid(-1, os.WNOHANG)[0]:
            pass
    except ChildProcessError:
        pass
    return left


def _files(folder: Path) -> list[str]:
    """What is in a temporary folder, but for our own in it, which stays, and the logs there."""
    own = folder / f"ros-tutor-{os.getuid()}"
    left = [each for each in folder.iterdir() if each != own]
    left += [each for each in own.iterdir() if each.name != "log"] if own.exists() else []
    return [str(each.relative_to(folder.parent)) for each in sorted(left)]


def compare_with_expected(case: Case, found: Checked, report: bytes, ordinary_mb: float) -> None:
    """Say in `found.wrong` what is not as the case, and our bounds, have it."""
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
        found.wrong += compare(case, _result(each)).wrong
    if found.peak_mb > ordinary_mb + MOST_ABOVE_ORDINARY_MB:
        found.wrong.append(f"{found.peak_mb - ordinary_mb:.0f} MB above an ordinary check")
    if found.report_kb > MOST_REPORT_KB:
        found.wrong.append(f"a report of {found.report_kb:.0f} KB")
    if found.left:
        found.wrong.append("left behind: " + ", ".join(found.left))


def _result(written: Mapping[str, Any]) -> ExerciseResult:
    """What a report says of an exercise, as far as `compare` looks at it."""
    return ExerciseResult(
        written["id"],
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
                    hint=each.get("hint") or "",
                ),
                0.0,
            )
            for each in written["criteria"]
        ),
        0.0,
    )


def table(rows: Iterable[Checked]) -> str:
    """One line for each check."""
    lines = [f"{'check':<44}{'exit':>5}{'s':>7}{'MB':>6}{'report KB':>11}  as expected"]
    lines += [
        f"{row.name:<44}{row.exit:>5}{row.took_s:>7.1f}{row.peak_mb:>6.0f}{row.report_kb:>11.1f}  "
        + ("; ".join(row.wrong) if row.wrong else "yes")
        for row in rows
    ]
    return "\n".join(lines)


def main() -> int:
    """Exit code 0 where everything is as expected, 1 where not, 2 where no submission is called so."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("wanted", nargs="*")
    wanted = parser.parse_args().wanted
    cases = [case for case in find_hostile() if not wanted or str(case).startswith(tuple(wanted))]
    if not cases:
        print(f"no hostile submission is called {' or '.join(wanted) or 'anything'}", file=sys.stderr)
        return 2
    prctl.adopt_orphans(True)
    rows: list[Checked] = []
    ordinary: dict[str, float] = {}
    for exercise in sorted({case.exercise for case in cases}):
        row, _ = check(f"{exercise} solution", exercise, ["--solution"], None)
        compare_with_expected(Case(exercise, "right", Path(), Expected("", passes=True)), row, b'{"exercises":[]}', 1e9)
        ordinary[exercise] = row.peak_mb
        rows.append(row)
    for case in cases:
        print(case, file=sys.stderr)
        row, report = check(str(case), case.exercise, [], case.folder)
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
