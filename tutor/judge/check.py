"""A check: scenarios that gather facts, and criteria that judge them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from tutor.judge.bench import Scenario
from tutor.judge.verdict import Verdict

Judge = Callable[..., Verdict]
"""A pure function from the facts of the criterion's scenarios, in their order, to a verdict."""

EarlyJudge = Callable[[Any], Verdict | None]
"""A pure function from the facts of one scenario to a failure that is certain whatever the other scenarios find.

The facts may be partial (`Bench.report_facts`). A result other than a failure means nothing. An early judge must never
fail what the judge would pass.
"""


@dataclass(frozen=True, slots=True)
class Criterion:
    """One acceptance criterion.

    `facts`: the scenarios whose facts `judge` takes; they run concurrently with all others. `after`: ids of criteria
    that must pass first, else this one is skipped, since it would only repeat their failure. `early`: scenarios that
    may be enough to fail the criterion, each with the early judge of its facts.
    """

    id: str
    judge: Judge
    facts: tuple[Scenario[Any], ...]
    after: tuple[str, ...] = ()
    bonus: bool = False
    early: tuple[tuple[Scenario[Any], EarlyJudge], ...] = ()


@dataclass(frozen=True, slots=True)
class Check:
    """All criteria of one exercise, in display order.

    `expected_s`: the longest wall-clock wait in seconds that a scenario needs with our own solution, such as for three
    messages at 0.5 Hz, and `expected_reason` what it waits for; anything a check takes beyond it is overhead, which a
    benchmark measures.
    `mistakes`: the module whose `CATALOGUE` has the mistakes that only this exercise can know, such as
    "checks.i1_2_message_statistics.mistakes"; it is imported when something has failed.
    """

    exercise: str
    criteria: tuple[Criterion, ...]
    expected_s: float = 0.0
    expected_reason: str = ""
    mistakes: str = ""

    def __post_init__(self) -> None:
        seen: set[str] = set()
        for criterion in self.criteria:
            if criterion.id in seen or not seen.issuperset(criterion.after):
                raise ValueError(
                    f"{self.exercise} {criterion.id}: repeated, or after a criterion that is not before it"
                )
            seen.add(criterion.id)
