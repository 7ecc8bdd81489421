"""Lessons and verdicts, rendered for speech."""

from __future__ import annotations

import re

from tests.cli.fake_engine import FAILURE
from tutor.content import load_course
from tutor.judge.result import CriterionResult
from tutor.judge.verdict import fault, skipped
from tutor.plain import speech
from tutor.plain.speech import Section


def test_a_paragraph_becomes_one_line_without_markup() -> None:
    text = (
        "Before all.\n\n## Tasks\n\nA **bold** word, and\n`code_here` with *stress*.\n1. One\n   more.\n2. Two\n"
        "```python\n# no heading\na = 2 * b * c\n\nx\n```\nSee [the site](https://ros.org).\n"
    )
    assert speech.sections(text) == [
        Section("Introduction", ("Before all.",)),
        Section(
            "Tasks",
            (
                "A bold word, and code_here with stress.",
                *("1. One more.", "2. Two"),
                *("Code:", "# no heading", "a = 2 * b * c", "x", "End of code."),
                "See the site.",
            ),
        ),
    ]


def test_each_row_of_a_table_is_spoken_with_the_names_of_its_columns() -> None:
    text = (
        "## A\n\nBefore:\n\n| policy | offered | fits? |\n|---|:--|---|\n| `depth` | a\\|b | **no** |\n| two |\nEnd.\n"
    )
    assert speech.sections(text) == [
        Section(
            "A",
            (
                *("Before:", "Table, 2 rows:"),
                *("policy: depth; offered: a|b; fits? no", "policy: two"),
                *("End of table.", "End."),
            ),
        )
    ]


def test_every_lesson_is_spoken_completely_and_without_markup() -> None:
    for lesson in load_course().lessons:
        found = speech.sections(lesson.body)
        assert len(found) >= 4
        spoken = " ".join(line for section in found for line in (section.title, *section.lines))
        assert not re.search(r"(?<!\w)\*\*|\*\*(?!\w)", spoken)  # 2**63 is not markup
        assert "```" not in spoken
        assert "|---" not in spoken
        for word in set(re.findall(r"\w+", lesson.body)) - {"python", "bash", "console", "text", "xml", "yaml"}:
            assert word in spoken, (lesson.id, word)


def test_a_verdict_is_spoken_in_words() -> None:
    failed = CriterionResult("rate", "The rate is right", False, FAILURE, 1.0)
    assert speech.diagnosis(failed) == [
        "rate: failed.",
        "The criterion: The rate is right.",
        "Expected: 5 messages",
        "Observed: 0 messages",
        "Why: no spin: no callback ran",
        "Next step: call rclpy.spin(node)",
    ]
    assert speech.evidence(failed) == ["Evidence, 1 line:", "a line"]
    left_out = CriterionResult("echo", "It echoes", True, skipped("not judged, because `rate` did not pass"), 1.0)
    assert speech.diagnosis(left_out) == ["echo (bonus): skipped. Not judged, because rate did not pass."]
    ours = CriterionResult("rate", "The rate is right", False, fault("no memory", "close something"), 1.0)
    assert speech.headline(ours) == "rate: could not be judged; this is no fault of your code."
