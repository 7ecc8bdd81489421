"""The verdicts, from the facts of a greeter."""

from __future__ import annotations

from tutor.judge.verdict import Cause, Verdict, failed, passed

from .facts import Greeting

EXPECTED = "a text with “hello” on /greeting"


def judge_greets(greeting: Greeting) -> Verdict:
    """A text with the word hello arrives on /greeting."""
    if greeting.text is None:
        observed = f"nothing on /greeting in {greeting.limit_s:g} s"
        return failed(EXPECTED, observed, Cause("no message", "nothing is published", "publish a String on /greeting"))
    observed = f"“{greeting.text}”"
    if "hello" not in greeting.text.casefold():
        return failed(EXPECTED, observed, Cause("wrong text", "the text greets nobody", "publish “hello”"))
    return passed(EXPECTED, observed)
