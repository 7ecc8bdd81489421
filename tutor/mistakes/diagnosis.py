"""Why a criterion failed: the surest mistake that explains its symptom."""

from __future__ import annotations

import importlib
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass

from tutor.judge.check import Check
from tutor.judge.result import Remark
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import Trace
from tutor.judge.verdict import Failure, Status, Verdict
from tutor.mistakes.entry import CATALOGUE, Case, Catalogue, Evidence, Found, Mistake

MAX_REMARKS = 2

MAX_CODE_CHARACTERS = 100
"""A line of the learner's code is cut to this length in a sentence."""


@dataclass(frozen=True, slots=True)
class Diagnosis:
    """A mistake as it was found in one run: `cause` and `step` in words, `file` and `line` ("" and 0 if none).

    `evidence`: what shows it; with `SYMPTOM`, only that something is missing.
    """

    mistake: str
    cause: str
    step: str
    file: str = ""
    line: int = 0
    evidence: Evidence = Evidence.SYMPTOM


def why(seen: Observation, catalogues: Sequence[Catalogue]) -> Diagnosis:
    """The surest mistake that explains what was seen; the symptom itself, at last.

    `catalogues`: those of the exercise and the course come before ours.
    """
    case = Case(seen)
    for entry in _asked(case, catalogues):
        for occurrence in entry.find(case):
            return describe(entry, occurrence, case)
    raise LookupError(f"no mistake stands for the symptom {seen.symptom.name}")


def _asked(case: Case, catalogues: Sequence[Catalogue]) -> Iterator[Mistake]:
    entries = [entry for catalogue in catalogues for entry in catalogue.entries.values()]
    yield from sorted((entry for entry in entries if case.symptom in entry.explains), key=lambda entry: entry.evidence)


def describe(entry: Mistake, occurrence: Found, case: Case) -> Diagnosis:
    """The mistake in words, with the learner's own names."""
    code = occurrence.code
    if code.count("(") > code.count(")"):  # the rest of the call is on the next lines
        code = f"{code} …"
    if len(code) > MAX_CODE_CHARACTERS:
        code = f"{code[: MAX_CODE_CHARACTERS - 3]}..."
    words = {
        "line": case.place(occurrence.file, occurrence.line),
        "code": code,
        "nodes": case.nodes,
        **occurrence.words,
    }
    cause = f"{entry.title}: {entry.says.format(**words)}"
    return Diagnosis(entry.id, cause, entry.do.format(**words), occurrence.file, occurrence.line, entry.evidence)


def catalogues_of(check: Check) -> tuple[Catalogue, ...]:
    """The catalogues to ask about a check's submissions: the exercise's own, if it has one, then ours."""
    own = [importlib.import_module(check.mistakes).CATALOGUE] if check.mistakes else []
    return (*own, CATALOGUE)


def explain(failure: Failure, check: Check) -> Verdict:
    """The verdict that says why: the failure with the mistake that explains what was seen."""
    assert failure.seen is not None
    found = why(failure.seen, catalogues_of(check))
    return Verdict(
        Status.FAILED,
        failure.expected,
        failure.observed,
        found.cause,
        found.step,
        failure.evidence,
        found.mistake,
        f"{found.file}:{found.line}" if found.line else "",
        root=_root(found, failure.seen),
    )


def _root(found: Diagnosis, seen: Observation) -> str:
    """What failures by this mistake have in common: whatever the run was about, a process ends in one way."""
    if seen.symptom in (Symptom.DOES_NOT_END, Symptom.ENDS_BADLY):
        return "Ctrl+C"
    return "the program" if found.evidence is Evidence.PROCESS and not found.line else ""


def remarks(sources: Mapping[str, str], check: Check, known: Collection[str] = ()) -> tuple[Remark, ...]:
    """What works in these files (name to text), but will bite: at most `MAX_REMARKS`, in the catalogue's order.

    `known`: the mistakes that a bonus criterion has told already.
    """
    told: list[Remark] = []
    for name in sources:
        case = Case(Symptom.ENDED.seen(Trace(name, sources={name: sources[name]}), passed=True))
        for entry in (entry for catalogue in catalogues_of(check) for entry in catalogue.entries.values()):
            if not entry.remark or entry.id in (*known, *(remark.mistake for remark in told)):
                continue
            for occurrence in entry.find(case):
                words = {"line": f"line {occurrence.line}", "code": occurrence.code, **occurrence.words}
                told.append(Remark(entry.id, entry.remark.format(**words), name, occurrence.line))
                break
    return tuple(told[:MAX_REMARKS])
