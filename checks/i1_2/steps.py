"""I1.2: the next step of each criterion, as edits of the learner's own file; None where there is none to be sure of."""

from __future__ import annotations

import ast
from collections.abc import Sequence
from dataclasses import replace

from checks.i1_2 import rate_steps, rewriting, slowness
from checks.i1_2.listener import find_listener
from checks.i1_2.templates import logged
from tutor.judge import source
from tutor.judge.causes import names
from tutor.judge.edits import (
    add_import,
    append_to_function,
    describe_edits_of,
    insert_into_block,
    remove_lines,
    replace_node,
)
from tutor.judge.trace import Trace
from tutor.judge.verdict import Cause

_GAPS = """\
number = int({content}.rpartition(':')[2])
if {last} is not None and number > {last} + 1:
    {logger}.warning(f'{{number - {last} - 1}} messages are missing before {{number}}')
{last} = number"""


def count_messages(trace: Trace) -> str | None:
    """States the true total."""
    return rewriting.rewrite_callback(trace)


def measure_rate(trace: Trace, texts: Sequence[str] = (), numbers: Sequence[str] = ()) -> str | None:
    """States messages per second; `texts` and `numbers` as in `rate_steps.step`."""
    return rate_steps.step(trace, texts, numbers) or rewriting.rewrite_callback(trace)


def summarise_every_ten(trace: Trace) -> str | None:
    """Sums up every ten messages, with the first and the last one."""
    return rewriting.rewrite_callback(trace)


def remove_throttle(trace: Trace) -> str | None:
    """Logs each time; None where nothing is throttled."""
    for call in (node for node in source.all_nodes(trace) if isinstance(node, ast.Call)):
        kept = [each for each in call.keywords if each.arg != "throttle_duration_sec"]
        if len(kept) < len(call.keywords):
            file, plain = source.file_holding(trace, call), ast.unparse(ast.Call(call.func, call.args, kept))
            return describe_edits_of(file, replace_node(file.text, call, plain))
    return None


def keep_first_message(trace: Trace) -> str | None:
    """Leaves the first message alone once it is there."""
    listener = find_listener(trace)
    for function in source.callbacks(trace, "create_subscription"):
        for node in ast.walk(function):
            match node:
                case ast.Assign(targets=[target], value=ast.Constant(value=None | "")) if "first" in ast.unparse(
                    target
                ):
                    if listener and (
                        step := describe_edits_of(listener.file, [remove_lines(listener.text, node.lineno)])
                    ):
                        return step
    return rewriting.rewrite_callback(trace)


def go_on_after_restart(trace: Trace) -> str | None:
    """Goes on when the publisher was restarted."""
    return rewriting.rewrite_callback(trace)


def announce_restart(trace: Trace) -> str | None:
    """Says that the publisher was restarted, where the statistics are set back."""
    listener = find_listener(trace)
    for function in listener.within if listener else []:
        for node in ast.walk(function):
            if (
                listener
                and isinstance(node, ast.If)
                and isinstance(node.test, ast.BoolOp | ast.Compare)
                and _falls(node.test)
            ):
                code = f"{listener.logger}.warning('the publisher was restarted: counting from zero')"
                if step := describe_edits_of(listener.file, [insert_into_block(node.lineno, code)]):
                    return step
    return rewriting.rewrite_callback(trace)


def _falls(test: ast.expr) -> bool:
    """Whether it asks for a number that is lower than the one before it."""
    asked = [op for each in ast.walk(test) if isinstance(each, ast.Compare) for op in each.ops]
    return any(isinstance(op, ast.Lt | ast.LtE) for op in asked)


def keep_node_up(trace: Trace, cause: Cause) -> Cause:
    """The cause, with a step that keeps the node up and subscribed where it ends itself, or is not subscribed."""
    ends: tuple[str, ...] = ()
    if cause.name == "no subscription":
        ends = ("destroy_subscription",)
    elif cause.name == names.EXIT_AT_ONCE:
        ends = ("shutdown", "try_shutdown", "exit", "_exit", "quit")
    inside_class = [
        node for each in source.all_nodes(trace) if isinstance(each, ast.ClassDef) for node in ast.walk(each)
    ]
    for call in (each for each in source.calls(trace, *ends) if each in inside_class) if ends else ():
        if step := slowness.remove_call(trace, call):
            return replace(cause, hint=step)
    for each in inside_class if "exit" in ends else ():
        if isinstance(each, ast.Raise) and each.exc is not None and ast.unparse(each.exc).startswith("SystemExit"):
            file = source.file_holding(trace, each)
            if step := describe_edits_of(file, remove_lines(file.text, each.lineno)):
                return replace(cause, hint=step)
    step = _subscribed(trace) if cause.name == "no subscription" else None
    return replace(cause, hint=step) if step else cause


def _subscribed(trace: Trace) -> str | None:
    """Subscribes with a method that takes a message."""
    for file in source.files(trace):
        for owner in (each for each in file.nodes if isinstance(each, ast.ClassDef)):
            methods = [each for each in owner.body if isinstance(each, ast.FunctionDef)]
            made = next((each for each in methods if each.name == "__init__"), None)
            for method in methods:
                given = [each.arg for each in method.args.args[1:]]
                reads = any(isinstance(each, ast.Attribute) and each.attr == "data" for each in ast.walk(method))
                if made is not None and len(given) == 1 and reads and method is not made:
                    code = f"self.subscription = self.create_subscription(String, 'chatter', self.{method.name}, 10)"
                    return describe_edits_of(
                        file, add_import(file.text, "from std_msgs.msg import String"), append_to_function(made, code)
                    )
    return None


def compare_numbers(trace: Trace, false: Sequence[str] = ()) -> str | None:
    """Compares each number with the one before; `false`: log messages of gaps that there were not, to be taken out."""
    listener = find_listener(trace)
    if listener is None or not (listener.message and listener.logger):
        return rewriting.rewrite_callback(trace)
    last = listener.new("last_number", "number_before")
    code = _GAPS.format(content=listener.content, logger=listener.logger, last=last)
    told = [logged(trace, each) for each in false[-1:]]
    if all(each is not None and each.text == listener.text for each in told):
        edits = [
            rewriting.set_first_value(listener, [f"{last} = None"]),
            rewriting.prepend_to_callback(listener, [last], code),
            *(remove_lines(each.text, each.statement.lineno, each.statement.end_lineno or 0) for each in told if each),
        ]
        if step := describe_edits_of(listener.file, edits):
            return step
    return rewriting.rewrite_callback(trace)
