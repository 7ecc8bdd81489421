"""Wrong answers to requests that have not just two numbers are told without an error."""

from __future__ import annotations

import pytest

from tutor.judge.symptom import Symptom
from tutor.judge.trace import CallAnswer, Trace
from tutor.mistakes import CATALOGUE
from tutor.mistakes.entry import Case

REQUESTS = [
    ({"value": 3, "low": -1, "high": 3}, False),
    ({"number": 3}, 4),
    ({"left": "a", "right": "b"}, "ba"),
    ({}, True),
]


@pytest.mark.parametrize(("request_", "got"), REQUESTS)
def test_every_entry_can_be_asked(request_: dict[str, object], got: object) -> None:
    answer = CallAnswer("/bell", request_, {"rung": got}, 0.0, 0.1)
    seen = Symptom.WRONG_ANSWER.seen(
        Trace("node.py"),
        service="/bell",
        answer=answer,
        calls=(answer,),
        field="rung",
        wanted=None,
        operations={"/bell": lambda *values: None},
    )
    for entry in CATALOGUE.entries.values():
        if Symptom.WRONG_ANSWER in entry.explains:
            list(entry.find(Case(seen)))
