"""The forms of a service that asks another one, judged on made-up facts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import pytest

from tests.checks.builders import CRASHED, START, assert_failed, assert_passed, ending, judge_of, samples, trace
from tutor.exercise import (
    AnswersAtOnce,
    AnswersByAsking,
    AnswersWithoutReply,
    Asking,
    EndsWhileAsking,
    KeepsPaceWhileAsking,
    Program,
    Service,
    Topic,
    check,
)
from tutor.exercise.answers_at_once import CallAtOnce, CalledAtOnce
from tutor.exercise.answers_by_asking import AskedInTurn
from tutor.exercise.answers_without_reply import UnrepliedRun
from tutor.exercise.asking import AskingCall, Exchange
from tutor.exercise.ends_while_asking import InterruptedAsking
from tutor.exercise.keeps_pace_while_asking import Pace, PaceRun
from tutor.judge.rates import measure
from tutor.judge.trace import CallAnswer
from tutor.judge.verdict import Status, Undecided

LAMP = Topic("/lamp", "std_msgs/msg/Bool")
COOK = Asking(
    Service("/cook", "std_srvs/srv/SetBool", ("data",)),
    Service("/oven", "std_srvs/srv/SetBool", ("data",)),
    requests=((True,), (False,)),
    replies=lambda data: {"success": data, "message": f"oven {data}"},
    refusal={"success": False, "message": str.strip},
    refused="success=False and a message",
)
ADD = Asking(
    Service("/taxed", "example_interfaces/srv/AddTwoInts", ("a", "b")),
    Service("/tax", "example_interfaces/srv/AddTwoInts", ("a", "b")),
    requests=((1, 2), (3, 4)),
    replies=lambda a, b: {"sum": 10 * a + b},
    asks_with=lambda a, b: (b, a),
    becomes=lambda reply: {"sum": reply["sum"] + 1},
)
asks = AnswersByAsking("asks", COOK)
CHECK = check(
    "t1",
    Program("node.py"),
    asks,
    KeepsPaceWhileAsking("pace", COOK, LAMP, 10.0),
    AnswersAtOnce("at-once", COOK),
    AnswersWithoutReply("missing", COOK, "missing"),
    AnswersWithoutReply("silent", COOK, "silent"),
    EndsWhileAsking("busy", COOK, shown_by=asks),
)


def call(
    data: bool = True,
    *exchanges: tuple[bool, str | None],
    success: bool = True,
    message: str | None = None,
    took_s: float = 0.1,
    held_s: float = 0.0,
) -> AskingCall:
    """A call. `exchanges`: with what we were asked, and our message (None: no reply); `message`: None if unanswered."""
    response = None if message is None else {"success": success, "message": message}
    answer = CallAnswer("/cook", {"data": data}, response, START, START + took_s)
    made = (
        Exchange({"data": asked}, START, None if text is None else {"success": True, "message": text})
        for asked, text in exchanges
    )
    return AskingCall(answer, tuple(made), held_s)


RIGHT = call(True, (True, "oven 7"), message="the oven 7 is hot")
OTHER = call(False, (False, "oven 8"), message="oven 8")
REFUSED = call(success=False, message="no oven")


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


def pace_run(pace: Pace | None, hz: float = 10.0, **more: Any) -> PaceRun:
    found = samples("/lamp", hz)
    return PaceRun(trace(*found), rate=measure(found), messages=len(found), calls=(RIGHT,), pace=pace, **more)


@pytest.mark.parametrize(
    ("pace", "right"),
    [
        (Pace(15, 1.5, 0.11), True),
        (Pace(12, 1.5, 0.4), True),
        (Pace(0, 1.5, 1.6), False),
        (Pace(15, 1.5, 0.9), False),
        (Pace(8, 1.5, 0.2), False),
        (Pace(30, 1.5, 0.05), False),
    ],
)
def test_the_pace_while_it_waits(pace: Pace, right: bool) -> None:
    judge = judge_of(CHECK, "pace")
    verdict = judge(pace_run(pace))
    if right:
        assert_passed(verdict)
    else:
        assert_failed(verdict, "callbacks wait for each other", "while it waits", check=CHECK)
        assert isinstance(judge(pace_run(replace(pace, cpu_wait_s=1.2))), Undecided)


def test_a_short_wait_for_a_cpu_explains_no_long_pause() -> None:
    assert_failed(
        judge_of(CHECK, "pace")(pace_run(Pace(0, 1.5, 1.6, cpu_wait_s=0.3))),
        "callbacks wait for each other",
        check=CHECK,
    )


def test_a_pace_that_cannot_be_judged() -> None:
    judge = judge_of(CHECK, "pace")
    assert_failed(judge(PaceRun(trace())), "no publisher", "no message", check=CHECK)
    assert_failed(judge(pace_run(None, hz=5.0)), "wrong rate", "while nobody calls: 5.00 Hz", check=CHECK)
    assert judge(replace(pace_run(None), calls=())).status is Status.SKIPPED
    assert judge(pace_run(None)).status is Status.SKIPPED
    waits = replace(pace_run(None), calls=(call(True),))
    assert_failed(judge(waits), "no answer", "was not asked", check=CHECK)
    ended = replace(pace_run(Pace(15, 1.5, 0.1)), trace=CRASHED)
    assert_failed(judge(ended), "unhandled exception", "then the process ended", check=CHECK)


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
    assert_failed(judge(hangs), "no answer", "once it replies", check=CHECK)
    assert judge(UnrepliedRun(trace(), calls=(REFUSED,))).status is Status.SKIPPED
    ended = UnrepliedRun(CRASHED, calls=(call(True),))
    assert_failed(judge(ended), "unhandled exception", check=CHECK)


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
