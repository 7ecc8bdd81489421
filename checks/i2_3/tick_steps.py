"""I2.3: the next steps where the timer does not tick at 10 Hz, or logs nothing."""

from __future__ import annotations

import ast

from checks.i2_3 import rewriting, steps
from checks.i2_3.callback_groups import replace_looked_up_group
from checks.i2_3.rewriting import combine_edits, timer, timer_callback
from checks.i2_3.ticks import HZ
from tutor.judge.causes.printing import enable_rosout
from tutor.judge.causes.slips import diagnose_simulated_time
from tutor.judge.edits import remove_statement, replace_node
from tutor.judge.rewriting.node import NodeFile, argument
from tutor.judge.source import calls_in, values_of
from tutor.judge.verdict import Cause

_LOGS = ("info", "warning", "warn", "error", "fatal")


def fix_period(file: NodeFile) -> str | None:
    """The step where the timer has the wrong period, its callback takes too long, or its messages have no number."""
    made, found = timer(file), timer_callback(file)
    given = argument(made, 0, "timer_period_sec") if made is not None else None
    if naps := calls_in(found, "sleep"):
        statement = file.statement(naps[0])
        return file.step([remove_statement(file.text, statement)]) or rewrite_ticking(file)
    right = f"{1 / HZ:g}"
    if given is not None and not _is_right(file, given):
        return file.step([replace_node(file.text, given, right)]) or rewrite_ticking(file)
    return file.step(replace_looked_up_group(file)) or rewrite_ticking(file)


def _is_right(file: NodeFile, given: ast.expr) -> bool:
    """Whether the period is 0.1, or a variable that is set to it."""
    return any(rewriting.number(each) == 1 / HZ for each in (given, *values_of(ast.unparse(given), file.tree)))


def rewrite_ticking(file: NodeFile) -> str | None:
    """The step that rewrites the timer and its callback."""
    late = (
        combine_edits(file, rewriting.rewrite_timer(file), rewriting.rewrite_service_callback(file))
        if rewriting.is_made_in_each_call(file)
        else []
    )
    return (
        file.step(late)
        or file.step(rewriting.rewrite_timer_callback(file))
        or file.step(combine_edits(file, rewriting.rewrite_timer(file), rewriting.rewrite_timer_callback(file)))
        or steps.rewrite_everything(file)
    )


def diagnose_no_ticks(file: NodeFile) -> Cause | None:
    """Find why no messages of the timer arrive."""
    if (simulated := diagnose_simulated_time(file)) is not None:
        return simulated
    made, found = timer(file), timer_callback(file)
    given = [each for call in file.calls("__init__", "Node") for each in call.keywords]
    if (off := next((each.value for each in given if each.arg == "enable_rosout"), None)) is not None:
        return _cause_if_step(f"line {off.lineno}: the node's log messages are not published", enable_rosout(file))
    if made is None or found is None:
        return (
            _cause_if_step("the node makes no timer", steps.rewrite_everything(file))
            if file.tree.body and not file.timers
            else None
        )
    logs, debug_log = calls_in(found, *_LOGS), next(iter(calls_in(found, "debug")), None)
    if debug_log is not None and not logs:
        info = replace_node(file.text, debug_log.func, f"{ast.unparse(debug_log.func).removesuffix('debug')}info")
        return _cause_if_step(
            f"line {debug_log.lineno}: {ast.unparse(debug_log)}: debug messages are not shown", file.step([info])
        )
    if not logs:
        return _cause_if_step(f"{found.name} (line {found.lineno}) logs nothing", rewrite_ticking(file))
    seconds = argument(made, 0, "timer_period_sec")
    if seconds is not None and (value := rewriting.number(seconds)) is not None and value > 2 / HZ:
        return Cause(
            "wrong timer period",
            f"line {made.lineno}: {ast.unparse(made)} ticks every {value:g} s: create_timer takes the seconds "
            "between two ticks, not ticks per second",
            str(fix_period(file)),
        )
    return None


def _cause_if_step(text: str, step: str | None) -> Cause | None:
    return Cause("no timer messages", text, step) if step else None
