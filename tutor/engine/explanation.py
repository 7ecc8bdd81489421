"""Ask the catalogue of mistakes why a criterion failed."""

from __future__ import annotations

import sys
from pathlib import Path

from tutor.content.loader import BUNDLED
from tutor.engine.check_errors import as_check_error, is_ours
from tutor.engine.modules import enter_checks
from tutor.judge.check import Check
from tutor.judge.verdict import Failure, Verdict


def explain(verdict: Verdict, check: Check) -> Verdict:
    """The verdict; if it is a failure, with the mistake that explains its symptom."""
    if not isinstance(verdict, Failure):
        return verdict
    from tutor.mistakes import explain as explain_failure  # late: it reads the source, and most criteria pass

    if check.mistakes.startswith("checks."):  # one of ours, which another course may have hidden
        enter_checks(BUNDLED / "checks")
    try:
        return explain_failure(verdict, check)
    except Exception as error:  # an entry of the exercise's own catalogue may be wrong
        module = sys.modules.get(check.mistakes)
        source = Path(module.__file__) if module is not None and module.__file__ else None
        if source is None or is_ours(source):
            raise
        raise as_check_error(error, source.parent) or error from error
