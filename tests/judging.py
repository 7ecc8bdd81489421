"""Judge a test submission as the terminal app does, and compare the result with its expect.yaml."""

from __future__ import annotations

import asyncio
import os
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path

from tutor.content import load_course
from tutor.content.expectations import Error, find_deviations
from tutor.content.patches import write_patched
from tutor.content.submissions import EXPECT, PATCH, Case, read_case
from tutor.engine.leftovers import find_leftovers
from tutor.errors import ContentError
from tutor.judge.events import ExerciseJudged, decode
from tutor.judge.result import ExerciseResult

ROOT = Path(__file__).parent / "submissions"
LIMIT_S = 180.0


@dataclass
class Outcome:
    """The outcome of one run of one case. `wrong` describes each deviation from what is expected; empty if none.

    `verdict` lists the statuses by criterion, such as "a:passed b:failed": the same on every run, unless the
    submission or the check is flaky.
    """

    case: Case
    wrong: list[str] = field(default_factory=list)
    false_pass: bool = False
    false_failure: bool = False
    took_s: float = 0.0
    verdict: str = "none"


def find_cases(wanted: Sequence[str] = ()) -> tuple[list[Case], list[ContentError]]:
    """Return the cases whose names start with one of `wanted` (all if empty), and the errors of unreadable ones."""
    cases: list[Case] = []
    broken: list[ContentError] = []
    folders = [file.parent for file in ROOT.glob(f"*/*/*/{EXPECT}")]
    for path in sorted([*folders, *ROOT.glob(f"*/*/*{PATCH}")]):
        try:
            cases.append(read_case(path))
        except ContentError as error:
            broken.append(error)
    return [case for case in cases if not wanted or any(str(case).startswith(prefix) for prefix in wanted)], broken


def holds_here(case: Case) -> bool:
    """Return whether the case applies to the ROS installation in use (bundled or system)."""
    from tutor.ros.environment import detect

    return case.expected.ros in ("", detect().kind)


@contextmanager
def laid_out(case: Case) -> Iterator[Case]:
    """The case with all its files in a folder: what a patch makes of the solution is written into a temporary one."""
    if not case.changes:
        yield case
        return
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch) / case.folder.stem
        write_patched(load_course().find(case.exercise), case.changes, folder)
        yield replace(case, folder=folder, changes=())


class NoVerdict(Exception):
    """A check ended without a verdict; the message says why."""


async def judge(case: Case, only: Sequence[str] = (), record: Path | None = None) -> Outcome:
    """Check the submission as the terminal app does, in a separate process, and compare with what is expected.

    `only`: the criteria to judge (default: all). `record`: a folder for a recording of the check.
    """
    started = time.monotonic()
    engine = ("tests.recordings.engine", str(record), str(case)) if record else ("tutor.engine",)
    try:
        with laid_out(case) as files:
            result, stderr = await run_engine(case.exercise, files.folder, only, engine=engine)
    except NoVerdict as error:
        return Outcome(case, [str(error)], took_s=time.monotonic() - started)
    took = time.monotonic() - started
    outcome = compare(case, result)
    outcome.took_s = took
    if stderr and case.kind != "hostile":  # some hostile submissions write to our stderr directly
        outcome.wrong.append(f"stderr: {stderr[-300:]}")
    outcome.wrong += [f"left behind: {command}" for command in await find_leftovers(case.expected.gone)]
    return outcome


async def check_folder(exercise: str, folder: Path) -> ExerciseResult:
    """Check the files in a folder, in a separate process. Raises NoVerdict if the check gives no verdict."""
    return (await run_engine(exercise, folder))[0]


async def run_engine(
    exercise: str,
    folder: Path,
    only: Sequence[str] = (),
    *,
    first: bool = False,
    engine: Sequence[str] = ("tutor.engine",),
) -> tuple[ExerciseResult, str]:
    """Return the result, and what was written to stderr. Raises NoVerdict if there is no result.

    `engine`: the module to run, and its first arguments.
    """
    words = [*(f"--criterion={criterion}" for criterion in only), *(["--first"] if first else [])]
    out, err, code = await run_to_end(
        [sys.executable, "-m", *engine, exercise, str(folder), *words],
        dict(os.environ),  # a copy: pytest changes os.environ in another thread while this process starts
    )
    results = [e.result for e in map(decode, out.decode().splitlines()) if isinstance(e, ExerciseJudged)]
    if not results:
        raise NoVerdict(f"no verdict: exit code {code}: {err.decode()[-500:]}")
    return results[0], err.decode()


async def run_to_end(command: Sequence[str], environ: Mapping[str, str]) -> tuple[bytes, bytes, int | None]:
    """Return a command's stdout, stderr and exit code. Raises NoVerdict after `LIMIT_S`."""
    process = await asyncio.create_subprocess_exec(
        *command,
        stdout=asyncio.subprocess.PIPE,
        stderr=asyncio.subprocess.PIPE,
        stdin=asyncio.subprocess.DEVNULL,
        env=environ,
        limit=2**24,
    )
    try:
        out, err = await asyncio.wait_for(process.communicate(), LIMIT_S)
    except TimeoutError:
        process.terminate()
        await process.communicate()
        raise NoVerdict(f"no verdict in {LIMIT_S:g} s") from None
    except asyncio.CancelledError:
        process.terminate()  # the engine then ends everything it started
        await process.communicate()
        raise
    return out, err, process.returncode


def compare(case: Case, result: ExerciseResult) -> Outcome:
    """Compare the result with what the case expects (see tests/submissions/README.md)."""
    found = list(find_deviations(case.expected, result))
    errors = [deviation.error for deviation in found]
    return Outcome(
        case,
        [deviation.text for deviation in found],
        false_pass=Error.FALSE_PASS in errors,
        false_failure=Error.FALSE_FAILURE in errors,
        verdict=" ".join(f"{c.id}:{c.verdict.status.value}" for c in result.criteria),
    )
