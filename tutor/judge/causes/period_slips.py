"""Mistakes in a timer's period that show in one line of the learner's file: the cause, with the edit of that line."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from itertools import pairwise, takewhile

from tutor.judge.causes.inheritance import diagnose_repeated_setup
from tutor.judge.edits import insert_after, remove_statement, replace_node, replace_statement
from tutor.judge.rewriting.node import NodeFile, argument, find_in_files
from tutor.judge.source import calls_in, last_name, values_of, where
from tutor.judge.trace import Trace
from tutor.judge.verdict import Cause

_IMAGINED_PERIODS = ("period", "timer_period", "timer_period_sec", "timer_period_s", "interval", "period_sec", "rate")

_IS_TO_WAIT = re.compile(r"sleep|wait|pause|delay|spin|run|loop", re.IGNORECASE)
"""Names of functions whose purpose it is to wait, or which loop at the rate of the node."""

_CLOCKS = ("time", "monotonic", "perf_counter", "now", "time_ns", "monotonic_ns")

MIN_MILLISECONDS = 50.0
"""A timer's period from this number on is in milliseconds: nobody waits so many seconds in an exercise."""


def diagnose_integer_period(file: NodeFile) -> Cause | None:
    """Whether a timer's period is turned into a whole number, by //, int() or round()."""
    found = [(period, fixed) for period in _periods(file) if (fixed := _with_decimals(period)) is not None]
    step = file.step([replace_node(file.text, period, fixed) for period, fixed in found])
    if not found or step is None:
        return None
    first = found[0][0]
    text = f"line {first.lineno}: {ast.unparse(first)} has no decimals: 1 // 5 is 0, and int(1 / 0.7) is 1"
    return Cause("period made a whole number", text, step)


def diagnose_period_unit(file: NodeFile) -> Cause | None:
    """Whether a period divides a number other than 1 by the rate, such as 1000 / hz."""
    for period in _periods(file):
        match period:
            case ast.BinOp(left=ast.Constant(value=int() | float() as number) as top, op=ast.Div()) if number != 1:
                step = file.step([replace_node(file.text, top, "1.0")])
                text = (
                    f"line {period.lineno}: the period {ast.unparse(period)} is not the one of this rate: create_timer "
                    "takes seconds"
                )
                return Cause("wrong timer period", text, step) if step else None
    return None


def diagnose_nanoseconds(file: NodeFile) -> Cause | None:
    """Whether a timer's `timer_period_ns` is computed with another number of nanoseconds in a second than 1e9."""
    for node in file.nodes:
        if not isinstance(node, ast.Assign) or "timer_period_ns" not in map(last_name, node.targets):
            continue
        numbers = [each for each in ast.walk(node.value) if isinstance(each, ast.Constant)]
        large = [each for each in numbers if isinstance(each.value, int | float) and each.value >= 1000]
        if len(large) == 1 and large[0].value != 1e9:
            step = file.step([replace_node(file.text, large[0], "1_000_000_000")])
            text = f"line {node.lineno}: {ast.unparse(node)}: there are 1_000_000_000 nanoseconds in a second"
            return Cause("wrong timer period", text, step) if step else None
    return None


def diagnose_period_attribute(file: NodeFile) -> Cause | None:
    """Whether a period in seconds is assigned to an attribute that a Timer does not have, such as `timer.period`."""
    timers = {file.assigned_to(each) for each in file.timers} - {""}
    for node in file.nodes:
        match node:
            case ast.Assign(targets=[ast.Attribute(value=timer, attr=name) as target], value=value):
                pass
            case _:
                continue
        if ast.unparse(timer) not in timers or name not in _IMAGINED_PERIODS:
            continue
        old = ast.unparse(target)
        reads = [each for each in file.nodes if isinstance(each, ast.Attribute) and ast.unparse(each) == old]
        seconds = [each for each in reads if each is not target]
        period = ast.unparse(value) if isinstance(value, ast.Constant) else f"({ast.unparse(value)})"
        edits = [replace_statement(node, f"{ast.unparse(timer)}.timer_period_ns = int(1e9 * {period})")]
        edits += [replace_node(file.text, each, f"({ast.unparse(timer)}.timer_period_ns / 1e9)") for each in seconds]
        step = file.step(edits)
        text = f"{where(node)}: a timer has no attribute {name}, so this only creates one that nothing reads"
        return Cause("wrong timer period", text, step) if step else None
    return None


def diagnose_no_autostart(file: NodeFile) -> Cause | None:
    """Whether a timer is created with `autostart=False`, and nothing starts it."""
    for call in file.timers:
        given = next((each.value for each in call.keywords if each.arg == "autostart"), None)
        started = f"{file.assigned_to(call)}.reset" in {ast.unparse(each.func) for each in file.calls("reset")}
        if isinstance(given, ast.Constant) and given.value is False and not started:
            step = file.step([replace_node(file.text, given, "True")])
            text = f"line {given.lineno}: with autostart=False, a timer does not run until its reset() is called"
            return Cause("timer not started", text, step) if step else None
    return None


def diagnose_self_cancelling(file: NodeFile, timer: ast.Call | None = None) -> Cause | None:
    """Whether a timer is cancelled or destroyed by its own callback, as after a number of ticks.

    `timer`: the call that creates it (default: any of the file).
    """
    for made in [timer] if timer is not None else file.timers:
        callback, name = file.function(argument(made, 1, "callback")), file.assigned_to(made)
        reached = file.reachable_from(callback) if callback is not None and name else []
        for call in file.calls("cancel", "destroy_timer"):
            if file.function_around(call) not in reached or name not in map(ast.unparse, (*call.args, *_owner(call))):
                continue
            statement = file.statement(call)
            around = next(file.ancestors(statement))
            if isinstance(around, ast.If) and around.body == [statement] and not around.orelse:
                statement = around
            step = file.step([remove_statement(file.text, statement)])
            text = f"{where(call)} ends the timer from its own callback"
            return Cause("timer cancelled", text, step) if step else None
    return None


def _owner(call: ast.Call) -> tuple[ast.expr, ...]:
    return (call.func.value,) if isinstance(call.func, ast.Attribute) else ()


def diagnose_milliseconds(file: NodeFile) -> Cause | None:
    """Whether a timer's period is a plain number that must be meant in milliseconds, as in rclcpp's `500ms`."""
    for period in _periods(file):
        match period:
            case ast.Constant(value=int() | float() as number) if number >= MIN_MILLISECONDS:
                step = file.step([replace_node(file.text, period, f"{number / 1000:g}")])
                text = f"line {period.lineno}: a period of {number:g} seconds: create_timer takes seconds"
                return Cause("wrong timer period", text, step) if step else None
    return None


def diagnose_twin_timers(file: NodeFile) -> Cause | None:
    """Whether two timers with the same callback are made, with the same period: the first one is to go."""
    for call, other in pairwise(file.timers):
        alike = all(
            _same(argument(call, position, name), argument(other, position, name))
            for position, name in enumerate(("timer_period_sec", "callback"))
        )
        step = file.step([remove_statement(file.text, file.statement(call))]) if alike else None
        if step is not None:
            text = f"lines {call.lineno} and {other.lineno} both make a timer with this period and callback"
            return Cause("two timers", text, step)
    return None


def diagnose_bursts(trace: Trace, step: str) -> Cause:
    """Several messages are sent at once: by timers that a loop makes or that are left over, or by a loop (`step`)."""
    return (
        find_in_files(trace, diagnose_timer_loop, diagnose_second_timer)
        or diagnose_repeated_setup(trace, "create_timer")
        or Cause(
            "messages in bursts",
            "several messages are sent at once, then none for a while: that is not a rate",
            step,
        )
    )


def diagnose_timer_loop(file: NodeFile) -> Cause | None:
    """Whether a loop makes several timers, such as one for each sensor, which all publish."""
    if file.first_timer is None:
        return None
    loop = next((each for each in _within_function(file, file.first_timer) if isinstance(each, ast.For)), None)
    step = file.step([insert_after(loop.body[-1], "break")]) if loop is not None else None
    if loop is None or step is None:
        return None
    text = f"the loop in line {loop.lineno} makes a timer each time, and each of them publishes at the rate asked for"
    return Cause("several timers", text, step)


def diagnose_second_timer(file: NodeFile) -> Cause | None:
    """Whether a timer with a fixed period runs beside another one with the same callback and a computed period."""
    at_start = file.reachable_from(file.setup) if file.setup is not None else []
    made = [
        (call, argument(call, 0, "timer_period_sec"), argument(call, 1, "callback"))
        for call in file.timers
        if file.function_around(call) in at_start
    ]
    fixed = [each for each in made if each[1] is not None and _is_fixed(file, each[1])]
    for call, period, callback in fixed:
        others = [other for other, *given in made if (other, *given) not in fixed and _same(callback, given[1])]
        step = file.step([remove_statement(file.text, file.statement(call))]) if others else None
        if step is not None and period is not None:
            text = (
                f"line {call.lineno} makes a timer with the fixed period {ast.unparse(period)}, which runs beside "
                f"the one of line {others[0].lineno}"
            )
            return Cause("two timers", text, step)
    return None


def _is_fixed(file: NodeFile, period: ast.expr) -> bool:
    if isinstance(period, ast.BinOp):
        return _is_fixed(file, period.left) and _is_fixed(file, period.right)
    values = [period] if isinstance(period, ast.Constant) else values_of(ast.unparse(period), file.tree)
    return bool(values) and all(isinstance(each, ast.Constant) for each in values)


def _same(one: ast.expr | None, other: ast.expr | None) -> bool:
    return one is not None and other is not None and ast.unparse(one) == ast.unparse(other)


def diagnose_sleep(file: NodeFile, asked_hz: float) -> Cause | None:
    """Whether the timer's callback, or a function that it calls, sleeps, which limits the rate of the timer.

    A sleep of less than a tenth of the period, at `asked_hz`, is negligible, unless it is repeated in a loop.
    """
    called = file.reachable_from(file.timer_callback) if file.timer_callback is not None else []
    for call in file.calls("sleep"):
        repeated = bool(file.timers) and any(isinstance(each, ast.For) for each in _within_function(file, call))
        if not file.timers and not isinstance(call.args[0] if call.args else None, ast.Constant):
            continue  # it may be the loop's own period
        match call.args:
            case [ast.Constant(value=int() | float() as sleep_s)] if sleep_s < 0.1 / asked_hz and not repeated:
                continue
        if file.function_around(call) in called:
            step = file.step([remove_statement(file.text, file.statement(call))])
            text = f"{where(call)}: the timer's callback sleeps here, and meanwhile the timer stands still"
            return Cause("callback sleeps", text, step) if step else None
    return None


def diagnose_sleep_in_helper(file: NodeFile, asked_hz: float) -> Cause | None:
    """Whether a function of a file without a node sleeps, for a tenth of the period at least if the time is fixed.

    Something like a Rate is to sleep.
    """
    if file.node_classes or file.calls("create_node", "create_publisher", "create_timer", "spin"):
        return None
    for call in file.calls("sleep"):
        given = call.args[0] if call.args else None
        values = values_of(last_name(given), file.tree) if isinstance(given, ast.Name | ast.Attribute) else [given]
        match values:
            case [ast.Constant(value=int() | float() as sleep_s)] if sleep_s < 0.1 / asked_hz:
                continue
        function = file.function_around(call)
        if function is None or _IS_TO_WAIT.search(function.name):
            continue
        step = file.step([remove_statement(file.text, file.statement(call))])
        text = f"{where(call)} in {file.file}: the node waits for this, whatever its period"
        return Cause("helper sleeps", text, step) if step else None
    return None


def diagnose_throttle(file: NodeFile) -> Cause | None:
    """Whether the timer's callback returns if the last message is less than some time ago, as many ticks are."""
    for function in file.reachable_from(file.timer_callback) if file.timer_callback is not None else ():
        for each in ast.walk(function):
            match each:
                case ast.If(test=ast.Compare(left=elapsed, ops=[ast.Lt() | ast.LtE()]), body=[ast.Return()], orelse=[]):
                    clocks = calls_in(elapsed, *_CLOCKS)
                    step = file.step([remove_statement(file.text, each)]) if clocks else None
                    if step is not None:
                        text = (
                            f"line {each.lineno}: if {ast.unparse(each.test)}: a tick that is a little early is dropped"
                        )
                        return Cause("ticks dropped", text, step)
    return None


def _within_function(file: NodeFile, node: ast.AST) -> Iterator[ast.AST]:
    """The ancestors of a syntax node within its function, innermost first."""
    function = file.function_around(node)
    return takewhile(lambda each: each is not function, file.ancestors(node))


def _with_decimals(period: ast.expr) -> str | None:
    """The code of a period that keeps its decimals; None if it does so already."""
    match period:
        case ast.BinOp(left=left, op=ast.FloorDiv(), right=right):
            return ast.unparse(ast.BinOp(left, ast.Div(), right))
        case ast.Call(func=ast.Name(id="int" | "round"), args=[inner]):
            return ast.unparse(inner)
    return None


def _periods(file: NodeFile) -> Iterator[ast.expr]:
    """The expressions that compute the timers' periods: the arguments themselves, and all values assigned to them."""
    for call in file.timers:
        period = argument(call, 0, "timer_period_sec")
        if period is not None:
            yield period
            yield from values_of(ast.unparse(period), file.tree)
