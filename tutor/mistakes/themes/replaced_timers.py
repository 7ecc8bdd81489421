"""Timers that are replaced, and run on."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from itertools import combinations

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Found, found, mistake
from tutor.mistakes.examples import in_run
from tutor.source import NodeFile, argument
from tutor.source.parameters import ON_SET, POST_SET


@mistake(
    "old-timer-kept",
    explains=(Symptom.WRONG_RATE, Symptom.BAD_VALUE_ACCEPTED, Symptom.CHANGE_IGNORED),
    says="{what}: both go on",
    do="Cancel the old timer before you make the new one.",
    example=in_run(Symptom.WRONG_RATE),
)
def old_timer_kept(case: Case) -> Iterator[Found]:
    """A timer that is replaced runs on until it is cancelled.

    The node keeps every timer that it has made; giving the name to another one does not stop the first. Their messages
    add up: a forgotten timer of 1 Hz beside a new one of 10 Hz measures 11 Hz.

    Bad:

        class Lamp(Node):
            def __init__(self):
                self.timer = self.create_timer(1.0, self.blink)
                self.add_post_set_parameters_callback(self.follow)

            def follow(self, parameters):
                self.timer = self.create_timer(1.0 / parameters[0].value, self.blink)

    Good:

        class Lamp(Node):
            def __init__(self):
                self.timer = self.create_timer(1.0, self.blink)
                self.add_post_set_parameters_callback(self.follow)

            def follow(self, parameters):
                self.timer.cancel()
                self.timer = self.create_timer(1.0 / parameters[0].value, self.blink)

    See it: `ros2 topic hz TOPIC` after lowering the rate: the old beat goes on beside the new one.
    """
    rate, wanted_hz = case.about("rate"), case.about("wanted_hz")
    faster = rate is not None and not case.about("unchanged") and rate.hz > wanted_hz
    if case.symptom is Symptom.BAD_VALUE_ACCEPTED and not case.about("taken_over"):
        return
    if case.symptom is Symptom.CHANGE_IGNORED and not faster:
        return
    for file in case.files:
        for call in _uncancelled(file, each_branch=case.symptom is Symptom.CHANGE_IGNORED):
            yield found(file, call, what=f"line {call.lineno} makes a new timer, and nothing cancels the one before it")
    earlier = case.about("earlier_hz", ())
    for number in range(1, len(earlier) + 1) if faster else ():
        for old in combinations(earlier, number):
            if abs(rate.hz - wanted_hz - sum(old)) < 0.1 * sum(old):
                beats = " and ".join(f"{hz:g} Hz" for hz in old)
                yield Found({"what": f"the {rate.hz:.3g} Hz are {wanted_hz:g} Hz and the {beats} of an older timer"})


def _uncancelled(file: NodeFile, *, each_branch: bool) -> Iterator[ast.Call]:
    """The calls in parameter callbacks that make a timer, where nothing in the callback ends one.

    `each_branch`: also where something does, but only in another branch of a condition.
    """
    for registration in file.calls(ON_SET, POST_SET):
        function = file.function(argument(registration, "callback"))
        inside = file.reachable_from(function) if function is not None else []
        ends = [end for end in file.calls("cancel", "destroy_timer", "destroy") if file.function_around(end) in inside]
        for call in file.timers:
            if file.function_around(call) in inside and all(each_branch and _excludes(file, end, call) for end in ends):
                yield call


def _excludes(file: NodeFile, one: ast.AST, other: ast.AST) -> bool:
    """Whether two nodes are in different branches of one condition, so that only one of them is run."""
    inside = list(file.ancestors(other))
    for around in file.ancestors(one):
        if isinstance(around, ast.If) and around in inside:
            branches = [set(ast.walk(ast.Module(block, []))) for block in (around.body, around.orelse)]
            return any(one in branch and other not in branch for branch in branches)
    return False
