"""I1.3: a division by zero that nothing is said of: where the server divides, and what to write there."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from tutor.judge import source
from tutor.judge.trace import Trace

_SAYS = "error('division by zero')"
_DIVIDING = ("floordiv", "truediv", "divmod", "floor_divide", "Fraction")

_Function = ast.FunctionDef | ast.AsyncFunctionDef


@dataclass(frozen=True)
class _Place:
    """A division: its file, and what is around it, from the inside out, each with the child that leads there."""

    file: str
    text: str
    node: ast.expr
    around: tuple[tuple[ast.AST, ast.AST], ...]

    @property
    def function(self) -> _Function | None:
        return next((each for each, _ in self.around if isinstance(each, _Function)), None)

    def code(self, number: int) -> str:
        return self.text.splitlines()[number - 1].strip()


def where_to_log(trace: Trace) -> str:
    """The next step for a server that answers a division by zero, and logs no error: line and code."""
    places = list(_divisions(trace))
    for find in (_in_handler, _in_test, _in_expression, _plain):
        for place in places:
            if (step := find(place, logger(trace, place.function))) is not None:
                return f"in {place.file}, {step}"
    for handler in source.handlers(trace):
        if handler.type is not None and "ZeroDivision" in ast.unparse(handler.type):
            function = source.function_at(trace, trace.file, handler.lineno)
            return f"in {trace.file}, {_above(handler.body[0], f'{logger(trace, function)}.{_SAYS}')}"
    return f"in the callback of /divide, where b is 0, before you return the response: self.get_logger().{_SAYS}"


def logger(trace: Trace, function: _Function | None) -> str:
    """How this function of the learner's gets at the node's logger."""
    arguments = [each.arg for each in function.args.args] if function is not None else []
    if arguments[:1] == ["self"]:
        return "self.get_logger()"
    if made := [name for name, _ in source.assigned(trace, "get_logger") if name and not name.startswith("self.")]:
        return made[0]
    nodes = [name for name, _ in source.assigned(trace, "create_node", "Node") if name and "." not in name]
    if nodes:
        return f"{nodes[0]}.get_logger()"
    return (
        "self.get_logger()" if function is None or not arguments or "self" in _free(function) else "node.get_logger()"
    )


def _free(function: _Function) -> set[str]:
    return {each.id for each in ast.walk(function) if isinstance(each, ast.Name)}


def _divisions(trace: Trace) -> Iterator[_Place]:
    for file, text in trace.sources.items():
        parent = {child: each for each in source.tree(text) for child in ast.iter_child_nodes(each)}
        for node in source.tree(text):
            divides = isinstance(node, ast.BinOp) and isinstance(node.op, ast.FloorDiv | ast.Div)
            if isinstance(node, ast.expr) and (
                divides or (isinstance(node, ast.Call) and source.called(node) in _DIVIDING)
            ):
                yield _Place(file, text, node, tuple(_outwards(node, parent)))


def _outwards(node: ast.AST, parent: Mapping[ast.AST, ast.AST]) -> Iterator[tuple[ast.AST, ast.AST]]:
    while node in parent:
        yield parent[node], node
        node = parent[node]


def _in_handler(place: _Place, log: str) -> str | None:
    """The division stands in a try: its except is the place."""
    for each, child in place.around:
        if isinstance(each, _Function | ast.Lambda):
            return None
        if isinstance(each, ast.Try) and child in each.body and each.handlers:
            handler, first = each.handlers[0], each.handlers[0].body[0]
            if first.lineno != handler.lineno:
                return _above(first, f"{log}.{_SAYS}")
            rest = "" if isinstance(first, ast.Pass) else f"; {'; '.join(map(ast.unparse, handler.body))}"
            head = place.code(handler.lineno).partition(":")[0]
            return f"line {handler.lineno} becomes: {head}: {log}.{_SAYS}{rest}"
    return None


def _above(first: ast.stmt, code: str) -> str:
    if isinstance(first, ast.Pass):
        return f"write in place of pass, line {first.lineno}: {code}"
    return f"write above line {first.lineno}, with the same indentation: {code}"


def _in_test(place: _Place, log: str) -> str | None:
    """An if around the division, or above it in the same function, asks for zero: its branch is the place."""
    within = {id(each): child for each, child in place.around}
    tests = [each for each in ast.walk(place.function or ast.Module([], [])) if isinstance(each, ast.If)]
    for test in tests:
        asked = _asks_zero(test.test)
        divides_below = within.get(id(test)) in test.body
        if asked is None or (not asked and id(test) not in within) or (asked and divides_below):
            continue
        branch = test.body if asked else test.orelse
        if not branch:
            code = f"else: {log}.{_SAYS}"
            return f"write below line {test.end_lineno}, indented as the if in line {test.lineno}: {code}"
        if branch[0].lineno != test.lineno:
            return _above(branch[0], f"{log}.{_SAYS}")
        head = place.code(test.lineno).partition(":")[0]
        return f"line {test.lineno} becomes: {head}: {log}.{_SAYS}; {'; '.join(map(ast.unparse, branch))}"
    return None


def _asks_zero(test: ast.expr) -> bool | None:
    """True where it holds for zero, False where it holds for anything else; None where it asks for neither."""
    match test:
        case ast.Compare(ops=[ast.Eq() | ast.NotEq() as how], left=left, comparators=[right]):
            zero = any(isinstance(each, ast.Constant) and each.value == 0 for each in (left, right))
            return isinstance(how, ast.Eq) if zero else None
        case ast.UnaryOp(op=ast.Not(), operand=ast.Name(id="b") | ast.Attribute(attr="b")):
            return True
        case ast.Name(id="b") | ast.Attribute(attr="b"):
            return False
    return None


def _in_expression(place: _Place, log: str) -> str | None:
    """The division is part of a lambda: a function of its own takes its place, since a lambda has no room for an if."""
    lambdas = [each for each, _ in place.around if isinstance(each, ast.Lambda)]
    calls = [each for each, _ in place.around if isinstance(each, ast.Call) and source.called(each) == "create_service"]
    if not lambdas or not calls or lambdas[0].lineno != lambdas[0].end_lineno or lambdas[0] not in calls[0].args:
        return None
    inner, function = lambdas[0], place.function
    line = place.text.splitlines()[inner.lineno - 1].encode()
    method = function is not None and log.startswith("self.")
    name = f"{'self.' if method else ''}divide_callback"
    becomes = (line[: inner.col_offset] + name.encode() + line[inner.end_col_offset :]).decode().strip()
    start = function.lineno if method and function is not None else calls[0].lineno
    body = (
        f"def divide_callback({'self, ' if method else ''}request, response):",
        "    if request.b == 0:",
        f"        {log}.{_SAYS}",
        "        response.sum = 0",
        "    else:",
        "        response.sum = request.a // request.b",
        "    return response",
    )
    return "\n".join((f"line {inner.lineno} becomes: {becomes}", f"and above line {start}, indented as it is:", *body))


def _plain(place: _Place, log: str) -> str | None:
    """Any other division in a statement: the test goes above it."""
    if any(isinstance(each, ast.Lambda) for each, _ in place.around) or place.function is None:
        return None
    statement = next(each for each in (child for _, child in place.around) if isinstance(each, ast.stmt))
    divisors = [each for each in ast.walk(statement) if isinstance(each, ast.Name | ast.Attribute)]
    by = next((each for each in divisors if (each.id if isinstance(each, ast.Name) else each.attr) == "b"), None)
    if by is None and isinstance(place.node, ast.BinOp):
        by = place.node.right if isinstance(place.node.right, ast.Name | ast.Attribute) else None
    if by is None:
        return None
    return f"write above line {statement.lineno}, with the same indentation: if {ast.unparse(by)} == 0: {log}.{_SAYS}"
