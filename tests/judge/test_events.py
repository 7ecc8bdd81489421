"""Events cross a process boundary as one line each, and are decoded unchanged."""

from __future__ import annotations

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tutor.judge.events import (
    CheckFinished,
    CheckStarted,
    CriterionJudged,
    Event,
    ExerciseJudged,
    Progress,
    decode,
    encode,
)
from tutor.judge.result import CriterionResult, Environment, ExerciseResult, Report
from tutor.judge.verdict import Status, Verdict

# What a learner's process may write: line ends of every kind, control characters, and paths that are not UTF-8.
text = st.text(
    st.characters(exclude_categories=["Cs"]) | st.sampled_from('\n\r\x1b\x85\u2028\u2029\udc80"\\°'), max_size=12
)
seconds = st.floats(0, 1e6)
texts = st.lists(text, max_size=3).map(tuple)
verdicts = st.builds(Verdict, st.sampled_from(Status), text, text, text, text, texts)
criteria = st.builds(CriterionResult, text, text, st.booleans(), verdicts, seconds)
exercises = st.builds(ExerciseResult, text, text, texts, st.lists(criteria, max_size=2).map(tuple), seconds)
reports = st.builds(
    Report, st.builds(Environment, text, text, text, text), st.lists(exercises, max_size=2).map(tuple), seconds
)
events = st.one_of(
    st.builds(CheckStarted, text, texts),
    st.builds(Progress, text, text, st.floats(0, 1), text, text),
    st.builds(CriterionJudged, text, criteria),
    st.builds(ExerciseJudged, exercises),
    st.builds(CheckFinished, reports),
)


@given(events)
def test_a_round_trip_changes_nothing(event: Event) -> None:
    line = encode(event)
    assert decode(line) == event
    assert len(line.splitlines()) == 1, "one line, whatever a reader takes for a line's end"
    assert line.encode("ascii").decode("utf-8") == line, "the same bytes in every locale"


@pytest.mark.parametrize(
    "line",
    [
        "",
        "hello",
        "[]",
        "3",
        "null",
        '"Progress"',
        "{}",
        '{"event": "Nothing"}',
        '{"event": []}',
        '{"event": "Progress"}',
        '{"event": "Progress", "exercise": "a", "criterion": "b", "fraction": "0.5", "doing": "c"}',
        '{"event": "CheckStarted", "exercise": "i1.1", "criteria": null}',
        '{"event": "CriterionJudged", "exercise": "i1.1", "result": {"id": "a"}}',
        '{"event": "ExerciseJudged", "result": []}',
    ],
)
def test_a_line_that_is_not_an_event_is_rejected(line: str) -> None:
    with pytest.raises(ValueError, match="not understood"):
        decode(line)


def test_progress_without_so_far_is_decoded() -> None:
    line = '{"event": "Progress", "exercise": "a", "criterion": "b", "fraction": 0.5, "doing": "c"}'
    assert decode(line) == Progress("a", "b", 0.5, "c", so_far="")


def test_an_unknown_status_is_rejected() -> None:
    good = encode(CriterionJudged("i1.1", CriterionResult("a", "A", False, Verdict(Status.PASSED), 1.0)))
    fields = json.loads(good)
    fields["result"]["verdict"]["status"] = "maybe"
    with pytest.raises(ValueError, match="maybe"):
        decode(json.dumps(fields))
