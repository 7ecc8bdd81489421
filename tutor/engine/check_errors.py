"""Tells errors in the code of a check as its author's: the file, the line, and one sentence."""

from __future__ import annotations

import traceback
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from tutor.content.loader import BUNDLED
from tutor.errors import CheckError, Fault, UnknownType
from tutor.judge.bench import Bench, Scenario
from tutor.judge.check import Check, EarlyJudge, Judge
from tutor.judge.verdict import Verdict


def is_ours(source: Path) -> bool:
    """Whether a check belongs to the course that comes with ros-tutor: its errors are faults of ours."""
    return source.resolve().is_relative_to(BUNDLED / "checks")


def as_check_error(error: Exception, folder: Path) -> CheckError | None:
    """Return the error in the code below `folder` that led to this exception; None if that code had no part in it."""
    if isinstance(error, CheckError):
        return error
    if isinstance(error, SyntaxError) and error.filename:
        return CheckError(Path(error.filename), error.msg, error.lineno)
    for part in error.exceptions if isinstance(error, ExceptionGroup) else ():
        if (found := as_check_error(part, folder)) is not None:
            return found
    root = folder.resolve()
    frames = [
        frame
        for frame in traceback.extract_tb(error.__traceback__)
        if Path(frame.filename).resolve().is_relative_to(root)
    ]
    return CheckError(Path(frames[-1].filename), _sentence(error), frames[-1].lineno) if frames else None


def guarded(check: Check, folder: Path) -> Check:
    """Return the check with its judges and scenarios raising a CheckError where the code below `folder` is wrong."""
    scenarios: dict[Scenario[Any], Scenario[Any]] = {}

    def guard_scenario(scenario: Scenario[Any]) -> Scenario[Any]:
        return scenarios.setdefault(scenario, _GuardedScenario(scenario, folder))

    criteria = tuple(
        replace(
            criterion,
            judge=_guard_judge(criterion.judge, folder),
            facts=tuple(guard_scenario(scenario) for scenario in criterion.facts),
            early=tuple(
                (guard_scenario(scenario), _guard_early_judge(judge, folder)) for scenario, judge in criterion.early
            ),
        )
        for criterion in check.criteria
    )
    return replace(check, criteria=criteria)


@dataclass(frozen=True, slots=True, eq=False)
class _GuardedScenario:
    """A scenario whose errors are told as its author's. It equals the scenario, by which the check may ask for it."""

    scenario: Scenario[Any]
    folder: Path

    async def __call__(self, bench: Bench) -> Any:
        try:
            return await self.scenario(bench)
        except Exception as error:
            raise _told(error, self.folder) from error

    def __eq__(self, other: object) -> bool:
        return self.scenario == (other.scenario if isinstance(other, _GuardedScenario) else other)

    def __hash__(self) -> int:
        return hash(self.scenario)


def _guard_judge(judge: Judge, folder: Path) -> Judge:
    def guarded_judge(*facts: Any) -> Verdict:
        try:
            verdict = judge(*facts)
        except Exception as error:
            raise _told(error, folder) from error
        if not isinstance(verdict, Verdict):
            raise _no_verdict(judge, folder)
        return verdict

    return guarded_judge


def _guard_early_judge(judge: EarlyJudge, folder: Path) -> EarlyJudge:
    def guarded_judge(facts: Any) -> Verdict | None:
        try:
            return judge(facts)
        except Exception as error:
            raise _told(error, folder) from error

    return guarded_judge


def _told(error: Exception, folder: Path) -> Exception:
    """Return what to raise instead: a fault of the machine, or an error that is not the check's, stays what it is."""
    return error if isinstance(error, Fault) else as_check_error(error, folder) or error


def _no_verdict(judge: Callable[..., Any], folder: Path) -> CheckError:
    code = getattr(judge, "__code__", None)
    name = getattr(judge, "__name__", "the judge")
    file, line = (Path(code.co_filename), code.co_firstlineno) if code is not None else (folder, None)
    return CheckError(file, f"{name} returned no verdict: return passed(...), failed(...) or skipped(...)", line)


def _sentence(error: Exception) -> str:
    if isinstance(error, UnknownType):
        return f"this ROS has no type {error}"
    text = " ".join(str(error).split())
    return f"{type(error).__name__}: {text}" if text else type(error).__name__
