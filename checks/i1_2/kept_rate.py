"""I1.2: a rate that is worked out once and kept when the messages come at another one."""

from __future__ import annotations

import ast

from checks.i1_2 import steps
from checks.i1_2.facts import Trial
from checks.i1_2.rates import MIN_WINDOW, numbers_except_count, true_rates
from checks.i1_2.reading import Number
from checks.i1_2.summaries import find_summaries
from tutor.judge.edits import remove_lines, replace_node, replace_statement
from tutor.judge.rewriting.node import NodeFile, find_in_files
from tutor.judge.source import last_name
from tutor.judge.verdict import Cause


def find_kept_rate(restart: Trial) -> Number | None:
    """The rate that a node states before and after the publisher is replaced by one of another rate.

    A rate of any of the messages has changed by then. None if it also states another true rate, or if the rate has no
    decimals, and so may be the same by chance.
    """
    summaries = find_summaries(restart)
    before = [each for each in summaries if each.messages <= restart.before_break]
    after = [each for each in summaries if each.messages >= restart.before_break + MIN_WINDOW]
    for number in before[0].numbers if before and after else ():
        kept = all(number.text in {other.text for other in each.numbers} for each in (*before, *after))
        if "." in number.text and kept and true_rates(before[0], restart).holds(number):
            others = [
                other
                for each in after
                for other in numbers_except_count(each, restart)
                if other.text != number.text and true_rates(each, restart).holds(other)
            ]
            return None if others else number
    return None


def diagnose_kept_rate(kept: Number, trial: Trial) -> Cause:
    """Why a summary states the rate of an earlier one."""
    step = find_in_files(trial.trace, _compute_again) or steps.measure_rate(
        trial.trace, [line.text for line in find_summaries(trial)[-1].lines], [kept.text]
    )
    return Cause("rate never updated", "it is worked out once, and kept", step or "work it out for each summary again")


def _compute_again(file: NodeFile) -> str | None:
    """The step that leaves out a decorator, or a test for a first time, by which a quotient is kept."""
    for function in file.functions:
        for decorator in function.decorator_list:
            name = last_name(decorator.func if isinstance(decorator, ast.Call) else decorator)
            if name == "cached_property":
                return file.step([replace_node(file.text, decorator, "property")])
            if name in ("cache", "lru_cache"):
                return file.step([remove_lines(file.text, decorator.lineno, decorator.end_lineno or decorator.lineno)])
    for node in file.nodes:
        match node:
            case ast.If(
                test=ast.Compare(left=kept, ops=[ast.Is()]) | ast.UnaryOp(op=ast.Not(), operand=kept),
                body=[ast.Assign(targets=[target], value=value) as once],
                orelse=[],
            ) if ast.unparse(kept) == ast.unparse(target) and _divides(value):
                return file.step([replace_statement(node, ast.unparse(once))])
    return None


def _divides(value: ast.expr) -> bool:
    return any(isinstance(each, ast.Div) for each in ast.walk(value))
