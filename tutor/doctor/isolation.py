"""Examination of whether submissions can be isolated, as `check --isolate` and `grade` do."""

from __future__ import annotations

from tutor.doctor.finding import Finding
from tutor.process.isolation_support import try_isolation


def support() -> Finding:
    """Examine whether a submission can be isolated. Only those who check the code of others need it."""
    name = "Isolation"
    problem = try_isolation()
    if problem is None:
        return Finding(name, True, "submissions can be isolated with bubblewrap")
    what, hint = str(problem), problem.hint
    text = f"{what[0].upper()}{what[1:]}. Code that you have not read would be checked as yourself."
    return Finding(name, None, text, f"{hint[0].upper()}{hint[1:]}")
