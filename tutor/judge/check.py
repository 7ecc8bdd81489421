"""A check: scenarios that gather facts, and criteria that judge them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from tutor.judge.bench import Scenario
from tutor.judge.known_exception import KnownException
from tutor.judge.verdict import Verdict

Judge = Callable[..., Verdict]
"""A pure function from the facts of the criterion's scenarios, in their order, to a verdict."""

EarlyJudge = Callable[[Any], Verdict | None]
"""A pure function from the facts of one scenario to a failure, if that is sure whatever the others say.

They may be those that the scenario has reported so far (`Bench.report_facts`). Whatever it gives besides a failure says
nothing. It must never fail what the judge would pass.
"""


@dataclass(frozen=True, slots=True)
class Criterion:
    """One acceptance criterion.

    `facts` are the scenarios whose facts `judge` takes; they run at once with all others. `after` names criteria that
    must have passed, else this one is skipped: what it says would be about their failure. `early`: scenarios
    that may be enough for a failure, each with the judge of its facts.
    """

    id: str
    judge: Judge
    facts: tuple[Scenario[Any], ...]
    after: tuple[str, ...] = ()
    bonus: bool = False
    early: tuple[tuple[Scenario[Any], EarlyJudge], ...] = ()


@dataclass(frozen=True, slots=True)
class Check:
    """All criteria of one exercise, in the order to show them.

    `expected_s`: the longest wait in seconds that a scenario asks of the clock when it meets our own solution, such as
    three messages at 0.5 Hz; what a check takes beyond it is overhead, which a benchmark measures. `exceptions`: known
    ones that are looked for before those that come with the program.
    """

    exercise: str
    criteria: tuple[Criterion, ...]
    expected_s: float = 0.0
    exceptions: tuple[KnownException, ...] = ()

    def __post_init__(self) -> None:
        seen: set[str] = set()
        for criterion in self.criteria:
            if criterion.id in seen or not seen.issuperset(criterion.after):
                raise ValueError(
                    f"{self.exercise} {criterion.id}: repeated, or after a criterion that is not before it"
                )
            seen.add(criterion.id)
