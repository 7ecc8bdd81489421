"""I1.2: the step that makes of a learner's callback one that does all that is asked for, in the file's own names."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Mapping, Sequence

from checks.i1_2.facts import EVERY
from checks.i1_2.listener import COUNT, FIRST, LAST, NUMBER, START, Listener, find
from tutor.judge import source
from tutor.judge.edits import Edit, above, becomes, below, instead, on_top, told
from tutor.judge.trace import Trace

_AT_FIRST = {COUNT: "0", FIRST: "''", LAST: "''", START: "0.0", NUMBER: "None"}
_CODE = """\
if {total_count} == 0:
    {first_message} = {message}.data
    {start_time} = time.monotonic()
{total_count} += 1
{last_message} = {message}.data
number = int({message}.data.rpartition(':')[2])
if {last_number} is not None and number > {last_number} + 1:
    {logger}.warning(f'{{number - {last_number} - 1}} messages are missing before {{number}}')
{last_number} = number
if {total_count} % {every} == 0:
    rate = ({total_count} - 1) / (time.monotonic() - {start_time})
    {logger}.info(f'{{{total_count}}} messages, {{rate:.2f}} per second')
    {logger}.info(f'first: {{{first_message}}}, last: {{{last_message}}}')"""


def whole(trace: Trace) -> str | None:
    """The step that writes the callback anew; None where there is none that can be written so."""
    listener = find(trace)
    if listener is None or not listener.message:
        return None
    names = {role: listener.name(role) for role in _AT_FIRST}
    code = _CODE.format(message=listener.message, logger=listener.logger, every=EVERY, **names)
    code = declared(listener, names.values(), code)
    edits = [
        *on_top(listener.text, "import time"),
        *started(listener, _AT_FIRST),
        body(listener, code),
    ]
    return step(trace, listener, edits)


def step(trace: Trace, listener: Listener, edits: Sequence[Edit]) -> str | None:
    """The edits in words, with the file where there is more than one."""
    return told(listener.text, edits, file=listener.file if len(trace.sources) > 1 else "")


def declared(listener: Listener, names: Iterable[str], code: str) -> str:
    """The code, after a line that says of which function these variables are, where they are none of an object."""
    if listener.owner is not None:
        return code
    return f"{'nonlocal' if listener.outer else 'global'} {', '.join(names)}\n{code}"


def on_entry(listener: Listener, names: Iterable[str], code: str) -> Edit:
    """What the callback does before all else with each message; `names`: the variables that last."""
    documented = isinstance(listener.function.body[0], ast.Expr) and len(listener.function.body) > 1
    return above(listener.function.body[documented].lineno, declared(listener, names, code))


def body(listener: Listener, code: str) -> Edit:
    """All that the callback does, but for what documents it, becomes this code."""
    function = listener.function
    text = function.body[0]
    documented = isinstance(text, ast.Expr) and isinstance(text.value, ast.Constant)
    rest = function.body[documented:]
    if not rest:
        return below(text.end_lineno or text.lineno, code, like=text.lineno)
    return becomes(rest[0].lineno, code, rest[-1].end_lineno or 0)


def started(listener: Listener, roles: Mapping[str, str]) -> Iterator[Edit]:
    """What these variables are before the first message, as far as the file does not say so already."""
    missing = []
    for role, value in roles.items():
        name = listener.name(role)
        places = [each for each in _settings(listener) if _sets(each, name)]
        if not places:
            missing.append(f"{name} = {value}")
        for each in places if role in (COUNT, NUMBER) else ():
            if isinstance(each.value, ast.Constant | ast.UnaryOp) and ast.unparse(each.value) != value:
                yield instead(listener.text, each.value, value)
    if missing:
        yield first_value(listener, missing)


def first_value(listener: Listener, lines: Sequence[str]) -> Edit:
    """Where variables that last are given their first value."""
    if listener.owner is None:
        return above(
            min(each.lineno for each in (listener.function, *listener.function.decorator_list)), "\n".join(lines)
        )
    for node in listener.owner.body:
        if isinstance(node, ast.FunctionDef) and node.name == "__init__":
            made = next((each for each in node.body if listener.created in ast.walk(each)), node.body[-1])
            return above(made.lineno, "\n".join(lines))
    first = listener.owner.body[0]
    return above(first.lineno, "\n".join(line.removeprefix("self.") for line in lines))


def _settings(listener: Listener) -> Iterator[ast.Assign | ast.AnnAssign]:
    """The assignments that are no part of what is done with a message."""
    inside = {each for function in listener.reached for each in ast.walk(function)}
    tree: Sequence[ast.AST] = source.tree(listener.text)
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
