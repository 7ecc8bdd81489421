"""The verdicts, from the facts of a greeter: what was expected, what was seen, and of which kind it is."""

from __future__ import annotations

from tutor.judge.symptom import Symptom
from tutor.judge.verdict import Verdict, failed, passed

from .facts import Greeting

EXPECTED = "a text with “hello” on /greeting"
TOPIC, TYPE = "/greeting", "std_msgs/msg/String"


def judge_greets(greeting: Greeting) -> Verdict:
    """A text with the word hello arrives on /greeting."""
    if greeting.text is None:
        observed = f"nothing on {TOPIC} in {greeting.limit_s:g} s"
        return failed(EXPECTED, observed, Symptom.NO_MESSAGES.seen(greeting.trace, topic=TOPIC, type=TYPE))
    observed = f"“{greeting.text}”"
    if "hello" not in greeting.text.casefold():
        return failed(EXPECTED, observed, Symptom.WRONG_VALUES.seen(greeting.trace, text=greeting.text))
    return passed(EXPECTED, observed)
