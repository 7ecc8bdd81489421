"""The forms of a service that asks another one, judged on made-up facts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import pytest

from tests.checks.builders import CRASHED, START, assert_failed, assert_passed, ending, judge_of, trace
from tests.exercise.askings import ADD, CHECK, COOK, OTHER, REFUSED, RIGHT, call
from tutor.exercise import AnswersByAsking, Program, check
from tutor.exercise.answers_at_once import CallAtOnce, CalledAtOnce
from tutor.exercise.answers_by_asking import AskedInTurn
from tutor.exercise.answers_without_reply import UnrepliedRun
from tutor.exercise.asking import AskingCall, Exchange
from tutor.exercise.ends_while_asking import InterruptedAsking
from tutor.judge.trace import CallAnswer
from tutor.judge.verdict import Status, Undecided


def test_answers_that_follow_from_a_reply_to_the_same_request_are_right() -> None:
    judge = judge_of(CHECK, "asks")
    assert_passed(judge(AskedInTurn(trace(), calls=(RIGHT, OTHER))))
    twice = call(True, (True, "oven 1"), (True, "oven 2"), message="oven 1")
    assert_passed(judge(AskedInTurn(trace(), calls=(twice,))))


@pytest.mark.parametrize(
    ("made", "mistake", "words"),
    [
        (call(True, message="all is well"), "wrong answer", "without asking /oven"),
        (call(True, success=False, message="no oven"), "wrong answer", "refuses, though /oven is there"),
        (call(True, (False, "oven 7"), message="oven 7"), "wrong answer", "asks /oven for something else"),
        (call(True, (True, "oven 7"), message="oven 6"), "wrong answer", "is not what /oven has replied"),
        (call(True, (True, "oven 7"), success=False, message="late", took_s=3.0), "wrong answer", "gives up, though"),
        (call(True, (True, "oven 7")), "no answer", "has replied, and /cook does not answer"),
        (call(True, (True, None)), "no answer", "waits for it without a limit"),
        (call(True), "no answer", "does not ask"),
    ],
)
def test_other_answers_are_wrong_and_it_is_told_how_far_they_came(made: AskingCall, mistake: str, words: str) -> None:
    assert_failed(judge_of(CHECK, "asks")(AskedInTurn(trace(), calls=(RIGHT, made))), mistake, words, check=CHECK)


def test_a_busy_machine_may_be_to_blame_for_giving_up() -> None:
    late = call(True, (True, "oven 7"), success=False, message="late", took_s=3.0)
    assert isinstance(judge_of(CHECK, "asks")(AskedInTurn(trace(), slowed=True, calls=(late,))), Undecided)
    assert isinstance(judge_of(CHECK, "at-once")(CalledAtOnce(trace(), slowed=True, calls=(RIGHT, late))), Undecided)
    still = UnrepliedRun(trace(), slowed=True, calls=(REFUSED,), later=late)
    assert isinstance(judge_of(CHECK, "missing")(still), Undecided)


async def test_one_of_two_calls_that_is_given_up_each_time_is_so_on_any_machine(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    late = call(True, (True, "oven 7"), success=False, message="late", took_s=3.0)
    rounds = [(late, OTHER), (late, OTHER), (late, OTHER), (RIGHT, OTHER), (late, OTHER), (RIGHT, OTHER)]

    async def call_twice(*_: object) -> tuple[tuple[AskingCall, ...], bool]:
        return rounds.pop(0), True

    monkeypatch.setattr(CallAtOnce, "_call_twice", call_twice)
    busy: Any = SimpleNamespace(is_to_blame=lambda *calls: any(made.answer.took_s >= 1.0 for made in calls))
    twice, unused = CallAtOnce(Program("node.py"), COOK), cast(Any, None)
    assert await twice.call_until_sure(unused, unused, busy) == ((late, OTHER), True, False)
    assert await twice.call_until_sure(unused, unused, busy) == ((RIGHT, OTHER), True, False)
    assert await twice.call_until_sure(unused, unused, busy) == ((RIGHT, OTHER), True, False)
    assert not rounds


def test_giving_up_before_a_slow_reply_is_wrong_on_any_machine() -> None:
    early = call(True, (True, "oven 7"), success=False, message="late", took_s=1.0, held_s=1.5)
    verdict = judge_of(CHECK, "asks")(AskedInTurn(trace(), slowed=True, calls=(RIGHT, early)))
    assert_failed(verdict, "wrong answer", "gives up before /oven has replied", check=CHECK)
    late = call(True, (True, "oven 7"), success=False, message="late", took_s=3.0, held_s=1.5)
    assert isinstance(judge_of(CHECK, "asks")(AskedInTurn(trace(), slowed=True, calls=(RIGHT, late))), Undecided)
    assert_passed(judge_of(CHECK, "asks")(AskedInTurn(trace(), calls=(RIGHT, replace(RIGHT, held_s=1.5)))))


def test_a_missing_service_is_told() -> None:
    assert_failed(judge_of(CHECK, "asks")(AskedInTurn(trace(), offered=False)), "service missing", "/cook", check=CHECK)
    assert judge_of(CHECK, "at-once")(CalledAtOnce(trace(), offered=False)).status is Status.SKIPPED
    assert judge_of(CHECK, "silent")(UnrepliedRun(trace(), offered=False)).status is Status.SKIPPED
    gone = judge_of(CHECK, "missing")(UnrepliedRun(trace(), offered=False))
    assert_failed(gone, "service missing", "while there is no /oven, there is no /cook either", check=CHECK)


def test_what_is_asked_and_answered_may_be_computed() -> None:
    made = check("t1", Program("node.py"), AnswersByAsking("asks", ADD))

    def answered(asked: Mapping[str, int], total: int) -> AskingCall:
        answer = CallAnswer("/taxed", {"a": 1, "b": 2}, {"sum": total}, START, START + 0.1)
        return AskingCall(answer, (Exchange(asked, START, {"sum": 21}),))

    judge = judge_of(made, "asks")
    assert_passed(judge(AskedInTurn(trace(), calls=(answered({"a": 2, "b": 1}, 22),))))
    assert_failed(judge(AskedInTurn(trace(), calls=(answered({"a": 2, "b": 1}, 21),))), "wrong answer", check=made)
    assert_failed(judge(AskedInTurn(trace(), calls=(answered({"a": 1, "b": 2}, 22),))), "wrong answer", check=made)


def test_two_calls_at_once() -> None:
    judge = judge_of(CHECK, "at-once")
    assert_passed(judge(CalledAtOnce(trace(), calls=(RIGHT, OTHER), overlapped=True)))
    both = ((True, "oven 7"), (False, "oven 8"))
    mixed = CalledAtOnce(trace(), calls=(call(True, *both, message="oven 8"), call(False, *both, message="oven 8")))
    assert_failed(judge(mixed), "shared state", "the result of another", check=CHECK)
    empty = CalledAtOnce(trace(), calls=(call(True, *both, success=False, message=""), call(False, *both, message="8")))
    assert_failed(judge(empty), "shared state", "nothing filled in", check=CHECK)
    lost = CalledAtOnce(trace(), calls=(RIGHT, call(False, *both)))
    assert_failed(judge(lost), "no answer", "/oven was asked, and has replied", check=CHECK)
    refused = CalledAtOnce(trace(), calls=(RIGHT, call(False, success=False, message="busy")))
    assert_failed(judge(refused), "wrong answer", "refuses one of two calls", check=CHECK)


@pytest.mark.parametrize("ours", ["missing", "silent"])
def test_no_reply(ours: str) -> None:
    judge = judge_of(CHECK, ours)
    assert_passed(judge(UnrepliedRun(trace(), calls=(REFUSED,), later=RIGHT)))
    yes = UnrepliedRun(trace(), calls=(call(message="yes"),))
    assert_failed(judge(yes), "wrong answer", "answers {'success': True", check=CHECK)
    empty = UnrepliedRun(trace(), calls=(call(success=False, message=" "),))
    assert_failed(judge(empty), "wrong answer", "success=False and a message", check=CHECK)
    asked = [(True, None)] if ours == "silent" else []
    waits = UnrepliedRun(trace(sources={"node.py": "self.oven.call(request)"}), calls=(call(True, *asked),))
    name = "no limit to a wait" if ours == "silent" else "asked without looking"
    assert_failed(judge(waits), name, "line 1", check=CHECK)
    still = UnrepliedRun(trace(), calls=(REFUSED,), later=REFUSED)
    assert_failed(judge(still), "wrong answer", "still answers", check=CHECK)
    hangs = UnrepliedRun(trace(), calls=(REFUSED,), later=call(True))
    assert_failed(judge(hangs), "no answer", "does not answer the next one, and does not ask", check=CHECK)
    ignores = UnrepliedRun(trace(), calls=(REFUSED,), later=call(True, (True, "oven 7")))
    assert_failed(judge(ignores), "no answer", "/oven has replied again, and /cook does not answer", check=CHECK)
    assert judge(UnrepliedRun(trace(), calls=(REFUSED,))).status is Status.SKIPPED
    ended = UnrepliedRun(CRASHED, calls=(call(True),))
    assert_failed(judge(ended), "unhandled exception", check=CHECK)


def test_the_late_reply_to_a_request_that_was_given_up_answers_no_other_call() -> None:
    late = call(True, (True, "oven 8"), message="oven 7")
    seen = UnrepliedRun(trace(), calls=(REFUSED,), later=late, earlier=({"success": True, "message": "oven 7"},))
    assert_failed(judge_of(CHECK, "silent")(seen), "wrong answer", "replied to an earlier request", check=CHECK)
    other = replace(seen, earlier=({"success": True, "message": "oven 6"},))
    assert_failed(judge_of(CHECK, "silent")(other), "wrong answer", "still answers", check=CHECK)


def test_a_call_that_does_not_ask_waits_for_no_reply() -> None:
    seen = UnrepliedRun(trace(), calls=(call(True),))
    assert_failed(judge_of(CHECK, "silent")(seen), "no answer", "/cook does not answer, and does not ask", check=CHECK)


def test_a_service_that_has_gone_again_is_missing_as_before() -> None:
    judge = judge_of(CHECK, "missing")
    assert_passed(judge(UnrepliedRun(trace(), calls=(REFUSED,), later=RIGHT, gone=REFUSED)))
    hangs = UnrepliedRun(trace(), calls=(REFUSED,), later=RIGHT, gone=call(True))
    assert_failed(judge(hangs), "no answer", "waits for /oven, which has gone again", check=CHECK)
    assert isinstance(judge(replace(hangs, slowed=True)), Undecided)
    ended = replace(hangs, trace=CRASHED, slowed=True)
    assert_failed(judge(ended), "unhandled exception", check=CHECK)
    kept = UnrepliedRun(trace(), slowed=True, calls=(REFUSED,), later=RIGHT, gone=RIGHT)
    assert_failed(judge(kept), "wrong answer", "though /oven has gone again", check=CHECK)


def test_what_the_node_writes_is_shown_with_a_wrong_answer() -> None:
    made = call(True, (True, "oven 7"), success=False, message="silent")
    verdict = judge_of(CHECK, "asks")(AskedInTurn(trace(err="[WARN] no event loop"), calls=(made,)))
    assert_failed(verdict, "wrong answer", check=CHECK)
    assert "[WARN] no event loop" in verdict.evidence


def test_the_end_while_it_waits() -> None:
    judge = judge_of(CHECK, "busy")
    assert_passed(judge(InterruptedAsking(trace(), True, ending())))
    assert_failed(
        judge(InterruptedAsking(trace(), True, ending(still_running=True))), "does not end", "/oven", check=CHECK
    )
    assert judge(InterruptedAsking(trace(), False, ending())).status is Status.SKIPPED
    assert judge(InterruptedAsking(CRASHED, True)).status is Status.SKIPPED


def test_requests_that_are_alike_are_the_authors_mistake() -> None:
    with pytest.raises(ValueError, match="give two different `requests`"):
        replace(COOK, requests=((True,), (True,)))
