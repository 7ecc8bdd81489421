"""I1.3: the learner's code, as far as edits of it need to know their way around."""

from __future__ import annotations

import ast
from collections.abc import Callable, Sequence
from dataclasses import replace

from tutor.judge import edits
from tutor.judge.edits import Edit
from tutor.judge.source import Function, SourceFile
from tutor.judge.step_parsing import is_applicable
from tutor.judge.trace import Trace
from tutor.judge.verdict import Cause

_IMPORTS = {
    "AddTwoInts": "from example_interfaces.srv import AddTwoInts",
    "ReentrantCallbackGroup": "from rclpy.callback_groups import ReentrantCallbackGroup",
    "rclpy": "import rclpy",
}


class Code(SourceFile):
    """One file of the learner's."""

    @property
    def top(self) -> list[ast.stmt]:
        """The statements of the file itself."""
        return self.tree.body

    @property
    def first(self) -> ast.stmt:
        """The first statement below the imports."""
        return next(each for each in self.top if not isinstance(each, ast.Import | ast.ImportFrom | ast.Expr))

    def loop(self, node: ast.AST, beside: ast.AST) -> bool:
        """Whether a node is in a loop that the other one is not in."""
        loops = [each for each in self.ancestors(node) if isinstance(each, ast.While | ast.For)]
        return any(each not in list(self.ancestors(beside)) for each in loops)

    def outermost(self, node: ast.AST) -> ast.stmt:
        """The statement of the body of its function, or of the file, that a node is part of."""
        inside = [node, *self.ancestors(node)]
        ends = next((at for at, each in enumerate(inside) if at and isinstance(each, Function)), len(inside))
        return [each for each in inside[:ends] if isinstance(each, ast.stmt)][-1]

    def self_name(self, node: ast.AST) -> str:
        """`self` within the methods of a class, and what is defined in them; else empty."""
        for each in self.ancestors(node):
            if isinstance(each, Function) and isinstance(self._parents.get(each), ast.ClassDef) and each.args.args:
                return each.args.args[0].arg
        return ""

    def node(self, at: ast.AST) -> str:
        """What the ROS node is called at this place."""
        if me := self.self_name(at):
            return me
        made = [self._parents.get(each) for each in self.calls("create_node", "Node", *self.node_classes)]
        targets = [each.targets[0] for each in made if isinstance(each, ast.Assign)]
        return next((each.id for each in targets if isinstance(each, ast.Name)), "node")

    def imported(self, name: str) -> str:
        """What something is called here: its own name, or the one that it was imported under."""
        return next((alias.asname or name for _, alias in self.imports if alias.name == name), name)

    def importing(self, *names: str) -> list[Edit]:
        """The imports of these names that the file lacks."""
        has = {alias.name for _, alias in self.imports}
        return [edit for name in names if name not in has for edit in edits.add_import(self.text, _IMPORTS[name])]

    def as_step(self, *changes: Edit | Sequence[Edit]) -> str | None:
        """The changes as a next step; None where they would break the file, or change nothing."""
        return edits.describe_edits(self.text, *changes, file=self.file)


def learner_files(trace: Trace) -> list[Code]:
    """The learner's files: the one that was run first."""
    names = sorted(trace.sources, key=lambda name: name != trace.file)
    return [Code(trace.sources[name], name) for name in names]


def with_applicable_step(cause: Cause, trace: Trace, *steps: Callable[[], str | None]) -> Cause:
    """The cause with a step that can be followed word for word: its own, or else the first of these."""
    for own in (cause.hint, f"in {trace.file}, {cause.hint}"):
        if is_applicable(own, trace.sources) and (own != cause.hint or own.startswith("in ")):
            return replace(cause, hint=own)
    found = (step for find in steps if (step := find()) is not None)
    return replace(cause, hint=next(found, cause.hint))
