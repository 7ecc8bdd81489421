"""Rewrite a learner's program as a whole, keeping its names: the last resort if no edit of its parts helps."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import wraps

from tutor.judge.edits import Edit
from tutor.judge.rewriting.node import NodeFile, first_line
from tutor.judge.source import Function, SourceFile, calls_in
from tutor.judge.step_parsing import is_applicable
from tutor.judge.trace import Trace
from tutor.judge.verdict import Status, Verdict

_IDENTIFIER = re.compile(r"[A-Za-z]\w*")
_RESERVED = re.compile(
    r"_?(?:publishers|timers|clients|services|subscriptions|guards|waitables|parameters|executor|handle|context|clock"
    r"|logger|default_callback_group)|(?:create|get|set|declare|undeclare|add|destroy|count|has|describe|list|wait"
    r"|remove|resolve)_\w+"
)
"""Names of attributes that `rclpy.node.Node` has, or may have: the learner's own attributes must not reuse them."""

MAIN = """\


def {main}():
    rclpy.init()
    try:
        rclpy.spin({node_class}())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    {main}()"""
"""The end of a program with one node."""


@dataclass(frozen=True)
class Names:
    """The names that a node's program gives its parts, without `self.`."""

    node_class: str
    node: str
    publisher: str
    timer: str
    tick: str
    counter: str
    check: str
    main: str


def names_of(file: NodeFile, node: str) -> Names:
    """The learner's names; usual names replace missing ones and those that collide with a node's own attributes.

    `node`: the node's name, in case the file gives none.
    """
    owner = file.class_of(file.setup) if file.setup is not None else None
    taken: set[str] = {"main"}

    def own(name: str, usual: str) -> str:
        is_usable = _IDENTIFIER.fullmatch(name.lstrip("_")) and not _RESERVED.fullmatch(name) and name not in taken
        taken.add(chosen := name if is_usable and not name.startswith("__") else usual)
        return chosen

    def attribute(code: str) -> str:
        return code.removeprefix("self.") if code.startswith("self.") else ""

    given = [
        first.value
        for call in file.calls("__init__", "create_node", "Node")
        for first in call.args
        if isinstance(first, ast.Constant) and isinstance(first.value, str)
    ]
    node_name = next((each for each in given if _IDENTIFIER.fullmatch(each)), node)
    timer = file.first_timer
    counters = (
        ast.unparse(each.target)
        for each in ast.walk(file.tree)
        if isinstance(each, ast.AugAssign) and isinstance(each.op, ast.Add) and isinstance(each.value, ast.Constant)
    )
    tick = file.timer_callback if file.timer_callback is not file.setup else None
    usual_class = "".join(part.capitalize() for part in node_name.split("_"))
    return Names(
        node_class=owner.name if owner is not None and owner.name not in ("Node", "String", "Float64") else usual_class,
        node=node_name,
        publisher=own(attribute(file.publisher), "publisher"),
        timer=own(attribute(file.assigned_to(timer)) if timer is not None else "", "timer"),
        tick=own(tick.name if tick is not None else "", "timer_callback"),
        counter=own(next((found for each in counters if (found := attribute(each))), ""), "count"),
        check=own(_on_set_callback_name(file), "check_parameters"),
        main=_main_name(file),
    )


def _on_set_callback_name(file: NodeFile) -> str:
    for call in file.calls("add_on_set_parameters_callback"):
        for given in call.args[:1]:
            if isinstance(given, ast.Attribute):
                return given.attr
    return ""


def _main_name(file: NodeFile) -> str:
    """The name of the function that calls rclpy.init(); "main" if there is none."""
    mains = [
        each
        for each in file.tree.body
        if isinstance(each, Function) and any(ast.unparse(one.func) == "rclpy.init" for one in calls_in(each))
    ]
    return mains[0].name if mains else "main"


def rewrite_file(file: SourceFile, code: str) -> list[Edit]:
    """Replace everything in a file below its docstring."""
    body = file.tree.body
    if not body:
        return []
    has_docstring = ast.get_docstring(file.tree) is not None and len(body) > 1
    return [Edit(first_line(body[1 if has_docstring else 0]), len(file.text.splitlines()), code)]


def is_usual(file: NodeFile) -> bool:
    """Whether a node has the usual structure: one class, its timer kept in an attribute, its callbacks methods.

    Only for such a node is it certain that rewriting its callbacks makes them do what is required.
    """
    setup, timer, tick = file.setup, file.first_timer, file.timer_callback
    owner = file.class_of(setup) if setup is not None else None
    if owner is None or timer is None or tick is None or tick is setup or file.class_of(tick) is not owner:
        return False
    unusual_calls = ("sleep", "create_rate", "wait", "parse_args", "parse_known_args", "Thread", "Timer", "partial")
    has_loop = any(isinstance(each, ast.While) for each in ast.walk(file.tree))
    return (
        file.name == "self"
        and not has_loop
        and re.fullmatch(r"self\.\w+", file.assigned_to(timer)) is not None
        and len([each for each in file.tree.body if isinstance(each, ast.ClassDef)]) == 1
        and not file.calls(*unusual_calls)
    )


def with_applicable_steps[**P](
    judge: Callable[P, Verdict], found: Callable[..., Sequence[Trace]], step: Callable[[Trace], str]
) -> Callable[P, Verdict]:
    """Wrap a judge so that all its next steps are edits: if a hint is only words, `step` provides one.

    The words are then appended to the cause. `found` returns the traces in the judge's facts.
    """

    @wraps(judge)
    def judge_with_step(*args: P.args, **kwargs: P.kwargs) -> Verdict:
        verdict = judge(*args, **kwargs)
        trace = next((each for each in found(*args, **kwargs) if each.sources), None)
        if verdict.status is not Status.FAILED or trace is None or is_applicable(verdict.step, trace.sources):
            return verdict
        hint = step(trace)
        if not hint:
            return verdict
        words = verdict.step if "\n" not in verdict.step else ""
        return replace(verdict, step=hint, cause="; ".join(each for each in (verdict.cause, words) if each))

    return judge_with_step
