"""Wording of numbers in messages, and comparison of log messages by their wording."""

from __future__ import annotations

import re

from tutor.judge.trace import Trace


def counted(number: int, noun: str) -> str:
    """A number of things in words: "1 line", "3 lines"."""
    return f"{number} {noun}{'' if number == 1 else 's'}"


def shape(text: str) -> str:
    """A message with its numbers blanked out: messages of the same shape likely come from the same line of code."""
    return re.sub(r"-?\d+(\.\d+)?", "#", text)


def output_tail(trace: Trace, max_lines: int = 6) -> tuple[str, ...]:
    """The last non-empty lines that the process wrote, as evidence."""
    return tuple(line.text for line in trace.output if line.text.strip())[-max_lines:]


def describe_no_answer(trace: Trace, waited_s: float, limit_s: float = 0.0) -> str:
    """Say that a request got no answer within this time, or because the process had already ended.

    `limit_s`: how long the wait would have been at least, had the process not been idle: with all threads blocked, none
    of them for a time, it never answers.
    """
    if trace.exit is None:
        ever = ", and none to come: all of its threads are blocked" if waited_s < 0.9 * limit_s else ""
        return f"no answer in {waited_s:.2g} s{ever}"
    return f"no answer: the process ended by itself, {trace.exit.after_s:.1f} s after its start, with {trace.exit}"
