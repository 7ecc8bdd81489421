"""I1.2: the step that corrects the rate in a summary, if it is known which of its values should be the rate."""

from __future__ import annotations

import ast
import re
from collections.abc import Sequence

from checks.i1_2 import rewriting
from checks.i1_2.listener import COUNT, START, Listener, find_listener, value_of
from checks.i1_2.templates import LogCall, find_log_call
from tutor.judge.edits import Edit, add_import, describe_edits_of, insert_above, prepend_to_function, replace_node
from tutor.judge.trace import Trace

_RATE_NAME = re.compile(
    r"rate|hz|freq|per_?s|mps|speed|throughput|d[eé]bit|cadence|fr[eé]quence|tasa|frecuencia|frequenz", re.IGNORECASE
)
_CLOCKS = re.compile(r"(time\.)?(time|monotonic|perf_counter)\(\)")


def fix_rate(trace: Trace, texts: Sequence[str], numbers: Sequence[str]) -> str | None:
    """The step that corrects the rate in place. `texts`: the summary's log messages; `numbers`: possible rates."""
    listener = find_listener(trace)
    places = [place for text in texts if (place := find_log_call(trace, text)) is not None]
    found = [(place, each) for place in places for each, value in place.values if value.strip() in numbers]
    named = [(place, each) for place, each in found if _RATE_NAME.search(ast.unparse(each))]
    chosen = named or found
    if listener is None or len(chosen) != 1 or not listener.message or COUNT not in listener.names:
        return None
    place, value = chosen[0]
    if place.text != listener.text or place.function not in listener.within:
        return None
    edits, clock, start = _start_time(listener)
    new = f"({listener.names[COUNT]} - 1) / ({clock} - {start})"
    return describe_edits_of(listener.file, [*edits, _replace_value(place, value, new, clock, start)])


def _replace_value(place: LogCall, value: ast.expr, new: str, clock: str, start: str) -> Edit:
    """The edit that replaces this value by `new`: where it is computed, in the log text, or right above."""
    name = ast.unparse(value)
    assignments = [
        each
        for each in ast.walk(place.function or place.statement)
        if isinstance(each, ast.Assign) and [ast.unparse(target) for target in each.targets] == [name]
    ]
    if len(assignments) == 1:
        tests = [each for each in ast.walk(place.function or place.statement) if isinstance(each, ast.If)]
        per_summary = any(assignments[0] in ast.walk(each) and "%" in ast.unparse(each.test) for each in tests)
        safe = new if per_summary else new.replace(f"({clock} - {start})", f"max({clock} - {start}, 0.001)")
        return replace_node(place.text, assignments[0].value, safe)
    if isinstance(value, ast.Name | ast.Attribute) and assignments:
        return insert_above(place.statement.lineno, f"{name} = {new}")
    return replace_node(place.text, value, new)


def _start_time(listener: Listener) -> tuple[list[Edit], str, str]:
    """How to know when the first message came: edits, the clock expression, and the variable."""
    if (own := _existing_clock(listener)) is not None:
        return [], own, listener.names[START]
    wanted, clock = rewriting.monotonic_clock(listener.text)
    start = listener.new_name("start_time", "first_time")
    code = f"if {start} is None:\n    {start} = {clock}"
    edits = [
        rewriting.set_first_value(listener, [f"{start} = None"]),
        prepend_to_function(listener.function, rewriting.declare_variables(listener, [start], code)),
    ]
    return [*add_import(listener.text, wanted), *edits], clock, start


def _existing_clock(listener: Listener) -> str | None:
    """The clock, such as time.time(), with which the file records the first message's time; None if that is unsure."""
    name = listener.names.get(START, "")
    tests = [
        (function, each) for function in listener.within for each in ast.walk(function) if isinstance(each, ast.If)
    ]
    settings = []
    for function in listener.within:
        for each in ast.walk(function):
            if isinstance(each, ast.Assign) and name in [ast.unparse(target) for target in each.targets]:
                conditions = [test for inside, test in tests if inside is function and each in test.body]
                settings.append((value_of(each.value, function), conditions))
    if len(settings) != 1 or not settings[0][1]:
        return None
    value, test = ast.unparse(settings[0][0]), ast.unparse(settings[0][1][-1].test)
    first = re.fullmatch(r"[\w.]+ is None|not [\w.]+|[\w.]+ == 0", test)
    return value if first and _CLOCKS.fullmatch(value) else None
