"""Judges one test submission as the terminal app would, and compares with what it must be judged as."""

from __future__ import annotations

import asyncio
import os
import sys
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from tutor.content.submissions import EXPECT, Case, Expected, read_case
from tutor.errors import ContentError
from tutor.judge.events import ExerciseJudged, decode
from tutor.judge.result import CriterionResult, ExerciseResult
from tutor.judge.verdict import Status

ROOT = Path(__file__).parent / "submissions"
LIMIT_S = 180.0
LEFT_LIMIT_S = 60.0
"""Longer than any check takes, and so than anything that it ends itself."""


@dataclass
class Outcome:
    """What one run of one case gave. `wrong` says in words what is not as expected; empty where all is.

    `verdict` is what came out, criterion by criterion: the same each time, unless the submission or we are flaky.
    """

    case: Case
    wrong: list[str] = field(default_factory=list)
    false_pass: bool = False
    false_failure: bool = False
    took_s: float = 0.0
    verdict: str = "none"


def find(wanted: Sequence[str] = ()) -> tuple[list[Case], list[ContentError]]:
    """The cases whose name begins with one of `wanted` (all, without any), and those that cannot be read."""
    cases: list[Case] = []
    broken: list[ContentError] = []
    for file in sorted(ROOT.glob(f"*/*/*/{EXPECT}")):
        try:
            cases.append(read_case(file.parent))
        except ContentError as error:
            broken.append(error)
    return [case for case in cases if not wanted or any(str(case).startswith(each) for each in wanted)], broken


def holds_here(case: Case) -> bool:
    """Whether the case is about the ROS that is used here."""
    from tutor.ros.environment import detect

    return case.expected.ros in ("", detect().kind)


class NoVerdict(Exception):
    """A check that gave none: why."""


async def judge(case: Case) -> Outcome:
    """Check the submission as the terminal app does, in a process of its own, and compare."""
    started = time.monotonic()
    try:
        result, err = await _checked(case.exercise, case.folder)
    except NoVerdict as error:
        return Outcome(case, [str(error)], took_s=time.monotonic() - started)
    took = time.monotonic() - started
    outcome = compare(case, result)
    outcome.took_s = took
    if err and case.kind != "hostile":  # some write there themselves, past us
        outcome.wrong.append(f"stderr: {err[-300:]}")
    outcome.wrong += [f"left behind: {line}" for line in await _left(case.expected.gone)]
    return outcome


async def check_folder(exercise: str, folder: Path) -> ExerciseResult:
    """Check the files in a folder, in a process of its own. Raises NoVerdict where there is no verdict."""
    return (await _checked(exercise, folder))[0]


async def _checked(exercise: str, folder: Path) -> tuple[ExerciseResult, str]:
    """The verdict, and what was written to stderr."""
    process = await asyncio.create_subprocess_exec(
        *(sys.executable, "-m", "tutor.engine", exercise, str(folder)),
        stdout=asyncio.subprocess.PIPE,
        stderr=asyncio.subprocess.PIPE,
        stdin=asyncio.subprocess.DEVNULL,
        env=dict(os.environ),  # a copy: pytest writes to the real one while, in another thread, this is started
        limit=2**24,
    )
    try:
        out, err = await asyncio.wait_for(process.communicate(), LIMIT_S)
    except TimeoutError:
        process.terminate()
        await process.communicate()
        raise NoVerdict(f"no verdict in {LIMIT_S:g} s") from None
    except asyncio.CancelledError:
        process.terminate()  # it ends what it started
        await process.communicate()
        raise
    results = [e.result for e in map(decode, out.decode().splitlines()) if isinstance(e, ExerciseJudged)]
    if not results:
        raise NoVerdict(f"no verdict: exit code {process.returncode}: {err.decode()[-500:]}")
    return results[0], err.decode()


def compare(case: Case, result: ExerciseResult) -> Outcome:
    """Hold the result against what is expected (see tests/submissions/README.md)."""
    expected = case.expected
    outcome = Outcome(case, verdict=" ".join(f"{c.id}:{c.verdict.status.value}" for c in result.criteria))
    some_failed = any(c.verdict.status is Status.FAILED for c in result.criteria)
    for criterion in result.criteria:
        _compare(criterion, expected, some_failed, outcome)
    any_of = expected.fails_any
    if any_of and not any(c.id in any_of and c.verdict.status is Status.FAILED for c in result.criteria):
        outcome.wrong.append(f"one of {', '.join(sorted(any_of))} should fail")
        outcome.false_pass = True
    return outcome


def _compare(criterion: CriterionResult, expected: Expected, some_failed: bool, outcome: Outcome) -> None:
    status, cause = criterion.verdict.status, criterion.verdict.cause
    told = f"{criterion.id} {status.value}: {criterion.verdict.observed} | {cause}"
    must_fail = criterion.id in (*expected.fails, *expected.bonus_failed)
    if status is Status.ERROR and expected.exit == 3:
        pass
    elif status is Status.ERROR:
        outcome.wrong.append(f"not judged: {told}")
    elif must_fail and status is not Status.FAILED:
        outcome.wrong.append(f"should fail: {told}")
        outcome.false_pass |= status is Status.PASSED
    elif must_fail or criterion.id in expected.fails_any:
        if status is Status.FAILED:
            outcome.wrong += _wrong_words("cause", expected.causes, expected, criterion.id, cause)
            outcome.wrong += _wrong_words("step", expected.steps, expected, criterion.id, criterion.verdict.hint)
    elif criterion.id in expected.not_passed:
        if status is Status.PASSED:
            outcome.wrong.append(f"should not pass: {told}")
            outcome.false_pass = True
    elif criterion.id not in expected.either and not _fine(status, some_failed):
        outcome.wrong.append(f"should pass: {told}")
        outcome.false_failure = True


def _fine(status: Status, some_failed: bool) -> bool:
    """Whether a criterion that no key names may end so: what is skipped needs a failed one to be skipped for."""
    return status is Status.PASSED or (status is Status.SKIPPED and some_failed)


def _wrong_words(
    what: str, all_texts: Mapping[str, tuple[str, ...]], expected: Expected, criterion: str, said: str
) -> list[str]:
    general = () if criterion in expected.bonus_failed else all_texts.get("", ())
    texts = all_texts.get(criterion, general)
    if not texts or any(text.casefold() in said.casefold() for text in texts):
        return []
    return [f"{criterion}: {what} is “{said}”, not {' or '.join(texts)}"]


async def _left(text: str) -> list[str]:
    """The commands with this text that go on for as long as nothing ends them.

    Others judge their submissions beside us, and what they have started goes when their checks are over.
    """
    left = _running(text)
    ends = time.monotonic() + LEFT_LIMIT_S
    while left and time.monotonic() < ends:
        await asyncio.sleep(0.2)
        there = _running(text)
        left = {pid: command for pid, command in left.items() if there.get(pid) == command}
    return list(left.values())


def _running(text: str) -> dict[str, str]:
    """The processes whose command line has this text, by pid; none where there is no text."""
    found: dict[str, str] = {}
    for path in Path("/proc").glob("[0-9]*/cmdline") if text else ():
        try:
            command = path.read_bytes().replace(b"\0", b" ").decode(errors="replace")
        except OSError:
            continue
        if text in command:
            found[path.parent.name] = command
    return found
