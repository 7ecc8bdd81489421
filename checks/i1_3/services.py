"""I1.3: steps that make a service compute its own result, whatever its callback does now."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from checks.i1_3.code import Code, learner_files
from checks.i1_3.facts import OPERATOR_SIGNS
from tutor.judge import edits, source, syntax_tree
from tutor.judge.edits import Edit
from tutor.judge.rewriting.node import argument, with_body
from tutor.judge.source import Function, last_name
from tutor.judge.trace import Trace

OPERATORS = {**OPERATOR_SIGNS, "/divide": "//"}

_COMMON_NAMES = "calculate", "answer_request"
"""Names for a common callback: the first one that the learner does not use."""


@dataclass(frozen=True)
class Offer:
    """The create_service call that offers a service. `alone`: this call offers no other one, as in a loop."""

    code: Code
    call: ast.Call
    alone: bool

    @property
    def callback(self) -> ast.expr | None:
        return argument(self.call, 2, "callback")


@dataclass
class Changes:
    """Changes to one file: expressions to replace (`swaps`), and other edits (`more`)."""

    code: Code
    swaps: list[tuple[ast.expr, str]] = field(default_factory=list)
    more: list[Edit] = field(default_factory=list)

    def as_step(self) -> str | None:
        swapped = edits.replace_nodes(self.code.text, *dict.fromkeys(self.swaps))
        return self.code.as_step(list(dict.fromkeys(self.more)), swapped)


def find_offer(trace: Trace, service: str) -> Offer | None:
    """Find the create_service call that offers a service, by its literal name or else the first with a computed one."""
    made = [(code, call) for code in learner_files(trace) for call in code.calls("create_service")]
    for code, call in made:
        if _means_service(argument(call, 1, "srv_name"), service):
            return Offer(code, call, True)
    computed = [each for each in made if not isinstance(argument(each[1], 1, "srv_name"), ast.Constant)]
    return Offer(*computed[0], False) if computed else None


def find_callback(trace: Trace, service: str) -> tuple[Code, Function] | None:
    """Find the function that answers this service and no other."""
    offer = find_offer(trace, service)
    if offer is None or offer.callback is None:
        return None
    code, expression = offer.code, offer.callback
    if isinstance(expression, ast.Call) and source.called_name(expression) == "getattr":
        found = code.functions_named(service[1:])
    elif offer.alone:
        name = last_name(expression)
        uses = [call for call in code.calls("create_service") if last_name(argument(call, 2, "callback")) == name]
        found = code.functions_named(name) if len(uses) == 1 or is_named_after(name, service) else []
    else:
        found = [each for each in code.functions if is_named_after(each.name, service) and any(_sum_assignments(each))]
    found = [each for each in found if len(argument_names(code, each)) >= 2]
    return (code, found[0]) if len(found) == 1 else None


def compute_results(
    trace: Trace, wrong: Sequence[str], *, whole: bool = False, change: Changes | None = None
) -> str | None:
    """Step: make services compute their own results.

    `whole`: replace the whole body of a callback, not just the line with the result. `change`: further changes that
    belong to the same step.
    """
    changes = {change.code.file: change} if change is not None else {}
    for service in wrong:
        offer = find_offer(trace, service)
        if offer is None:
            return None
        change = changes.setdefault(offer.code.file, Changes(offer.code))
        if not whole and (swap := _swap_callback(offer, service)) is not None:
            change.swaps.append(swap)
        elif (found := find_callback(trace, service)) is not None:
            line = None if whole else _replace_result_line(*found, service)
            change.more.append(line or with_body(found[1], "\n".join(callback_body(*found, service))))
        else:
            _replace_callback(change, offer, service)
    steps = [change.as_step() for change in changes.values()]
    return "\n".join(step for step in steps if step) or None


def sharing_callback(trace: Trace, service: str) -> list[str]:
    """The services that are answered by the same function as this one, itself included."""

    def function_of(name: str) -> Function | None:
        offer = find_offer(trace, name)
        return offer.code.function(offer.callback) if offer is not None and offer.callback is not None else None

    function = function_of(service)
    return [name for name in OPERATORS if name == service or (function is not None and function_of(name) is function)]


def guard_division(trace: Trace) -> str | None:
    """Step: let /divide check for zero first, log an error and answer."""
    found = find_callback(trace, "/divide")
    if found is None:
        return compute_results(trace, ["/divide"], whole=True)
    code, function = found
    guard = callback_body(code, function, "/divide")[:4]
    first = function.body[1:] if ast.get_docstring(function) is not None and function.body[1:] else function.body
    is_guarded = isinstance(first[0], ast.If) and f"if {ast.unparse(first[0].test)}:" == guard[0]
    if is_guarded or isinstance(function, ast.AsyncFunctionDef) or function.decorator_list:
        return compute_results(trace, ["/divide"], whole=True)
    return code.as_step(edits.insert_above(first[0].lineno, "\n".join(guard))) or compute_results(
        trace, ["/divide"], whole=True
    )


def callback_body(code: Code, function: Function, service: str) -> list[str]:
    """The right body for this callback of a service, with the callback's own argument names."""
    request, response = argument_names(code, function)[:2]
    return body_lines(request, response, service, logger_of(code, function.body[0]))


def body_lines(request: str, response: str, service: str, log: str) -> list[str]:
    """The right body for the callback of a service, given the names of its arguments and its logger."""
    result = f"{response}.sum = {request}.a {OPERATORS[service]} {request}.b"
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
    """The expression for the node's logger at this place in the code: in a class that is no node, one that it keeps."""
    if code.self_name(at) and code.node_method(at) is None:
        around = next((each for each in code.ancestors(at) if isinstance(each, ast.ClassDef)), None)
        for each in ast.walk(around) if around is not None else ():
            match each:
                case ast.Assign(
                    targets=[ast.Attribute() as kept], value=ast.Call(func=ast.Attribute(attr="get_logger"))
                ):
                    return ast.unparse(kept)
    return f"{code.node_name(at)}.get_logger()"


def new_callback(code: Code, at: ast.AST, service: str) -> tuple[str, Edit]:
    """Write a new callback for a service offered at this place: the expression that refers to it, and the edit."""
    name = next(
        each for each in (f"{service[1:]}_callback", f"answer_{service[1:]}", "") if not code.functions_named(each)
    )
    self_name = code.self_name(at)
    head = f"def {name}({f'{self_name}, ' if self_name else ''}request, response):"
    body = body_lines("request", "response", service, logger_of(code, at))
    return _add_function(code, at, [head, *(f"    {each}" for each in body)])


def _add_function(code: Code, at: ast.AST, lines: Sequence[str]) -> tuple[str, Edit]:
    """Add a function, or a method if this place is in one: the expression that refers to it here, and the edit."""
    self_name, name = code.self_name(at), lines[0][4:].partition("(")[0]
    above: ast.stmt = code.outermost_statement(at)
    if self_name:
        above = [each for each in code.ancestors(at) if isinstance(each, Function)][-1]
    first_line = min([above.lineno, *(each.lineno for each in getattr(above, "decorator_list", []))])
    edit = edits.insert_above(first_line, "\n".join([*lines, "", ""]))
    return (f"{self_name}.{name}" if self_name else name), edit


def _replace_callback(change: Changes, offer: Offer, service: str) -> None:
    """Give a service a new callback; if one call offers several services, give all of them a common one."""
    code, call = offer.code, offer.call
    assert offer.callback is not None
    if offer.alone:
        name, edit = new_callback(code, call, service)
        change.swaps.append((offer.callback, name))
    else:
        srv_name = argument(call, 1, "srv_name")
        assert srv_name is not None
        self_name = code.self_name(call)
        for candidate in _COMMON_NAMES:
            lines = _common_callback(candidate, self_name)
            written = ast.unparse(syntax_tree.parse("\n".join(lines)))
            if any(ast.unparse(each) == written for each in code.functions_named(candidate)):
                return  # the file has it already, so the fault must be elsewhere
            if not code.functions_named(candidate):
                break
        name, edit = _add_function(code, call, lines)
        more = "" if self_name else f", {logger_of(code, call)}"
        binding = f"name={ast.unparse(srv_name)}"
        change.swaps.append(
            (offer.callback, f"lambda request, response, {binding}: {name}(name, request, response{more})")
        )
    change.more.append(edit)


def _common_callback(name: str, self_name: str) -> list[str]:
    """The lines of one callback for all four services; a method if `self_name` is not empty."""
    log = f"{self_name}.get_logger()" if self_name else "logger"
    parameters = f"{self_name}, name, request, response" if self_name else "name, request, response, logger"
    return [
        f"def {name}({parameters}):",
        "    a, b = request.a, request.b",
        "    if name.endswith('divide') and b == 0:",
        f"        {log}.error('division by zero')",
        "        response.sum = 0",
        "        return response",
        "    results = {'add': a + b, 'subtract': a - b, 'multiply': a * b, 'divide': a // (b or 1)}",
        "    response.sum = results[name.rpartition('/')[2]]",
        "    return response",
    ]


def _swap_callback(offer: Offer, service: str) -> tuple[ast.expr, str] | None:
    """If a service was given another one's callback, return that and the callback named after this service."""
    callback = offer.callback
    if (
        not offer.alone
        or not isinstance(callback, ast.Attribute | ast.Name)
        or is_named_after(last_name(callback), service)
    ):
        return None
    found = [
        each for each in offer.code.functions if is_named_after(each.name, service) and any(_sum_assignments(each))
    ]
    if len(found) != 1 or not offer.code.functions_named(last_name(callback)):
        return None
    name = found[0].name
    return callback, f"{ast.unparse(callback.value)}.{name}" if isinstance(callback, ast.Attribute) else name


def _replace_result_line(code: Code, function: Function, service: str) -> Edit | None:
    """Correct the line of a callback that sets the result, if there is exactly one."""
    found = [each for each in _sum_assignments(function) if not isinstance(getattr(each, "value", None), ast.Constant)]
    if len(found) != 1 or not isinstance(found[0], ast.Assign) or len(found[0].targets) != 1:
        return None
    request = argument_names(code, function)[0]
    read = {ast.unparse(each) for each in ast.walk(found[0].value) if isinstance(each, ast.Attribute | ast.Name)}
    a, b = (next((each for each in (f"{request}.{x}", x) if each in read), "") for x in "ab")
    if not (a and b) or any(isinstance(each, ast.IfExp) for each in ast.walk(found[0].value)):
        return None
    new = f"{ast.unparse(found[0].targets[0])} = {a} {OPERATORS[service]} {b}"
    return None if new == ast.unparse(found[0]) else edits.replace_statement(found[0], new)


def is_named_after(function: str, service: str) -> bool:
    """Whether a function is named after this service, and not after another one as well."""
    return [each for each in OPERATOR_SIGNS if each[1:4] in function.casefold()] == [service]


def _sum_assignments(function: Function) -> Iterator[ast.stmt]:
    """The statements that assign to an attribute `sum`."""
    for each in ast.walk(function):
        targets = each.targets if isinstance(each, ast.Assign) else []
        if isinstance(each, ast.AugAssign | ast.AnnAssign):
            targets = [each.target]
        if isinstance(each, ast.stmt) and any(isinstance(one, ast.Attribute) and one.attr == "sum" for one in targets):
            yield each


def argument_names(code: Code, function: Function) -> list[str]:
    """The names of a callback's parameters, without `self`."""
    names = [each.arg for each in (*function.args.posonlyargs, *function.args.args)]
    return names[1:] if isinstance(next(code.ancestors(function), None), ast.ClassDef) else names


def _means_service(name: ast.expr | None, service: str) -> bool:
    return isinstance(name, ast.Constant) and f"/{str(name.value).rpartition('/')[2]}" == service
