"""I1.3: the learner's code, as far as edits of it need to know their way around."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

from tutor.judge import edits, source
from tutor.judge.edits import Edit
from tutor.judge.following import leads_on
from tutor.judge.trace import Trace
from tutor.judge.verdict import Cause

Function = ast.FunctionDef | ast.AsyncFunctionDef
_IMPORTS = {
    "AddTwoInts": "from example_interfaces.srv import AddTwoInts",
    "ReentrantCallbackGroup": "from rclpy.callback_groups import ReentrantCallbackGroup",
    "rclpy": "import rclpy",
}


@dataclass(frozen=True)
class Code:
    """One file of the learner's."""

    file: str
    text: str

    @cached_property
    def nodes(self) -> list[ast.AST]:
        return source.tree(self.text)

    @cached_property
    def _parents(self) -> dict[ast.AST, ast.AST]:
        return {child: each for each in self.nodes for child in ast.iter_child_nodes(each)}

    @cached_property
    def functions(self) -> list[Function]:
        return [each for each in self.nodes if isinstance(each, Function)]

    @property
    def top(self) -> list[ast.stmt]:
        """The statements of the file itself."""
        return self.nodes[0].body if self.nodes and isinstance(self.nodes[0], ast.Module) else []

    @property
    def first(self) -> ast.stmt:
        """The first statement below the imports."""
        return next(each for each in self.top if not isinstance(each, ast.Import | ast.ImportFrom | ast.Expr))

    def loop(self, node: ast.AST, beside: ast.AST) -> bool:
        """Whether a node is in a loop that the other one is not in."""
        loops = [each for each in self.around(node) if isinstance(each, ast.While | ast.For)]
        return any(each not in list(self.around(beside)) for each in loops)

    def around(self, node: ast.AST) -> Iterator[ast.AST]:
        """What a node is part of, from the inside out."""
        while node in self._parents:
            node = self._parents[node]
            yield node

    def function(self, node: ast.AST) -> Function | None:
        return next((each for each in self.around(node) if isinstance(each, Function)), None)

    def statement(self, node: ast.AST) -> ast.stmt:
        """The innermost statement that a node is part of."""
        return next(each for each in (node, *self.around(node)) if isinstance(each, ast.stmt))

    def outermost(self, node: ast.AST) -> ast.stmt:
        """The statement of the body of its function, or of the file, that a node is part of."""
        inside = [node, *self.around(node)]
        ends = next((at for at, each in enumerate(inside) if at and isinstance(each, Function)), len(inside))
        return [each for each in inside[:ends] if isinstance(each, ast.stmt)][-1]

    def me(self, node: ast.AST) -> str:
        """`self` within the methods of a class, and what is defined in them; else empty."""
        for each in self.around(node):
            if isinstance(each, Function) and isinstance(self._parents.get(each), ast.ClassDef) and each.args.args:
                return each.args.args[0].arg
        return ""

    def node(self, at: ast.AST) -> str:
        """What the ROS node is called at this place."""
        if me := self.me(at):
            return me
        made = [self._parents.get(each) for each in self.calls("create_node", "Node", *self.node_classes)]
        targets = [each.targets[0] for each in made if isinstance(each, ast.Assign)]
        return next((each.id for each in targets if isinstance(each, ast.Name)), "node")

    @property
    def node_classes(self) -> list[str]:
        found = [each for each in self.nodes if isinstance(each, ast.ClassDef)]
        return [each.name for each in found if any("Node" in ast.unparse(base) for base in each.bases)]

    def calls(self, *names: str) -> list[ast.Call]:
        """The calls of functions and methods of these names, in the order in which they are written."""
        found = [each for each in self.nodes if isinstance(each, ast.Call) and source.called(each) in names]
        return sorted(found, key=lambda call: (call.lineno, call.col_offset))

    def named(self, name: str) -> list[Function]:
        return [each for each in self.functions if each.name == name]

    def imported(self, name: str) -> str:
        """What something is called here: its own name, or the one that it was imported under."""
        for each in self.nodes:
            if isinstance(each, ast.Import | ast.ImportFrom):
                for alias in each.names:
                    if alias.name == name:
                        return alias.asname or name
        return name

    def importing(self, *names: str) -> list[Edit]:
        """The imports of these names that the file lacks."""
        has = {
            alias.name for each in self.nodes if isinstance(each, ast.Import | ast.ImportFrom) for alias in each.names
        }
        return [edit for name in names if name not in has for edit in edits.on_top(self.text, _IMPORTS[name])]

    def told(self, *changes: Edit | Sequence[Edit]) -> str | None:
        """The changes as a next step; None where they would break the file, or change nothing."""
        return edits.told(self.text, *changes, file=self.file)


def files(trace: Trace) -> list[Code]:
    """The learner's files: the one that was run first."""
    names = sorted(trace.sources, key=lambda name: name != trace.file)
    return [Code(name, trace.sources[name]) for name in names]


def given(call: ast.Call, place: int, keyword: str) -> ast.expr | None:
    """An argument of a call, by its place or its name."""
    if len(call.args) > place and not any(isinstance(each, ast.Starred) for each in call.args):
        return call.args[place]
    return next((each.value for each in call.keywords if each.arg == keyword), None)


def body(text: str, function: Function, lines: Sequence[str]) -> Edit:
    """The lines of a function below its head, and its docstring, become others; the head too where it must."""
    first = function.body[1:] if ast.get_docstring(function) is not None and function.body[1:] else function.body
    start, end = first[0].lineno, function.end_lineno or function.lineno
    alone = start > max(each.lineno for each in (function, *function.args.args))
    if alone and isinstance(function, ast.FunctionDef) and not function.decorator_list:
        return edits.becomes(start, "\n".join(lines), end)
    head = f"def {function.name}({ast.unparse(function.args)}):"
    top = min([function.lineno, *(each.lineno for each in function.decorator_list)])
    return edits.becomes(top, "\n".join([head, *(f"    {line}" for line in lines)]), end)


def stepped(cause: Cause, trace: Trace, *steps: Callable[[], str | None]) -> Cause:
    """The cause with a step that can be followed word for word: its own, or else the first of these."""
    for own in (cause.hint, f"in {trace.file}, {cause.hint}"):
        if leads_on(own, trace.sources) and (own != cause.hint or own.startswith("in ")):
            return replace(cause, hint=own)
    found = (step for find in steps if (step := find()) is not None)
    return replace(cause, hint=next(found, cause.hint))
