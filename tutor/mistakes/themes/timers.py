"""Timers: their period, how many there are, and what becomes of an old one."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Found, found, mistake
from tutor.source import NodeFile, argument, match, values_of


def periods(file: NodeFile) -> Iterator[ast.expr]:
    """The expressions of timers' periods: the arguments, and what is assigned to them."""
    for timer in file.timers:
        if (period := argument(timer, "timer_period_sec")) is not None:
            yield from (period, *values_of(ast.unparse(period), file.tree))


@mistake(
    "whole-number-period",
    explains=[Symptom.WRONG_RATE, Symptom.NO_MESSAGES],
    says="{line} throws away the decimals of the timer's period: {code}",
    do="Compute the period with decimals, by a plain division and without int() or round().",
)
def whole_number_period(case: Case) -> Iterator[Found]:
    """A timer's period is cut to whole seconds.

    A period is a number of seconds, and most rates give a fraction of one. Whole-number division and int() throw the
    fraction away, and a period of 0 makes a timer fire as fast as it can.

    Bad:

        self.create_timer(1 // blinks_per_second, self.blink)

    Good:

        self.create_timer(1 / blinks_per_second, self.blink)

    See it: `ros2 topic hz TOPIC`, once at a rate of 0.7 and once at 5.
    """
    for file in case.files:
        for period in periods(file):
            if any(match(pattern, period) for pattern in ("$_ // $_", "int($_)", "round($_)")):
                yield found(file, period)
