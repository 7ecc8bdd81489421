"""I1.2: nodes that lose messages by design, whatever the machine.

Whether such a node loses one particular message is luck, so only `count` is judged of it: the others are skipped.
"""

from __future__ import annotations

from checks.i1_2 import backlog
from checks.i1_2.facts import TOPIC, Trial
from checks.i1_2.faults import wrong_log
from checks.i1_2.totals import counts_truly
from tutor.judge.symptom import Observation

SEE_COUNT = "not judged, because the node loses messages: see `count`"

MAX_RENEWALS = 2
"""New subscriptions, while messages come, that a node may have reasons for."""


def is_certain(steady: Trial, fast: Trial) -> bool:
    """Whether the node is certain to lose messages that are sent fast, or at any rate."""
    if renews_subscription(steady) or renews_subscription(fast):
        return True
    lost = backlog.find_lost(fast, steady) if counts_truly(steady) else None
    return lost is not None and not lost.excused


def renews_subscription(trial: Trial) -> bool:
    """Whether the node gives up its subscription and makes a new one again and again, as for each message."""
    return trial.new_subscriptions > MAX_RENEWALS


def describe_renewals(trial: Trial) -> str:
    """Say how often the node made a new subscription."""
    return f"{trial.new_subscriptions} new subscriptions on {TOPIC} while {len(trial.sent)} messages came"


def see_renewals(trial: Trial) -> Observation:
    """The node makes a new subscription again and again."""
    return wrong_log(trial.trace, {"renewals": trial.new_subscriptions})
