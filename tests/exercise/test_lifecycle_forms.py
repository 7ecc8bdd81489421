"""The forms of a lifecycle node, judged on made-up facts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import pytest

from tests.checks.builders import (
    NO_NODE,
    START,
    answer,
    assert_failed,
    assert_passed,
    assert_skipped,
    exited,
    graph,
    judge_of,
    refused,
    sample,
    trace,
)
from tutor.exercise import (
    Activates,
    BeginsUnconfigured,
    CleansUp,
    Configures,
    Deactivates,
    FailsToConfigure,
    Lifecycle,
    Parameter,
    Program,
    SetsRate,
    ShownIn,
    ShutsDown,
    Topic,
    check,
)
from tutor.exercise.lifecycle_walk import CHANGE_STATE, LifecycleRun, Move, Step, Walk, rate_in_effect
from tutor.judge.check import Check
from tutor.judge.rates import Rate
from tutor.judge.trace import CallAnswer

IMAGES = Topic("/images", "std_msgs/msg/String")
CAMERA = Lifecycle("/camera", IMAGES, Parameter("rate", 5.0, SetsRate(IMAGES)))
UP = trace(graph=graph(["/camera"], {"/images": IMAGES.type}, {"/camera/change_state": CHANGE_STATE}))
CHECK = check(
    "t1",
    Program("node.py"),
    BeginsUnconfigured("begins", CAMERA),
    Configures("configures", CAMERA),
    Activates("activates", CAMERA),
    Deactivates("deactivates", CAMERA),
    CleansUp("cleans", CAMERA, again_hz=2.0),
    FailsToConfigure("bad", CAMERA, bad=(-1.0, 0.0), good=0.5),
    ShutsDown("ends", CAMERA),
)


def walks_of(check: Check, criterion: str) -> list[Walk]:
    scenarios = next(found.facts for found in check.criteria if found.id == criterion)
    return [scenario for scenario in scenarios if isinstance(scenario, Walk)]


def right_step(move: Move) -> Step:
    """What is seen of a move of a node that does everything right."""
    called = CallAnswer("/camera/change_state", {}, {"success": not move.refused}, START, START)
    return Step(
        move,
        answer({"rate": move.set_to}) if move.set_to is not None else None,
        called if move.transition else None,
        move.to,
        publishes=move.watched == "publisher",
        rate=Rate(move.hz, 6, 5 / move.hz) if move.watched == "rate" else None,
        messages=6 if move.watched == "rate" else 0,
    )


def judge(
    criterion: str, transition: str = "", *, set_to: float | None = None, check: Check = CHECK, **seen: Any
) -> Any:
    """Judge a node that does everything right but for what is seen of one transition of the criterion's part."""
    judge_facts = judge_of(check, criterion)
    runs = []
    for walk in walks_of(check, criterion):
        steps = [right_step(move) for move in walk.moves]
        part = steps[-1].move.part if criterion in ("bad", "ends") else _PARTS[criterion]
        own = [n for n, step in enumerate(steps) if step.move.part == part and step.move.transition == transition]
        chosen = [n for n in own if steps[n].move.set_to == set_to] if seen else []
        if chosen:
            steps = [*steps[: chosen[0]], replace(steps[chosen[0]], **seen)]
        runs.append(LifecycleRun(UP, steps=tuple(steps)))
    return judge_facts(*runs)


_PARTS = {
    "begins": "start",
    "configures": "configure",
    "activates": "activate",
    "deactivates": "deactivate",
    "cleans": "cleanup",
}
UNANSWERED = CallAnswer("/camera/change_state", {}, None, START, START + 5)
FAILED = CallAnswer("/camera/change_state", {}, {"success": False}, START, START)
DONE = replace(FAILED, response={"success": True})


def test_the_parts_are_one_walk_that_ends_with_the_shutdown() -> None:
    (whole,) = walks_of(CHECK, "cleans")
    assert [walks_of(CHECK, name)[-1] for name in ("begins", "configures", "deactivates", "ends")] == [whole] * 4
    asked = [move.transition for move in whole.moves if not move.refused]
    assert asked == [
        "", "configure", "activate", "deactivate", "activate", "deactivate", "cleanup", "configure", "activate",
        "shutdown",
    ]  # fmt: skip
    assert [move.to for move in whole.moves][-1] == "finalized"


def test_the_lives_at_rest_end_with_the_shutdown_too() -> None:
    unconfigured, inactive, _ = walks_of(CHECK, "ends")
    assert walks_of(CHECK, "begins")[0] == unconfigured
    assert walks_of(CHECK, "configures")[0] == inactive
    alone = check("t1", Program("node.py"), Configures("configures", CAMERA))
    resting, _ = walks_of(alone, "configures")
    assert [move.transition for move in resting.moves] == ["", "configure"]
    assert_passed(judge("configures", check=alone))


def test_a_timer_of_a_second_is_listened_for_in_each_state_that_is_silent() -> None:
    walks = [walk for name in ("begins", "configures", "deactivates") for walk in walks_of(CHECK, name)]
    moves = {move for walk in walks for move in walk.moves if move.listen_s}
    assert {(move.to, move.transition) for move in moves} == {
        ("unconfigured", ""),
        ("inactive", "configure"),
        ("inactive", "deactivate"),
    }
    assert all(move.listen_s > 1.1 and move.watched in ("silence", "publisher") for move in moves)


@pytest.mark.parametrize(("criterion", "transition"), [("begins", ""), ("configures", "configure")])
def test_what_is_sent_late_in_a_life_at_rest_fails_its_criterion(criterion: str, transition: str) -> None:
    resting, whole = walks_of(CHECK, criterion)
    steps = [right_step(move) for move in resting.moves]
    late = [replace(s, sent=(sample("/images", "x", START),)) if s.move.transition == transition else s for s in steps]
    runs = [LifecycleRun(UP, steps=tuple(seen)) for seen in (late, map(right_step, whole.moves))]
    assert_failed(judge_of(CHECK, criterion)(*runs), "publishes while inactive", "publishes on /images", check=CHECK)


def test_a_criterion_alone_gets_to_its_part() -> None:
    alone = check("t1", Program("node.py"), CleansUp("cleans", CAMERA, again_hz=2.0))
    (walk,) = walks_of(alone, "cleans")
    assert [move.transition for move in walk.moves][-3:] == ["cleanup", "configure", "activate"]
    assert_passed(judge("cleans", check=alone))


def test_silence_is_waited_for_at_the_rate_that_the_node_had() -> None:
    (whole,) = walks_of(CHECK, "cleans")
    steps = [right_step(move) for move in whole.moves]
    rates = {
        (step.move.part, step.move.transition): rate_in_effect(CAMERA, step.move, steps[:number])
        for number, step in enumerate(steps)
        if step.move.watched in ("silence", "publisher")
    }
    assert rates == {
        ("deactivate", "deactivate"): 5.0,
        ("cleanup", "configure"): 2.0,
        ("shutdown", "shutdown"): 2.0,
    }


@pytest.mark.parametrize("criterion", [*_PARTS, "bad", "ends"])
def test_a_node_that_does_everything_right_passes(criterion: str) -> None:
    assert_passed(judge(criterion))


@pytest.mark.parametrize(
    ("criterion", "transition", "seen", "mistake", "words"),
    [
        ("begins", "", {"state": "inactive"}, "wrong lifecycle state", "inactive before anybody has asked"),
        ("begins", "", {"sent": (sample("/images", "x", START),)}, "publishes while inactive", "it is unconfigured"),
        ("begins", "activate", {"state": "active", "change": DONE}, "wrong lifecycle state", "can be activated"),
        ("begins", "activate", {"state": "active", "change": DONE}, "wrong lifecycle state", "activate: active"),
        (
            "configures",
            "configure",
            {"change": FAILED, "state": "unconfigured"},
            "wrong lifecycle state",
            "on_configure",
        ),
        (
            "configures",
            "configure",
            {"change": FAILED, "state": "unconfigured", "through": ("configuring", "errorprocessing")},
            "exception in a transition",
            "on_configure raised",
        ),
        ("configures", "configure", {"change": UNANSWERED, "state": ""}, "no answer", "our request to configure"),
        ("configures", "configure", {"change": UNANSWERED, "state": ""}, "no answer", "configure: no answer in 5 s"),
        ("configures", "configure", {"publishes": False}, "no messages", "no publisher of std_msgs/msg/String"),
        ("activates", "activate", {"rate": None, "messages": 0}, "no messages", "publishes nothing on /images"),
        ("activates", "activate", {"rate": Rate(1.0, 6, 5.0)}, "wrong rate", "1.00 Hz"),
        ("deactivates", "activate", {"rate": Rate(10.0, 6, 0.5)}, "old timer kept", "5 Hz of an older timer"),
        ("cleans", "cleanup", {"publishes": True}, "left after cleanup", "still there after the cleanup"),
        ("cleans", "activate", {"rate": Rate(5.0, 6, 1.0)}, "parameter not read again", "rate was set while"),
        ("cleans", "activate", {"rate": Rate(7.0, 6, 0.7)}, "old timer kept", "2 Hz and the 5 Hz of an older"),
        ("ends", "shutdown", {"ended_badly": True}, "ended", "once the node is finalized"),
        ("ends", "shutdown", {"state": "active", "change": FAILED}, "wrong lifecycle state", "on_shutdown"),
        ("ends", "shutdown", {"change": FAILED}, "wrong lifecycle state", "finalized, but says that its on_shutdown"),
    ],
)
def test_what_is_wrong_is_told(criterion: str, transition: str, seen: dict[str, Any], mistake: str, words: str) -> None:
    assert_failed(judge(criterion, transition, **seen), mistake, words, check=CHECK)


def test_a_bad_value_must_fail_the_transition_and_leave_the_node_unconfigured() -> None:
    taken = judge("bad", "configure", set_to=0.0, change=DONE, state="inactive")
    assert_failed(taken, "wrong lifecycle state", "configured although rate is 0.0", check=CHECK)
    lost = judge("bad", "configure", set_to=0.0, state="finalized")
    assert_failed(lost, "wrong lifecycle state", "is finalized then, not unconfigured", check=CHECK)
    spoilt = judge("bad", "configure", set_to=0.5, change=FAILED, state="unconfigured")
    assert_failed(spoilt, "wrong lifecycle state", "after rate was set to 0.5, which is a good value", check=CHECK)


def test_a_node_that_has_failed_to_configure_has_no_publisher() -> None:
    left = judge("bad", "configure", set_to=0.0, publishes=True)
    assert_failed(left, "left after cleanup", "fails to configure with rate 0.0, and keeps a publisher", check=CHECK)


def test_the_second_configure_is_silent_as_well() -> None:
    started = judge("cleans", "configure", set_to=2.0, sent=(sample("/images", "x", START),))
    assert_failed(started, "publishes while inactive", "although it is inactive", check=CHECK)


def test_a_bad_value_that_is_refused_at_once_is_as_good() -> None:
    (walk,) = walks_of(CHECK, "bad")
    steps = [right_step(move) for move in walk.moves]
    refusing = [replace(s, set_to=refused({"rate": 0.0}), change=None) if s.move.set_to == 0.0 else s for s in steps]
    assert_passed(judge_of(CHECK, "bad")(LifecycleRun(UP, steps=tuple(refusing))))


def test_a_program_may_end_when_it_is_shut_down() -> None:
    assert_passed(judge("ends", "shutdown", state="", change=UNANSWERED, ended=True))


def test_what_is_not_reached_is_skipped() -> None:
    (walk,) = walks_of(CHECK, "cleans")
    reached: Sequence[Step] = [right_step(move) for move in walk.moves[:3]]
    assert_skipped(judge_of(CHECK, "cleans")(LifecycleRun(UP, steps=tuple(reached))), "does not get that far")


def test_without_its_services_a_node_has_no_lifecycle() -> None:
    judge_deactivates = judge_of(CHECK, "deactivates")
    plain = LifecycleRun(trace(), offered=False)
    assert_failed(judge_deactivates(plain), "service missing", "/node is no lifecycle node", check=CHECK)
    other = trace(graph=graph(services={"/node/change_state": CHANGE_STATE}))
    assert_failed(
        judge_deactivates(LifecycleRun(other, offered=False)), "service missing", "its name is /node", check=CHECK
    )
    assert_failed(judge_deactivates(LifecycleRun(NO_NODE, offered=False)), "no node", check=CHECK)


def test_a_callback_without_a_result_is_known_by_its_traceback() -> None:
    err = """\
Traceback (most recent call last):
  File "/opt/rclpy/lifecycle/node.py", line 300, in __change_state
    self._state_machine.trigger_transition_by_label(cb_return_code.to_label(), True)
AttributeError: 'bool' object has no attribute 'to_label'"""
    ended = trace(graph=graph(["/camera"]), err=err, exit=exited(1))
    (walk,) = walks_of(CHECK, "activates")
    *before, activate = (right_step(move) for move in walk.moves[:4])
    steps = (*before, replace(activate, change=UNANSWERED, state=""))
    verdict = judge_of(CHECK, "activates")(LifecycleRun(ended, steps=steps))
    assert_failed(verdict, "transition returns no result", "on_activate returns something else", check=CHECK)


def test_a_wrong_name_or_effect_is_the_authors_mistake() -> None:
    with pytest.raises(ValueError, match="give its full name, /camera"):
        Lifecycle("camera", IMAGES, CAMERA.rate)
    with pytest.raises(ValueError, match="its effect must be SetsRate of /images"):
        Lifecycle("/camera", IMAGES, Parameter("rate", 5.0, ShownIn(IMAGES)))
