"""I1.3: navigation in the learner's code, for building edits."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

from tutor.judge import edits
from tutor.judge.edits import Edit
from tutor.judge.rewriting.node import is_static
from tutor.judge.source import Function, SourceFile
from tutor.judge.step_parsing import is_applicable
from tutor.judge.trace import Trace
from tutor.judge.verdict import Cause

_IMPORTS = {
    "AddTwoInts": "from example_interfaces.srv import AddTwoInts",
    "ReentrantCallbackGroup": "from rclpy.callback_groups import ReentrantCallbackGroup",
    "rclpy": "import rclpy",
    "time": "import time",
}


class Code(SourceFile):
    """One of the learner's files."""

    @property
    def top(self) -> list[ast.stmt]:
        """The top-level statements of the file."""
        return self.tree.body

    @property
    def first_statement(self) -> ast.stmt:
        """The first statement below the imports."""
        return next(each for each in self.top if not isinstance(each, ast.Import | ast.ImportFrom | ast.Expr))

    def is_in_inner_loop(self, node: ast.AST, other: ast.AST) -> bool:
        """Whether a node is inside a loop that does not contain the other node."""
        loops = [each for each in self.ancestors(node) if isinstance(each, ast.While | ast.For)]
        return any(each not in list(self.ancestors(other)) for each in loops)

    def outermost_statement(self, node: ast.AST) -> ast.stmt:
        """The statement directly in the body of the enclosing function (or of the file) that contains a node."""
        chain = [node, *self.ancestors(node)]
        end = next((i for i, each in enumerate(chain) if i and isinstance(each, Function)), len(chain))
        return [each for each in chain[:end] if isinstance(each, ast.stmt)][-1]

    def self_name(self, node: ast.AST) -> str:
        """The name of `self` inside a method, or inside a function nested in one; else ""."""
        for each in self.ancestors(node):
            if isinstance(each, Function) and isinstance(self._parents.get(each), ast.ClassDef):
                return "" if is_static(each) or not each.args.args else each.args.args[0].arg
        return ""

    def node_name(self, at: ast.AST) -> str:
        """The variable that holds the ROS node at this place in the code.

        In a class that is no node: the attribute that keeps the node by which it creates its clients, if there is one.
        """
        if self_name := self.self_name(at):
            return self_name if self.node_method(at) is not None else next(self._kept_nodes(at), self_name)
        parents = [self._parents.get(each) for each in self.calls("create_node", "Node", *self.node_classes)]
        targets = [each.targets[0] for each in parents if isinstance(each, ast.Assign)]
        return next((each.id for each in targets if isinstance(each, ast.Name)), "node")

    def has_node(self, at: ast.AST) -> bool:
        """Whether the node is known at this place in the code: not in a class that neither is a node nor keeps one."""
        if not self.self_name(at):
            return not any(isinstance(each, ast.ClassDef) for each in self.ancestors(at))
        return self.node_method(at) is not None or any(self._kept_nodes(at))

    def _kept_nodes(self, at: ast.AST) -> Iterator[str]:
        """The attributes of the class around `at` that keep an object by which clients or services are created."""
        owners = {
            ast.unparse(each.func.value)
            for each in self.calls("create_client", "create_service")
            if isinstance(each.func, ast.Attribute)
        }
        around = next((each for each in self.ancestors(at) if isinstance(each, ast.ClassDef)), None)
        for each in ast.walk(around) if around is not None else ():
            if isinstance(each, ast.Assign) and ast.unparse(each.value) in owners:
                yield ast.unparse(each.targets[0])

    def local_name(self, name: str) -> str:
        """The name in this file of something that may be imported `as` something else."""
        return next((alias.asname or name for _, alias in self.imports if alias.name == name), name)

    def missing_imports(self, *names: str) -> list[Edit]:
        """The edits that import those of these names that the file does not import yet."""
        present = {alias.name for _, alias in self.imports}
        return [edit for name in names if name not in present for edit in edits.add_import(self.text, _IMPORTS[name])]

    def as_step(self, *changes: Edit | Sequence[Edit]) -> str | None:
        """Describe the changes as a next step; None if they would break the file or change nothing."""
        return edits.describe_edits(self.text, *changes, file=self.file)


def learner_files(trace: Trace) -> list[Code]:
    """Parse the learner's files, beginning with the one that was run."""
    names = sorted(trace.sources, key=lambda name: name != trace.file)
    return [Code(trace.sources[name], name) for name in names]


def with_applicable_step(cause: Cause, trace: Trace, *steps: Callable[[], str | None]) -> Cause:
    """Give a cause a hint that can be followed word for word: its own, or else the first that `steps` provide.

    Keep the hint as it is if none of them provides one.
    """
    for own in (cause.hint, f"in {trace.file}, {cause.hint}"):
        if is_applicable(own, trace.sources) and (own != cause.hint or own.startswith("in ")):
            return replace(cause, hint=own)
    found = (step for find in steps if (step := find()) is not None)
    return replace(cause, hint=next(found, cause.hint))
