"""What a report may say: how many words, how much code, and none of an exercise's solution."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path

MEDIAN_WORDS = 45
"""Of cause and step together, over all entries, or over all failing reports."""

MAX_WORDS = 60

MIN_SOLUTION_LINE = 12
"""Shorter lines of a solution, such as `return`, give nothing away."""

_CODE = re.compile(
    r"\b[\w.]+\([^()]*[\w'\"][^()]*\)"  # a call with arguments
    r"|\b(?!of )[\w.]+ = \S+"  # an assignment
    r"|^(from|import|def|class|return|raise|with|if|for|while|async|await|@\w+) .*[:(=]$",  # a statement
    re.MULTILINE,
)

_ASIDE = re.compile(r"\((after|before|of|or|in|and|such|ros2|line|its|the|for|as) [^()]*\)")
"""Words in brackets, which are no call."""


def words_of(cause: str, step: str) -> int:
    """The number of words of a cause and a step together; a line of code counts as its parts between spaces."""
    return len(f"{cause} {step}".split())


def code_in(step: str) -> list[str]:
    """The pieces of Python code in a step: calls with arguments, assignments, statements. Names alone are words."""
    return [match.group() for match in _CODE.finditer(_ASIDE.sub("", step))]


def sentences_in(step: str) -> int:
    """How many sentences a step has."""
    return 1 + len(re.findall(r"[.?!] (?=[A-Z])", step.strip()))


def faults_of(step: str, *, slip: bool, solution: Sequence[str] = ()) -> Iterator[str]:
    """What is wrong with a step, in words. `solution`: the lines of the exercise's solution."""
    code = code_in(step)
    if "\n" in step:
        yield f"it has {len(step.splitlines())} lines"
    if len(code) > 1:
        yield f"it has code in {len(code)} places: {'; '.join(code)}"
    if slip:
        return
    if code:
        yield f"it has code, and is no slip: {code[0]}"
    yield from (f"it has a line of the solution: {line}" for line in solution if line in step)


def solution_lines(folder: Path) -> tuple[str, ...]:
    """The lines of a solution that no step may have; short ones, imports, and calls without arguments do not count."""
    lines = {line.strip() for path in sorted(folder.glob("*.py")) for line in path.read_text("utf-8").splitlines()}
    boring = re.compile(r"(import|from) |def main\b|if __name__ ==|#|\"\"\"|[\w.]+\(\)$")
    return tuple(sorted(line for line in lines if len(line) >= MIN_SOLUTION_LINE and not boring.match(line)))
