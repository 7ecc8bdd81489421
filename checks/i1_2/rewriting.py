"""I1.2: the step that makes of a learner's callback one that does all that is asked for, in the file's own names."""

from __future__ import annotations

import ast
import re
import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence

from checks.i1_2.facts import EVERY
from checks.i1_2.listener import COUNT, FIRST, LAST, NUMBER, START, Listener, find_listener
from tutor.judge import source
from tutor.judge.edits import (
    Edit,
    add_import,
    apply,
    describe_edits_of,
    insert_above,
    insert_after,
    prepend_to_function,
    remove_statement,
    replace_lines,
    replace_node,
)
from tutor.judge.rewriting.node import first_line
from tutor.judge.source import last_name
from tutor.judge.trace import Trace

_AT_FIRST = {COUNT: "0", FIRST: "''", LAST: "''", START: "0.0", NUMBER: "None"}
_CODE = """\
if {total_count} == 0:
    {first_message} = {content}
    {start_time} = {clock}
{total_count} += 1
{last_message} = {content}
number = int({content}.rpartition(':')[2])
if {last_number} is not None and number > {last_number} + 1:
    {logger}.warning(f'{{number - {last_number} - 1}} messages are missing before {{number}}')
{last_number} = number
if {total_count} % {every} == 0:
    rate = ({total_count} - 1) / ({clock} - {start_time})
    {logger}.info(f'{{{total_count}}} messages, {{rate:.2f}} per second')
    {logger}.info(f'first: {{{first_message}}}, last: {{{last_message}}}')"""


def rewrite_callback(trace: Trace) -> str | None:
    """The step that rewrites the callback; None where it cannot be written so."""
    listener = find_listener(trace)
    if listener is not None and listener.message and listener.logger:
        names = {role: listener.name(role) for role in _AT_FIRST}
        wanted, now = monotonic_clock(listener.text)
        code = _CODE.format(content=listener.content, clock=now, logger=listener.logger, every=EVERY, **names)
        written = replace_body(listener, declare_variables(listener, names.values(), code))
        timers = list(_without_timers(listener))
        if apply(listener.text, [written, *timers]).split() == listener.text.split():
            return None
        edits = [*add_import(listener.text, wanted), *initialise_variables(listener, _AT_FIRST), written, *timers]
        if found := describe_edits_of(listener.file, edits):
            return found
    return _another(trace)


def _another(trace: Trace) -> str | None:
    """The step that gives the subscription another callback, with all that lasts in the node."""
    for call in source.calls(trace, "create_subscription"):
        file = source.file_holding(trace, call)
        given = [*call.args[2:3], *(each.value for each in call.keywords if each.arg == "callback")]
        text, function, made = file.text, file.function_around(call), file.statement(call)
        if not given or not isinstance(call.func, ast.Attribute) or function is None:
            continue
        node, name = ast.unparse(call.func.value), "on_message" if "on_message" not in text else "on_chatter"
        names = {role: f"{node}.{role}" for role in _AT_FIRST}
        wanted, now = monotonic_clock(text)
        code = _CODE.format(content="message.data", clock=now, logger=f"{node}.get_logger()", every=EVERY, **names)
        method = f"def {name}({'self, ' if node == 'self' else ''}message):\n{textwrap.indent(code, '    ')}"
        starts = "\n".join(f"{names[role]} = {value}" for role, value in _AT_FIRST.items())
        if node == "self":
            edits = [insert_above(made.lineno, starts), insert_after(function, f"\n{method}")]
        else:
            edits = [insert_above(made.lineno, f"{starts}\n\n{method}\n")]
        others = [each for each in file.calls("create_subscription") if each is not call]
        edits += [remove_statement(text, file.statement(each)) for each in others]
        callback = f"self.{name}" if node == "self" else name
        edits += [*add_import(text, wanted), replace_node(text, given[0], callback)]
        if name not in text and (found := describe_edits_of(file, edits)):
            return found
    return None


def _without_timers(listener: Listener) -> Iterator[Edit]:
    """Takes out the timers that log, with what they call: the callback does so."""
    functions = {each.name: each for each in listener.file.functions}
    for call in listener.file.calls("create_timer"):
        names = [last_name(node) for each in call.args[1:2] for node in ast.walk(each)]
        name = next((each for each in names if each in functions), "")
        if not name or functions[name] in listener.reached:
            continue
        inside = [node for each in listener.file.reached(functions[name]) for node in ast.walk(each)]
        if any(isinstance(each, ast.Call) and source.called_name(each) == "get_logger" for each in inside):
            yield remove_statement(listener.text, listener.file.statement(call))
            if len(re.findall(rf"\b{name}\b", listener.text)) == 2:
                yield remove_statement(listener.text, functions[name])


def monotonic_clock(text: str) -> tuple[str, str]:
    """The import of a clock that never goes back, and its call, as they go with the imports that the file has."""
    if re.search(r"^from time import", text, re.MULTILINE):
        return "from time import monotonic", "monotonic()"
    return "import time", "time.monotonic()"


def declare_variables(listener: Listener, names: Iterable[str], code: str) -> str:
    """The code, after a line that says of which function these variables are, where they are none of an object."""
    if listener.owner is not None:
        return code
    return f"{'nonlocal' if listener.outer else 'global'} {', '.join(names)}\n{code}"


def prepend_to_callback(listener: Listener, names: Iterable[str], code: str) -> Edit:
    """What the callback does before all else with each message; `names`: the variables that last."""
    return prepend_to_function(listener.function, declare_variables(listener, names, code))


def replace_body(listener: Listener, code: str) -> Edit:
    """All that the callback does, but for what documents it, becomes this code."""
    function = listener.function
    text = function.body[0]
    documented = isinstance(text, ast.Expr) and isinstance(text.value, ast.Constant)
    rest = function.body[documented:]
    if not rest:
        return insert_after(text, code)
    return replace_lines(rest[0].lineno, code, rest[-1].end_lineno or 0)


def initialise_variables(listener: Listener, roles: Mapping[str, str]) -> Iterator[Edit]:
    """What these variables are before the first message, as far as the file does not say so already."""
    missing = []
    for role, value in roles.items():
        name = listener.name(role)
        places = [each for each in _settings(listener) if _sets(each, name)]
        if not places:
            missing.append(f"{name} = {value}")
        for each in places if role in (COUNT, NUMBER) else ():
            if isinstance(each.value, ast.Constant | ast.UnaryOp) and ast.unparse(each.value) != value:
                yield replace_node(listener.text, each.value, value)
    if missing:
        yield set_first_value(listener, missing)


def set_first_value(listener: Listener, lines: Sequence[str]) -> Edit:
    """Where variables that last are given their first value."""
    if listener.owner is None:
        return insert_above(first_line(listener.function), "\n".join(lines))
    for node in listener.owner.body:
        if isinstance(node, ast.FunctionDef) and node.name == "__init__":
            made = next((each for each in node.body if listener.created in ast.walk(each)), node.body[-1])
            return insert_above(made.lineno, "\n".join(lines))
    first = listener.owner.body[0]
    return insert_above(first.lineno, "\n".join(line.removeprefix("self.") for line in lines))


def _settings(listener: Listener) -> Iterator[ast.Assign | ast.AnnAssign]:
    """The assignments that are no part of what is done with a message."""
    inside = {each for function in listener.reached for each in ast.walk(function)}
    tree: Sequence[ast.AST] = listener.file.nodes
    if listener.owner is None:
        scope = listener.outer or tree[0]
        tree = scope.body if isinstance(scope, ast.Module | ast.FunctionDef | ast.AsyncFunctionDef) else []
    for node in tree:
        if isinstance(node, ast.Assign | ast.AnnAssign) and node.value is not None and node not in inside:
            yield node


def _sets(node: ast.Assign | ast.AnnAssign, name: str) -> bool:
    """Whether it sets this variable: written so, or, of one that an object in self has, by its own name."""
    targets = node.targets if isinstance(node, ast.Assign) else [node.target]
    written = {ast.unparse(each) for target in targets for each in getattr(target, "elts", [target])}
    return name in written or (name.count(".") > 1 and name.rpartition(".")[2] in written)
