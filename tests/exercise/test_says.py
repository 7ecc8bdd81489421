"""What a log message is taken to say."""

from __future__ import annotations

from typing import Any

import pytest

from tutor.exercise.receives import says


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("range-50270", 50270),
        ("range_mm-50270mm", 50270),
        ("range: 50270 mm", 50270),
        ("from 1-50270", 50270),
        ("level -5", -5),
        ("level=-5", -5),
        ("level-5", -5),  # a sign, where the number follows its name at once
        ("-5", -5),
        ("level-2.504", 2.5),
        ("5.027e4", 50270),
        ("Hall-7 is open", "hall-7"),
    ],
)
def test_shown(text: str, wanted: Any) -> None:
    assert says(text, wanted)


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("level -5", 5),
        ("level: -5", 5),
        ("level=-5", 5),
        ("-5", 5),
        ("level 5", -5),
        ("range-50.270", 50270),
        ("range-502701", 50270),
        ("hall-7", "hall-8"),
    ],
)
def test_not_shown(text: str, wanted: Any) -> None:
    assert not says(text, wanted)
