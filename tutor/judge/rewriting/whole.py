"""A learner's program as a whole, in its own names: the step that is left where no edit of its parts helps."""

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
_TAKEN = re.compile(
    r"_?(?:publishers|timers|clients|services|subscriptions|guards|waitables|parameters|executor|handle|context|clock"
    r"|logger|default_callback_group)|(?:create|get|set|declare|undeclare|add|destroy|count|has|describe|list|wait"
    r"|remove|resolve)_\w+"
)
"""What a node has itself, or may have: nothing of the learner's is called so."""

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
    """What a node's program calls its parts, without `self.`."""

    node_class: str
    node: str
    publisher: str
    timer: str
    tick: str
    counter: str
    check: str
    main: str


def names_of(file: NodeFile, node: str) -> Names:
    """The learner's names; those that the file lacks, or that a node has itself, are the usual ones.

    `node` is the node's name, where the file has none.
    """
    owner = file.class_of(file.setup) if file.setup is not None else None
    taken: set[str] = {"main"}

    def own(name: str, usual: str) -> str:
        fits = _IDENTIFIER.fullmatch(name.lstrip("_")) and not _TAKEN.fullmatch(name) and name not in taken
        taken.add(chosen := name if fits and not name.startswith("__") else usual)
        return chosen

    def attribute(code: str) -> str:
        return code.removeprefix("self.") if code.startswith("self.") else ""

    given = [
        first.value
        for call in file.calls("__init__", "create_node", "Node")
        for first in call.args
        if isinstance(first, ast.Constant) and isinstance(first.value, str)
    ]
    fitting = next((each for each in given if _IDENTIFIER.fullmatch(each)), node)
    made = file.first_timer
    counted = (
        ast.unparse(each.target)
        for each in ast.walk(file.tree)
        if isinstance(each, ast.AugAssign) and isinstance(each.op, ast.Add) and isinstance(each.value, ast.Constant)
    )
    ticking = file.tick if file.tick is not file.setup else None
    usual = "".join(part.capitalize() for part in fitting.split("_"))
    fits = owner is not None and owner.name not in ("Node", "String", "Float64")
    return Names(
        node_class=owner.name if owner is not None and fits else usual,
        node=fitting,
        publisher=own(attribute(file.publisher), "publisher"),
        timer=own(attribute(file.assigned_to(made)) if made is not None else "", "timer"),
        tick=own(ticking.name if ticking is not None else "", "timer_callback"),
        counter=own(next((found for each in counted if (found := attribute(each))), ""), "count"),
        check=own(_checking(file), "check_parameters"),
        main=_main(file),
    )


def _checking(file: NodeFile) -> str:
    for call in file.calls("add_on_set_parameters_callback"):
        for given in call.args[:1]:
            if isinstance(given, ast.Attribute):
                return given.attr
    return ""


def _main(file: NodeFile) -> str:
    """What the program's function is called."""
    starting = [
        each
        for each in file.tree.body
        if isinstance(each, Function) and any(ast.unparse(one.func) == "rclpy.init" for one in calls_in(each))
    ]
    return starting[0].name if starting else "main"


def rewrite_file(file: SourceFile, code: str) -> list[Edit]:
    """All of a file below its docstring, with other code in its place."""
    body = file.tree.body
    if not body:
        return []
    described = ast.get_docstring(file.tree) is not None and len(body) > 1
    return [Edit(first_line(body[1 if described else 0]), len(file.text.splitlines()), code)]


def is_usual(file: NodeFile) -> bool:
    """Whether a node is built as usual: one class, its timer kept in an attribute, its callbacks methods.

    Only of such a node is it sure that its callbacks, rewritten, do what is asked for.
    """
    setup, made, tick = file.setup, file.first_timer, file.tick
    owner = file.class_of(setup) if setup is not None else None
    if owner is None or made is None or tick is None or tick is setup or file.class_of(tick) is not owner:
        return False
    waits = ("sleep", "create_rate", "wait", "parse_args", "parse_known_args", "Thread", "Timer", "partial")
    looping = any(isinstance(each, ast.While) for each in ast.walk(file.tree))
    return (
        file.name == "self"
        and not looping
        and re.fullmatch(r"self\.\w+", file.assigned_to(made)) is not None
        and len([each for each in file.tree.body if isinstance(each, ast.ClassDef)]) == 1
        and not file.calls(*waits)
    )


def with_applicable_steps[**P](
    judge: Callable[P, Verdict], found: Callable[..., Sequence[Trace]], step: Callable[[Trace], str]
) -> Callable[P, Verdict]:
    """The judge, with next steps that can all be followed: where one is in words only, `step` gives another.

    `found` gives the runs that a judge's facts are of; the words are then added to the cause.
    """

    @wraps(judge)
    def judged(*args: P.args, **kwargs: P.kwargs) -> Verdict:
        verdict = judge(*args, **kwargs)
        trace = next((each for each in found(*args, **kwargs) if each.sources), None)
        if verdict.status is not Status.FAILED or trace is None or is_applicable(verdict.hint, trace.sources):
            return verdict
        hint = step(trace)
        if not hint:
            return verdict
        words = verdict.hint if "\n" not in verdict.hint else ""
        return replace(verdict, hint=hint, cause="; ".join(each for each in (verdict.cause, words) if each))

    return judged
