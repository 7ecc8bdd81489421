"""Ask the catalogue of mistakes why a criterion failed."""

from __future__ import annotations

from tutor.judge.check import Check
from tutor.judge.verdict import Failure, Verdict


def explain(verdict: Verdict, check: Check) -> Verdict:
    """The verdict; if it is a failure, with the mistake that explains its symptom."""
    if not isinstance(verdict, Failure):
        return verdict
    from tutor.mistakes import explain as explain_failure  # late: it reads the source, and most criteria pass

    return explain_failure(verdict, check)
