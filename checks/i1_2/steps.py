"""I1.2: the next step for each criterion, as edits of the learner's own file; None if there is no safe one."""

from __future__ import annotations

import ast
from collections.abc import Sequence
from dataclasses import replace

from checks.i1_2 import rate_steps, rewriting, slowness
from checks.i1_2.listener import find_listener
from checks.i1_2.templates import find_log_call
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
    """The step to state the true total."""
    return rewriting.rewrite_callback(trace)


def measure_rate(trace: Trace, texts: Sequence[str] = (), numbers: Sequence[str] = ()) -> str | None:
    """The step to state messages per second; `texts` and `numbers` as in `rate_steps.fix_rate`."""
    return rate_steps.fix_rate(trace, texts, numbers) or rewriting.rewrite_callback(trace)


def summarise_every_ten(trace: Trace) -> str | None:
    """The step to log a summary every ten messages, with the first and the last one."""
    return rewriting.rewrite_callback(trace)


def remove_throttle(trace: Trace) -> str | None:
    """The step to log without throttling; None if nothing is throttled."""
    for call in (node for node in source.all_nodes(trace) if isinstance(node, ast.Call)):
        kept = [each for each in call.keywords if each.arg != "throttle_duration_sec"]
        if len(kept) < len(call.keywords):
            file, plain = source.file_holding(trace, call), ast.unparse(ast.Call(call.func, call.args, kept))
            return describe_edits_of(file, replace_node(file.text, call, plain))
    return None


def keep_first_message(trace: Trace) -> str | None:
    """The step to keep the first message once it is set."""
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
    """The step to keep counting after a restart of the publisher."""
    return _count_current_publishers(trace) or rewriting.rewrite_callback(trace)


def _count_current_publishers(trace: Trace) -> str | None:
    """The step for a "matched" event whose `total_count`, which only rises, is taken for the number of publishers."""
    for file in source.files(trace):
        tests = [each for each in file.nodes if isinstance(each, ast.Compare) and isinstance(each.ops[0], ast.Eq)]
        found = [each for each in tests if ast.unparse(each).endswith(".total_count == 1")]
        for test in found if "matched" in file.text else ():
            current = f"{ast.unparse(test.left).removesuffix('total_count')}current_count > 0"
            if step := describe_edits_of(file, [replace_node(file.text, test, current)]):
                return step
    return None


def announce_restart(trace: Trace) -> str | None:
    """The step to log a restart of the publisher where the statistics are reset."""
    listener = find_listener(trace)
    for function in listener.within if listener else []:
        for node in ast.walk(function):
            if (
                listener
                and isinstance(node, ast.If)
                and isinstance(node.test, ast.BoolOp | ast.Compare)
                and _tests_for_decrease(node.test)
            ):
                code = f"{listener.logger}.warning('the publisher was restarted: counting from zero')"
                if step := describe_edits_of(listener.file, [insert_into_block(node.lineno, code)]):
                    return step
    return rewriting.rewrite_callback(trace)


def _tests_for_decrease(test: ast.expr) -> bool:
    """Whether the condition tests for a number lower than the previous one."""
    operators = [op for each in ast.walk(test) if isinstance(each, ast.Compare) for op in each.ops]
    return any(isinstance(op, ast.Lt | ast.LtE) for op in operators)


def keep_node_up(trace: Trace, cause: Cause) -> Cause:
    """The cause, with a step that keeps the node up and subscribed if it exits or is not subscribed."""
    exit_functions: tuple[str, ...] = ()
    if cause.name == "no subscription":
        exit_functions = ("destroy_subscription",)
    elif cause.name == names.EXIT_AT_ONCE:
        exit_functions = ("shutdown", "try_shutdown", "exit", "_exit", "quit")
    inside_class = [
        node for each in source.all_nodes(trace) if isinstance(each, ast.ClassDef) for node in ast.walk(each)
    ]
    for call in (
        (each for each in source.calls(trace, *exit_functions) if each in inside_class) if exit_functions else ()
    ):
        if step := slowness.remove_call(trace, call):
            return replace(cause, hint=step)
    for each in inside_class if "exit" in exit_functions else ():
        if isinstance(each, ast.Raise) and each.exc is not None and ast.unparse(each.exc).startswith("SystemExit"):
            file = source.file_holding(trace, each)
            if step := describe_edits_of(file, remove_lines(file.text, each.lineno)):
                return replace(cause, hint=step)
    step = _add_subscription(trace) if cause.name == "no subscription" else None
    return replace(cause, hint=step) if step else cause


def _add_subscription(trace: Trace) -> str | None:
    """The step to subscribe with a method that takes a message."""
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
    """The step to compare each number with the previous one. `false`: log messages of false alarms, to be removed."""
    listener = find_listener(trace)
    if listener is None or not (listener.message and listener.logger):
        return rewriting.rewrite_callback(trace)
    last = listener.new_name("last_number", "number_before")
    code = _GAPS.format(content=listener.content, logger=listener.logger, last=last)
    log_calls = [find_log_call(trace, each) for each in false[-1:]]
    if all(each is not None and each.text == listener.text for each in log_calls):
        edits = [
            rewriting.set_first_value(listener, [f"{last} = None"]),
            rewriting.prepend_to_callback(listener, [last], code),
            *(
                remove_lines(each.text, each.statement.lineno, each.statement.end_lineno or 0)
                for each in log_calls
                if each
            ),
        ]
        if step := describe_edits_of(listener.file, edits):
            return step
    return rewriting.rewrite_callback(trace)
