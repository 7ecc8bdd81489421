"""What was seen of every submission of the course is judged as it was when it was seen: same statuses, same mistakes.

If another verdict is wanted, `python -m tests.recordings.replay --accept` accepts it. What a changed scenario sees is
recorded by `python -m tests.soundness EXERCISE --record FOLDER`, and kept by `python -m tests.recordings.keep FOLDER`.
"""

from __future__ import annotations

import pytest

from tests.recordings.recording import KEPT, SUFFIX, read
from tests.recordings.replay import differences, judge_again
from tutor.content import load_course
from tutor.engine.loading import load_check

EXERCISES = sorted(file.name.removesuffix(SUFFIX) for file in KEPT.glob(f"*{SUFFIX}"))


@pytest.mark.parametrize("exercise", EXERCISES)
def test_every_recording_is_judged_as_before(exercise: str) -> None:
    check = load_check(load_course().find(exercise))
    differing = {
        recording.case: lines
        for recording in read(KEPT, [exercise])
        if (lines := differences(recording.outcomes, judge_again(recording, check)))
    }
    assert differing == {}


def test_every_exercise_with_submissions_on_record_has_right_and_wrong_ones() -> None:
    assert EXERCISES
    for exercise in EXERCISES:
        assert {recording.case.split("/")[1] for recording in read(KEPT, [exercise])} == {"right", "wrong"}
