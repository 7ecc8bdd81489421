"""Judge recordings again, without ROS, and show what has changed.

    uv run python -m tests.recordings.replay [EXERCISE[/right|wrong[/NAME]] ...] [--folder FOLDER]
                                             [--accept] [--reports|--limits]

Without `--folder`, those that are kept in the repository; `tests/recordings/test_replay.py` judges these as well.

Prints each criterion whose status, mistake or place differs from what the recording holds, and how many do not.
`--accept` writes today's outcomes into the recordings; `--reports` prints every failing report as a learner reads it;
`--limits` prints only the reports that are too long, or whose step has too much code or a line of our solution.
"""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from statistics import median

from tests.mistakes.limits import MAX_WORDS, MEDIAN_WORDS, faults_of, solution_lines, words_of
from tests.recordings.recording import (
    KEPT,
    JudgeCall,
    Outcome,
    Recording,
    accept,
    outcome,
    read,
    scenario_name,
)
from tutor.content import load_course
from tutor.engine.explanation import explain
from tutor.engine.loading import load_check
from tutor.judge.check import Check
from tutor.judge.result import CriterionResult, tell_roots_once
from tutor.judge.verdict import Status, Verdict, bounded, skipped
from tutor.mistakes import catalogues_of


def judge_again(recording: Recording, check: Check) -> dict[str, Outcome]:
    """Judge the recorded facts with the judges of today: outcomes by criterion.

    A criterion that was not judged (it was skipped) keeps its outcome.
    """
    verdicts: dict[str, Verdict] = {}
    taken = {criterion.id: len(criterion.facts) for criterion in check.criteria}
    # A recording made when a judge took other facts says nothing about it any more.
    calls = {
        call.criterion: call for call in recording.calls if call.scenario or len(call.facts) == taken[call.criterion]
    }
    for criterion in check.criteria:
        if criterion.id not in calls:
            continue
        blocking = next((d for d in criterion.after if d in verdicts and not verdicts[d].passed), None)
        if blocking is not None:
            verdicts[criterion.id] = skipped(f"not judged, because `{blocking}` did not pass")
        else:
            verdicts[criterion.id] = bounded(explain(_judge(check, calls[criterion.id]), check))
    results = [CriterionResult(c.id, c.id, c.bonus, verdicts[c.id], 0.0) for c in check.criteria if c.id in verdicts]
    told = {each.id: outcome(each.verdict) for each in tell_roots_once(results)}
    return {**recording.outcomes, **told}


def _judge(check: Check, call: JudgeCall) -> Verdict:
    criterion = next(each for each in check.criteria if each.id == call.criterion)
    if not call.scenario:
        return criterion.judge(*call.facts)
    early = {scenario_name(scenario): judge for scenario, judge in criterion.early}
    verdict = early[call.scenario](*call.facts)
    assert verdict is not None, f"{check.exercise} {call.criterion}: its early judge no longer fails this"
    return verdict


def differences(before: Mapping[str, Outcome], now: Mapping[str, Outcome]) -> list[str]:
    """What differs, a line for each criterion; statuses first."""
    lines = []
    for criterion, old in before.items():
        new = now.get(criterion, Outcome("none"))
        if old.status != new.status:
            lines.append(f"! {criterion}: {old.status}, now {new.status}: {new.observed} | {new.cause}")
        elif old.status == Status.FAILED.value and _slug(old.mistake) != _slug(new.mistake) and not new.same_as:
            lines += [f"  {criterion}: {old.mistake or old.cause}", f"      now {new.cause}", f"      step {new.step}"]
    return lines


def _print_reports(case: str, outcomes: Mapping[str, Outcome]) -> None:
    for criterion, told in outcomes.items():
        if told.status == Status.FAILED.value:
            print(f"{case} {criterion}", f"observed  {told.observed}", f"why       {told.cause}", sep="\n    ")
            print(f"    step      {told.step}")


class Limits:
    """Looks at every failing report of one run for what breaks a limit, and keeps their lengths in words."""

    def __init__(self) -> None:
        self.words: list[int] = []
        self.broken = 0

    def look_at(self, case: str, outcomes: Mapping[str, Outcome], check: Check, solution: Sequence[str]) -> None:
        """Count the words of each failing report, and print what is wrong with it."""
        entries = {
            entry.id: entry for catalogue in reversed(catalogues_of(check)) for entry in catalogue.entries.values()
        }
        for criterion, told in outcomes.items():
            if told.status != Status.FAILED.value or told.same_as:
                continue
            length = words_of(told.cause, told.step)
            self.words.append(length)
            entry = entries.get(told.mistake)
            faults = list(faults_of(told.step, slip=entry is not None and entry.slip, solution=solution))
            if length > MAX_WORDS:
                faults.append(f"it has {length} words")
            if faults:
                self.broken += 1
                print(f"{case} {criterion}: {'; '.join(faults)}\n    {told.cause}\n    step  {told.step}")

    def summary(self) -> str:
        """The median of the words, and how many reports break a limit."""
        middle = median(self.words) if self.words else 0
        reports = len(self.words)
        return f"{reports} failing reports, median {middle:g} words (limit {MEDIAN_WORDS}), {self.broken} break a limit"


def _slug(mistake: str) -> str:
    return mistake.lower().replace(" ", "-")


def main() -> int:
    """Return exit code 1 if a status has changed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("wanted", nargs="*")
    parser.add_argument("--folder", type=Path, default=KEPT)
    parser.add_argument("--accept", action="store_true", help="write today's outcomes into the recordings")
    parser.add_argument("--reports", action="store_true", help="print every failing report")
    parser.add_argument("--limits", action="store_true", help="print only the reports that break a limit")
    arguments = parser.parse_args()
    limits = Limits()
    solutions: dict[str, tuple[str, ...]] = {}
    course = load_course(None)
    checks: dict[str, Check] = {}
    counts: Counter[str] = Counter()
    accepted: dict[str, Mapping[str, Outcome]] = {}
    for recording in read(arguments.folder, arguments.wanted):
        if recording.exercise not in checks:
            lesson = course.find(recording.exercise)
            checks[recording.exercise] = load_check(lesson)
            solutions[recording.exercise] = solution_lines(lesson.folder / "solution")
        now = judge_again(recording, checks[recording.exercise])
        lines = differences(recording.outcomes, now)
        if arguments.limits:
            judged = {each: told for each, told in now.items() if told is not recording.outcomes.get(each)}
            limits.look_at(recording.case, judged, checks[recording.exercise], solutions[recording.exercise])
        elif lines:
            print(f"{recording.case}\n  " + "\n  ".join(lines))
        if arguments.reports:
            _print_reports(recording.case, now)
        counts["submissions"] += 1
        counts["criteria"] += len(now)
        counts["failed"] += sum(each.status == Status.FAILED.value for each in now.values())
        counts["other status"] += sum(line.startswith("!") for line in lines)
        counts["other mistake"] += sum(line.startswith("  ") and not line.startswith("    ") for line in lines)
        accepted[recording.case] = now
    if arguments.accept:
        accept(arguments.folder, accepted)
    print(", ".join(f"{count} {what}" for what, count in counts.items()))
    if arguments.limits:
        print(limits.summary())
    return 1 if counts["other status"] else 0


if __name__ == "__main__":
    sys.exit(main())
