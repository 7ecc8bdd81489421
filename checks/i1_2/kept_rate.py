"""I1.2: a rate that is worked out once and kept when the messages come at another one."""

from __future__ import annotations

from checks.i1_2.facts import Trial
from checks.i1_2.rates import MIN_WINDOW, numbers_except_count, true_rates
from checks.i1_2.reading import Number
from checks.i1_2.summaries import find_summaries


def find_kept_rate(restart: Trial) -> Number | None:
    """The rate that a node states before and after the publisher is replaced by one of another rate.

    A rate of any of the messages has changed by then. None if it also states another true rate, or if the rate has no
    decimals, and so may be the same by chance.
    """
    summaries = find_summaries(restart)
    before = [each for each in summaries if each.messages <= restart.before_break]
    after = [each for each in summaries if each.messages >= restart.before_break + MIN_WINDOW]
    for number in before[0].numbers if before and after else ():
        kept = all(number.text in {other.text for other in each.numbers} for each in (*before, *after))
        if "." in number.text and kept and true_rates(before[0], restart).holds(number):
            others = [
                other
                for each in after
                for other in numbers_except_count(each, restart)
                if other.text != number.text and true_rates(each, restart).holds(other)
            ]
            return None if others else number
    return None
