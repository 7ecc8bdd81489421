"""I1.2: the step that rewrites a learner's callback to meet all requirements, with the file's own names."""

from __future__ import annotations

import ast
import re
import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence

from checks.i1_2.facts import SUMMARY_EVERY
from checks.i1_2.listener import COUNT, FIRST, LAST, LEVELS, NUMBER, START, Listener, find_listener
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
    replace_statement,
)
from tutor.judge.rewriting.node import first_line
from tutor.judge.source import last_name
from tutor.judge.trace import Trace

_INITIAL_VALUES = {COUNT: "0", FIRST: "''", LAST: "''", START: "0.0", NUMBER: "None"}
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
    """The step that rewrites the callback; None if that is not possible."""
    listener = find_listener(trace)
    if listener is not None and listener.message and listener.logger:
        names = {role: listener.name(role) for role in _INITIAL_VALUES}
        wanted, now = monotonic_clock(listener.text)
        code = _CODE.format(content=listener.content, clock=now, logger=listener.logger, every=SUMMARY_EVERY, **names)
        written = replace_body(listener, declare_variables(listener, names.values(), code))
        others = [*_remove_timers(listener), *_spin_in_place_of_logging(listener)]
        if apply(listener.text, [written, *others]).split() == listener.text.split():
            return None
        edits = [*add_import(listener.text, wanted), *initialise_variables(listener, _INITIAL_VALUES), written, *others]
        if found := describe_edits_of(listener.file, edits):
            return found
    return _new_callback(trace)


def _new_callback(trace: Trace) -> str | None:
    """The step that gives the subscription a new callback, with all state in attributes of the node."""
    for call in source.calls(trace, "create_subscription"):
        file = source.file_holding(trace, call)
        given = [*call.args[2:3], *(each.value for each in call.keywords if each.arg == "callback")]
        text, function, made = file.text, file.function_around(call), file.statement(call)
        if not given or not isinstance(call.func, ast.Attribute) or function is None:
            continue
        node, name = ast.unparse(call.func.value), "on_message" if "on_message" not in text else "on_chatter"
        names = {role: f"{node}.{role}" for role in _INITIAL_VALUES}
        wanted, now = monotonic_clock(text)
        code = _CODE.format(
            content="message.data", clock=now, logger=f"{node}.get_logger()", every=SUMMARY_EVERY, **names
        )
        method = f"def {name}({'self, ' if node == 'self' else ''}message):\n{textwrap.indent(code, '    ')}"
        starts = "\n".join(f"{names[role]} = {value}" for role, value in _INITIAL_VALUES.items())
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


def _remove_timers(listener: Listener) -> Iterator[Edit]:
    """Remove timers that log, and their callbacks: the subscription's callback logs instead."""
    functions = {each.name: each for each in listener.file.functions}
    replaced = list(ast.walk(listener.function))
    for call in listener.file.calls("create_timer"):
        names = [last_name(node) for each in call.args[1:2] for node in ast.walk(each)]
        name = next((each for each in names if each in functions), "")
        if not name or functions[name] in listener.reached:
            continue
        inside = [node for each in listener.file.reachable_from(functions[name]) for node in ast.walk(each)]
        if any(isinstance(each, ast.Call) and source.called_name(each) == "get_logger" for each in inside):
            if call not in replaced:
                yield remove_statement(listener.text, listener.file.statement(call))
            if len(re.findall(rf"\b{name}\b", listener.text)) == 2:
                yield remove_statement(listener.text, functions[name])


def _spin_in_place_of_logging(listener: Listener) -> Iterator[Edit]:
    """Replace loops that spin the node and log in between: the subscription's callback logs instead."""
    for loop in (each for each in listener.file.nodes if isinstance(each, ast.While)):
        for spin in source.calls_in(loop, "spin_once"):
            logs = any(isinstance(each, ast.Attribute) and each.attr in LEVELS for each in ast.walk(loop))
            if logs and spin.args and isinstance(spin.func, ast.Attribute):
                yield replace_statement(loop, f"{ast.unparse(spin.func.value)}.spin({ast.unparse(spin.args[0])})")
                break


def monotonic_clock(text: str) -> tuple[str, str]:
    """The import and the call of a monotonic clock, in the style of the file's imports."""
    if re.search(r"^from time import", text, re.MULTILINE):
        return "from time import monotonic", "monotonic()"
    return "import time", "time.monotonic()"


def declare_variables(listener: Listener, names: Iterable[str], code: str) -> str:
    """The code, with a `global` or `nonlocal` statement in front unless the variables are attributes."""
    if listener.owner is not None:
        return code
    return f"{'nonlocal' if listener.outer else 'global'} {', '.join(names)}\n{code}"


def prepend_to_callback(listener: Listener, names: Iterable[str], code: str) -> Edit:
    """Insert code at the beginning of the callback. `names`: the persistent variables that it sets."""
    return prepend_to_function(listener.function, declare_variables(listener, names, code))


def replace_body(listener: Listener, code: str) -> Edit:
    """Replace the body of the callback, except its docstring."""
    function = listener.function
    text = function.body[0]
    documented = isinstance(text, ast.Expr) and isinstance(text.value, ast.Constant)
    rest = function.body[documented:]
    if not rest:
        return insert_after(text, code)
    return replace_lines(rest[0].lineno, code, rest[-1].end_lineno or 0)


def initialise_variables(listener: Listener, roles: Mapping[str, str]) -> Iterator[Edit]:
    """Initialise the variables of these roles, unless the file does so already."""
    missing = []
    for role, value in roles.items():
        name = listener.name(role)
        places = [
            each
            for each in _outside_assignments(listener)
            if _assigns_to(each, name) and (name.count(".") != 1 or _is_of_owner(listener, each))
        ]
        if not places:
            missing.append(f"{name} = {value}")
        for each in places if role in (COUNT, NUMBER) else ():
            if isinstance(each.value, ast.Constant | ast.UnaryOp) and ast.unparse(each.value) != value:
                yield replace_node(listener.text, each.value, value)
    if missing:
        yield set_first_value(listener, missing)


def set_first_value(listener: Listener, lines: Sequence[str]) -> Edit:
    """Insert lines that initialise persistent variables."""
    if listener.owner is None:
        return insert_above(first_line(listener.function), "\n".join(lines))
    for node in listener.owner.body:
        if isinstance(node, ast.FunctionDef) and node.name == "__init__":
            made = next((each for each in node.body if listener.created in ast.walk(each)), node.body[-1])
            return insert_above(made.lineno, "\n".join(lines))
    first = listener.owner.body[0]
    return insert_above(first.lineno, "\n".join(line.removeprefix("self.") for line in lines))


def _outside_assignments(listener: Listener) -> Iterator[ast.Assign | ast.AnnAssign]:
    """The assignments outside the code that runs for a message."""
    inside = {each for function in listener.reached for each in ast.walk(function)}
    tree: Sequence[ast.AST] = listener.file.nodes
    if listener.owner is None:
        scope = listener.outer or tree[0]
        tree = scope.body if isinstance(scope, ast.Module | ast.FunctionDef | ast.AsyncFunctionDef) else []
    for node in tree:
        if isinstance(node, ast.Assign | ast.AnnAssign) and node.value is not None and node not in inside:
            yield node


def _is_of_owner(listener: Listener, node: ast.AST) -> bool:
    """Whether this is outside of all classes, in the listener's, or in one that it inherits from."""
    classes = {each.name: each for each in listener.file.nodes if isinstance(each, ast.ClassDef)}
    inherited = [listener.owner] if listener.owner is not None else []
    for each in inherited:
        inherited += [classes[name] for name in map(last_name, each.bases) if name in classes]
    around = next((each for each in listener.file.ancestors(node) if isinstance(each, ast.ClassDef)), None)
    return around is None or around in inherited


def _assigns_to(node: ast.Assign | ast.AnnAssign, name: str) -> bool:
    """Whether the assignment sets this variable; that of an object in self may also be set by its bare name."""
    targets = node.targets if isinstance(node, ast.Assign) else [node.target]
    written = {ast.unparse(each) for target in targets for each in getattr(target, "elts", [target])}
    return name in written or (name.count(".") > 1 and name.rpartition(".")[2] in written)
