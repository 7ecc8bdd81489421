"""What is wrong with a part of a lifecycle node's life; pure."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tutor.exercise.lifecycle_walk import CHANGE_STATE, LifecycleRun, Move, Step
from tutor.exercise.node_parameters import fail_not_set
from tutor.exercise.nouns import Lifecycle, show
from tutor.judge.rates import describe
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.verdict import Verdict, failed, passed, skipped
from tutor.judge.wording import counted, describe_no_answer, output_tail


def judge_part(seen: LifecycleRun, lifecycle: Lifecycle, moves: Sequence[Move], expected: str) -> Verdict:
    """Judge the steps of a walk that these moves have led to."""
    service = f"{lifecycle.node}/change_state"
    if not seen.offered:
        missing = Symptom.SERVICE_MISSING if seen.trace.exit is None else Symptom.ENDED
        why = seen.symptom(missing, lifecycle=lifecycle.node, **_not_offered(seen, lifecycle))
        return failed(expected, f"there is no {service} of type {CHANGE_STATE}", why, _output(seen))
    steps = [step for step in seen.steps if step.move in moves]
    for step in steps:
        if not step.is_right:
            return _judge_wrong(seen, lifecycle, step, expected)
    if len(steps) < len(moves):
        return skipped("not judged, because the node does not get that far")
    return passed(expected, "; ".join(filter(None, map(_describe, steps))))


def _output(seen: LifecycleRun) -> list[str]:
    """What the program wrote last, without what ROS says about the transition that we ask for in vain."""
    return [line for line in output_tail(seen.trace) if "[rcl_lifecycle]" not in line]


def _not_offered(seen: LifecycleRun, lifecycle: Lifecycle) -> dict[str, Any]:
    nodes = dict.fromkeys(server.node for server in seen.trace.graph.servers if server.type == CHANGE_STATE)
    if nodes:
        return {
            "says": f"there is a lifecycle node, but its name is {', '.join(nodes)}, not {lifecycle.node}",
            "do": f"Let its name be {lifecycle.node}.",
        }
    if seen.trace.graph.nodes:
        nodes = dict.fromkeys(seen.trace.graph.nodes)
        return {
            "says": f"{', '.join(nodes)} is no lifecycle node: nobody can ask it for a transition",
            "do": "Derive its class from LifecycleNode, of rclpy.lifecycle, instead of Node.",
        }
    return {"service": f"{lifecycle.node}/change_state", "type": CHANGE_STATE}


def _judge_wrong(seen: LifecycleRun, lifecycle: Lifecycle, step: Step, expected: str) -> Verdict:
    tail, topic = _output(seen), lifecycle.topic
    if step.set_to is not None and not step.set_to.successful:
        return fail_not_set(expected, step.set_to, seen.trace, seen.stuck)
    if not step.state_is_right:
        observed, why = _wrong_state(seen, lifecycle, step)
        return failed(expected, observed, why, tail)
    about = {"lifecycle": lifecycle.node, "state": step.state, "topic": topic.name, "type": topic.type}
    after = f"{_name(step)}: {_state(step)}"
    if step.sent:
        observed = f"{after}, and {counted(len(step.sent), 'message')} on {topic.name}: {topic.show(step.sent[0])}"
        says = f"the node publishes on {topic.name} although it is {step.state}"
        do = "Publish only in the state active: with a lifecycle publisher, or with a timer that runs only then."
        return failed(expected, observed, seen.symptom(Symptom.NOT_SILENT, says=says, do=do, **about))
    if step.ended_badly:
        says = f"the program ends with {seen.trace.exit} once the node is finalized"
        do = "Let it run on until Ctrl+C, or end as a program does that has done its work: with exit code 0."
        why = seen.symptom(Symptom.ENDED, says=says, do=do, **about)
        return failed(expected, f"{after}, and then the program ended with {seen.trace.exit}", why, tail)
    if step.move.watched == "publisher":
        says = f"the node is configured, and has no publisher of {topic.type} on {topic.name}"
        do = "Create the publisher in on_configure, under exactly this name and with this type."
        why = seen.symptom(Symptom.NO_MESSAGES, says=says, do=do, **about)
        return failed(expected, f"{after}, without a publisher on {topic.name}", why, tail)
    if step.move.watched == "nothing left":
        says = f"the publisher on {topic.name}, which configuring has made, is still there after the cleanup"
        do = "Undo in on_cleanup what on_configure has made: the node keeps a publisher until it is destroyed."
        if step.move.refused:
            value = _bad_value(seen, lifecycle, step.move)
            says = (
                f"the node fails to configure with {lifecycle.rate.name} {value}, and keeps a publisher on {topic.name}"
            )
            do = "Look at the value before anything is made: a node that stays unconfigured holds nothing."
        why = seen.symptom(Symptom.NOT_CLEANED_UP, says=says, do=do, transition=step.move.transition, **about)
        return failed(expected, f"{after}, and a publisher on {topic.name} is left", why)
    return _judge_rate(seen, lifecycle, step, expected)


def _judge_rate(seen: LifecycleRun, lifecycle: Lifecycle, step: Step, expected: str) -> Verdict:
    topic, wanted, tail = lifecycle.topic, step.move.hz, _output(seen)
    observed = f"{_name(step)}: {_state(step)}, {describe(step.rate, step.messages)} on {topic.name}"
    about = {"lifecycle": lifecycle.node, "state": step.state, "topic": topic.name, "type": topic.type}
    if seen.trace.exit is not None:
        return failed(expected, observed, seen.symptom(Symptom.ENDED, **about), tail)
    if not step.messages:
        says = f"the node is active, and publishes nothing on {topic.name}"
        do = "Follow the timer's callback: does it run once the node is active, and does it reach publish()?"
        return failed(expected, observed, seen.symptom(Symptom.NO_MESSAGES, says=says, do=do, **about), tail)
    before = lifecycle.default_hz
    unchanged = wanted != before and step.rate is not None and step.rate.agrees_with(before)
    why = seen.symptom(
        Symptom.WRONG_RATE,
        **about,
        parameter=lifecycle.rate.name,
        wanted_hz=wanted,
        rate=step.rate,
        unchanged=unchanged,
        inverted=step.rate is None or step.rate.agrees_with(1 / wanted),
        at_start=step.move.part == "activate",
        followed_hz=None,
        earlier_hz=() if step.move.part == "activate" else (before,),
        configured_again=step.move.part == "cleanup",
    )
    return failed(expected, observed, why)


def _wrong_state(seen: LifecycleRun, lifecycle: Lifecycle, step: Step) -> tuple[str, Observation]:
    """What was observed of a transition that was not made as it should be, and the failure."""
    move, service = step.move, f"{lifecycle.node}/change_state"
    about = {
        "lifecycle": lifecycle.node,
        "transition": move.transition,
        "state": step.state,
        "through": step.through,
        "wanted": move.to,
    }
    if not step.answered:
        asked = service if step.change is not None and step.change.response is None else f"{lifecycle.node}/get_state"
        took_s = step.change.took_s if step.change is not None else 0.0
        observed = f"{_name(step)}: {describe_no_answer(seen.trace, took_s)}"
        missing = Symptom.NO_ANSWER if seen.trace.exit is None else Symptom.ENDED
        says = f"{asked} does not answer" + (f" our request to {move.transition}" if move.transition else "")
        do = f"Let {callback_of(move.transition)} return soon: what takes long belongs into a timer."
        return observed, seen.symptom(missing, service=service, type=CHANGE_STATE, says=says, do=do, **about)
    observed = f"{_name(step)}: {_state(step)}"
    if not move.transition:
        says = f"the node is {step.state} before anybody has asked for anything"
        do = "Leave the transitions to those who use the node: let the program only create it and spin."
    elif move.refused and move.set_to is None and move.transition == "activate":
        says, do = f"the node can be activated while it is {move.to}", "Let it be configured first."
    elif move.refused and step.succeeded:
        says = f"the node is configured although {lifecycle.rate.name} is {_bad_value(seen, lifecycle, move)}"
        do = "Look at the value in on_configure, and return FAILURE if it cannot be used."
    elif move.refused:
        says = f"the node fails to {move.transition}, but is {step.state} then, not {move.to}"
        do = f"Let {callback_of(move.transition)} return FAILURE, and leave on_error to deal with errors."
    elif step.succeeded:
        says = f"the node says that it can {move.transition}, but is {step.state} then, not {move.to}"
        do = f"Let {move.transition} lead to the state {move.to}."
    else:
        says = f"{callback_of(move.transition)} does not succeed: the node is {step.state}, not {move.to}"
        if step.state == move.to:
            says = f"the node is {step.state}, but says that its {callback_of(move.transition)} did not succeed"
        do = f"Find out what {callback_of(move.transition)} returns, and let it return SUCCESS if all went well."
        if move.set_to is not None and step.state != move.to:
            says = f"after {lifecycle.rate.name} was set to {show(move.set_to)}, which is a good value, {says}"
            do = "Read the value each time the node is configured, and keep nothing of an attempt that has failed."
    return observed, seen.symptom(Symptom.WRONG_STATE, says=says, do=do, **about)


def _bad_value(seen: LifecycleRun, lifecycle: Lifecycle, move: Move) -> str:
    return show(seen.trace.parameters.get(lifecycle.rate.name) if move.set_to is None else move.set_to)


def callback_of(transition: str) -> str:
    """The method of a lifecycle node that a transition calls."""
    return f"on_{transition}"


def _name(step: Step) -> str:
    value = f" with {show(step.move.set_to)}" if step.move.set_to is not None else ""
    return f"{step.move.transition or 'at the start'}{value}"


def _state(step: Step) -> str:
    if step.change is None or step.succeeded:
        return step.state
    return f"refused, {step.state}"


def _describe(step: Step) -> str:
    if step.ended:
        return f"{_name(step)}: the program ends with 0"
    return f"{_name(step)}: {_state(step)}" + (f" at {step.rate}" if step.rate is not None else "")
