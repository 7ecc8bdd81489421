"""I1.3: edits of the server's code that make a service compute its own, whatever its callback does."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from checks.i1_3.code import Code, learner_files
from checks.i1_3.facts import SIGNS
from tutor.judge import edits, source
from tutor.judge.edits import Edit
from tutor.judge.rewriting.node import argument, with_body
from tutor.judge.source import Function, last_name
from tutor.judge.trace import Trace

PYTHON = {**SIGNS, "/divide": "//"}


@dataclass(frozen=True)
class Offer:
    """A call of create_service in which a service is offered; `alone`: no other one is offered there."""

    code: Code
    call: ast.Call
    alone: bool

    @property
    def callback(self) -> ast.expr | None:
        return argument(self.call, 2, "callback")


@dataclass
class Changes:
    """What is to be changed in one file: expressions swapped, and other edits."""

    code: Code
    swaps: list[tuple[ast.expr, str]] = field(default_factory=list)
    more: list[Edit] = field(default_factory=list)

    def as_step(self) -> str | None:
        swapped = edits.replace_nodes(self.code.text, *dict.fromkeys(self.swaps))
        return self.code.as_step(list(dict.fromkeys(self.more)), swapped)


def find_offer(trace: Trace, service: str) -> Offer | None:
    """Where the service is offered."""
    made = [(code, call) for code in learner_files(trace) for call in code.calls("create_service")]
    for code, call in made:
        if _means_service(argument(call, 1, "srv_name"), service):
            return Offer(code, call, True)
    loose = [each for each in made if not isinstance(argument(each[1], 1, "srv_name"), ast.Constant)]
    return Offer(*loose[0], False) if loose else None


def find_callback(trace: Trace, service: str) -> tuple[Code, Function] | None:
    """The function that answers this service and no other one."""
    there = find_offer(trace, service)
    if there is None or there.callback is None:
        return None
    code, expression = there.code, there.callback
    if isinstance(expression, ast.Call) and source.called_name(expression) == "getattr":
        found = code.named(service[1:])
    elif there.alone:
        name = last_name(expression)
        uses = [call for call in code.calls("create_service") if last_name(argument(call, 2, "callback")) == name]
        found = code.named(name) if len(uses) == 1 or is_named_after(name, service) else []
    else:
        found = [each for each in code.functions if is_named_after(each.name, service) and any(_sums(each))]
    found = [each for each in found if len(argument_names(code, each)) >= 2]
    return (code, found[0]) if len(found) == 1 else None


def compute_results(
    trace: Trace, wrong: Sequence[str], *, whole: bool = False, change: Changes | None = None
) -> str | None:
    """The step that makes services compute their own; `whole`: not only the line with the result.

    `change`: what else is to be changed.
    """
    changes = {change.code.file: change} if change is not None else {}
    for service in wrong:
        there = find_offer(trace, service)
        if there is None:
            return None
        change = changes.setdefault(there.code.file, Changes(there.code))
        if not whole and (other := _other(trace, there, service)) is not None:
            change.swaps.append(other)
        elif (found := find_callback(trace, service)) is not None:
            line = None if whole else _line(*found, service)
            change.more.append(line or with_body(found[1], "\n".join(lines_of(*found, service))))
        else:
            _anew(change, there, service)
    steps = [change.as_step() for change in changes.values()]
    return "\n".join(step for step in steps if step) or None


def guard_division(trace: Trace) -> str | None:
    """The step that lets /divide answer, and log an error, before it does anything else."""
    found = find_callback(trace, "/divide")
    if found is None:
        return compute_results(trace, ["/divide"], whole=True)
    code, function = found
    guard = lines_of(code, function, "/divide")[:4]
    first = function.body[1:] if ast.get_docstring(function) is not None and function.body[1:] else function.body
    has = isinstance(first[0], ast.If) and f"if {ast.unparse(first[0].test)}:" == guard[0]
    if has or isinstance(function, ast.AsyncFunctionDef) or function.decorator_list:
        return compute_results(trace, ["/divide"], whole=True)
    return code.as_step(edits.insert_above(first[0].lineno, "\n".join(guard))) or compute_results(
        trace, ["/divide"], whole=True
    )


def lines_of(code: Code, function: Function, service: str) -> list[str]:
    """What the callback of a service does, in the words of this one."""
    request, response = argument_names(code, function)[:2]
    return lines_for(request, response, service, logger_of(code, function.body[0]))


def lines_for(request: str, response: str, service: str, log: str) -> list[str]:
    """What the callback of a service does, its arguments and the logger being called so."""
    result = f"{response}.sum = {request}.a {PYTHON[service]} {request}.b"
    if service != "/divide":
        return [result, f"return {response}"]
    return [
        f"if {request}.b == 0:",
        f"    {log}.error('division by zero')",
        f"    {response}.sum = 0",
        f"    return {response}",
        result,
        f"return {response}",
    ]


def logger_of(code: Code, at: ast.AST) -> str:
    """How code at this place gets at the node's logger."""
    return f"{code.node(at)}.get_logger()"


def new_callback(code: Code, at: ast.AST, service: str) -> tuple[str, Edit]:
    """A new callback for a service that is offered at this place: what to call it there, and the edit that adds it."""
    name = next(each for each in (f"{service[1:]}_callback", f"answer_{service[1:]}", "") if not code.named(each))
    me = code.self_name(at)
    head = f"def {name}({f'{me}, ' if me else ''}request, response):"
    log = f"{code.node(at)}.get_logger()"
    return _added(code, at, [head, *(f"    {each}" for each in lines_for("request", "response", service, log))])


def _added(code: Code, at: ast.AST, lines: Sequence[str]) -> tuple[str, Edit]:
    """A new function, a method where this place is in one: what it is called from here, and the edit."""
    me, name = code.self_name(at), lines[0][4:].partition("(")[0]
    above: ast.stmt = code.outermost(at)
    if me:
        above = [each for each in code.ancestors(at) if isinstance(each, Function)][-1]
    top = min([above.lineno, *(each.lineno for each in getattr(above, "decorator_list", []))])
    return (f"{me}.{name}" if me else name), edits.insert_above(top, "\n".join([*lines, "", ""]))


def _anew(change: Changes, there: Offer, service: str) -> None:
    """A new callback in place of the one that a service has; where several are offered, one for all of them."""
    code, call = there.code, there.call
    assert there.callback is not None
    if there.alone:
        name, edit = new_callback(code, call, service)
        change.swaps.append((there.callback, name))
    else:
        offered = argument(call, 1, "srv_name")
        assert offered is not None
        me = code.self_name(call)
        lines = _for_all(me)
        if any(ast.unparse(each) == ast.unparse(ast.parse("\n".join(lines))) for each in code.named("calculate")):
            return  # it is there already, and is not what the fault is about
        name, edit = _added(code, call, lines)
        more = "" if me else f", {logger_of(code, call)}"
        to_bind = f"name={ast.unparse(offered)}"
        change.swaps.append(
            (there.callback, f"lambda request, response, {to_bind}: {name}(name, request, response{more})")
        )
    change.more.append(edit)


def _for_all(me: str) -> list[str]:
    log = f"{me}.get_logger()" if me else "logger"
    return [
        f"def calculate({f'{me}, ' if me else ''}name, request, response{'' if me else ', logger'}):",
        "    a, b = request.a, request.b",
        "    if name.endswith('divide') and b == 0:",
        f"        {log}.error('division by zero')",
        "        response.sum = 0",
        "        return response",
        "    results = {'add': a + b, 'subtract': a - b, 'multiply': a * b, 'divide': a // (b or 1)}",
        "    response.sum = results[name.rpartition('/')[2]]",
        "    return response",
    ]


def _other(trace: Trace, there: Offer, service: str) -> tuple[ast.expr, str] | None:
    """The callback that is named after this service, where it was given another one."""
    given_one = there.callback
    if (
        not there.alone
        or not isinstance(given_one, ast.Attribute | ast.Name)
        or is_named_after(last_name(given_one), service)
    ):
        return None
    found = [each for each in there.code.functions if is_named_after(each.name, service) and any(_sums(each))]
    if len(found) != 1 or not there.code.named(last_name(given_one)):
        return None
    name = found[0].name
    return given_one, f"{ast.unparse(given_one.value)}.{name}" if isinstance(given_one, ast.Attribute) else name


def _line(code: Code, function: Function, service: str) -> Edit | None:
    """The one line of a callback with its result, where there is just one."""
    found = [each for each in _sums(function) if not isinstance(getattr(each, "value", None), ast.Constant)]
    if len(found) != 1 or not isinstance(found[0], ast.Assign) or len(found[0].targets) != 1:
        return None
    request = argument_names(code, function)[0]
    read = {ast.unparse(each) for each in ast.walk(found[0].value) if isinstance(each, ast.Attribute | ast.Name)}
    a, b = (next((each for each in (f"{request}.{x}", x) if each in read), "") for x in "ab")
    if not (a and b) or any(isinstance(each, ast.IfExp) for each in ast.walk(found[0].value)):
        return None
    new = f"{ast.unparse(found[0].targets[0])} = {a} {PYTHON[service]} {b}"
    return None if new == ast.unparse(found[0]) else edits.replace_statement(found[0], new)


def is_named_after(function: str, service: str) -> bool:
    """Whether a function is named after this service, and not after another as well."""
    called = [each for each in SIGNS if each[1:4] in function.casefold()]
    return called == [service]


def _sums(function: Function) -> Iterator[ast.stmt]:
    """The statements that set a field `sum`."""
    for each in ast.walk(function):
        targets = each.targets if isinstance(each, ast.Assign) else []
        if isinstance(each, ast.AugAssign | ast.AnnAssign):
            targets = [each.target]
        if isinstance(each, ast.stmt) and any(isinstance(one, ast.Attribute) and one.attr == "sum" for one in targets):
            yield each


def argument_names(code: Code, function: Function) -> list[str]:
    """The names of a callback's arguments, without self."""
    names = [each.arg for each in (*function.args.posonlyargs, *function.args.args)]
    return names[1:] if isinstance(next(code.ancestors(function), None), ast.ClassDef) else names


def _means_service(name: ast.expr | None, service: str) -> bool:
    return isinstance(name, ast.Constant) and f"/{str(name.value).rpartition('/')[2]}" == service
