"""One file of a learner's program, as its syntax tree: functions, calls, assignments, and what calls what.

It only shapes the wording of a diagnosis, never a verdict. A file that Python cannot parse counts as empty.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

from tutor.source.tree import parsed

Function = ast.FunctionDef | ast.AsyncFunctionDef


@dataclass(frozen=True)
class SourceFile:
    """One file and its syntax tree; `name` is the file's name. Every syntax node returned is part of `tree`."""

    text: str
    name: str = ""

    @cached_property
    def tree(self) -> ast.Module:
        """The file's syntax tree (see `syntax_tree.parsed`)."""
        return parsed(self.text)

    @cached_property
    def nodes(self) -> list[ast.AST]:
        """All nodes of the syntax tree."""
        return list(ast.walk(self.tree))

    @cached_property
    def _parents(self) -> dict[ast.AST, ast.AST]:
        return {child: parent for parent in self.nodes for child in ast.iter_child_nodes(parent)}

    def line(self, number: int) -> str:
        """The text of a line, counted from 1, without indentation and comment; empty if there is none."""
        lines = self.text.splitlines()
        return lines[number - 1].strip() if 0 < number <= len(lines) else ""

    def ancestors(self, node: ast.AST) -> Iterator[ast.AST]:
        """The ancestors of a syntax node, innermost first."""
        while (parent := self._parents.get(node)) is not None:
            yield parent
            node = parent

    def function_around(self, node: ast.AST) -> Function | None:
        """The innermost function that contains a syntax node."""
        return next((ancestor for ancestor in self.ancestors(node) if isinstance(ancestor, Function)), None)

    def class_of(self, function: ast.AST) -> ast.ClassDef | None:
        """The innermost class that contains a function; for a method, its class."""
        return next((ancestor for ancestor in self.ancestors(function) if isinstance(ancestor, ast.ClassDef)), None)

    def node_method(self, node: ast.AST) -> Function | None:
        """The method of a node class that contains a node of the syntax tree; None if none does."""
        function = self.function_around(node)
        owner = self.class_of(function) if function is not None else None
        return function if owner is not None and owner.name in self.node_classes else None

    def statement(self, node: ast.AST) -> ast.stmt:
        """The innermost statement that contains, or is, a syntax node."""
        return next(candidate for candidate in (node, *self.ancestors(node)) if isinstance(candidate, ast.stmt))

    def block_of(self, statement: ast.stmt) -> list[ast.stmt]:
        """The block of statements that contains this one; empty if it is not of this file."""
        parent = next(self.ancestors(statement), None)
        blocks = (getattr(parent, name, None) for name in ("body", "orelse", "finalbody"))
        return next((block for block in blocks if isinstance(block, list) and statement in block), [])

    def calls(self, *names: str) -> list[ast.Call]:
        """The calls of functions and methods with these names, in source order."""
        found = [node for node in self.nodes if isinstance(node, ast.Call) and called_name(node) in names]
        return sorted(found, key=lambda call: (call.lineno, call.col_offset))

    def assigned_to(self, call: ast.Call) -> str:
        """The target that a call's result is assigned to, such as "self.timer"; empty if it is not assigned."""
        match self._parents.get(call):
            case ast.Assign(targets=[*_, target]) | ast.AnnAssign(target=target):
                return ast.unparse(target)
        return ""

    @cached_property
    def functions(self) -> list[Function]:
        """All functions and methods, in source order."""
        return sorted((node for node in self.nodes if isinstance(node, Function)), key=lambda function: function.lineno)

    def function_at(self, line: int) -> Function | None:
        """The innermost function that contains a line."""
        found = [function for function in self.functions if function.lineno <= line <= (function.end_lineno or 0)]
        return max(found, key=lambda function: function.lineno, default=None)

    def statement_at(self, line: int) -> ast.stmt | None:
        """The innermost statement that contains a line; for the header of a compound statement, that statement."""
        statements = [node for node in self.nodes if isinstance(node, ast.stmt)]
        found = [statement for statement in statements if statement.lineno <= line <= (statement.end_lineno or 0)]
        return max(found, key=lambda statement: (statement.lineno, -(statement.end_lineno or 0)), default=None)

    def functions_named(self, name: str) -> list[Function]:
        """The functions and methods with this name."""
        return [function for function in self.functions if function.name == name]

    def function(self, callback: ast.expr | None, *, follow: bool = True) -> Function | None:
        """The function that a callback argument refers to, directly or within a lambda or partial().

        If several have that name, the last one that does something. `follow`: a parameter refers to the function that
        all callers pass for it, if that is the same one.
        """
        match callback:
            case ast.Attribute(attr=name) | ast.Name(id=name):
                found = [function for function in reversed(self.functions) if function.name == name]
                named = next((function for function in found if not is_abstract(function)), next(iter(found), None))
                if named is None and follow and isinstance(callback, ast.Name):
                    return self._passed_function(callback)
                return named
            case ast.Lambda(body=ast.Call(func=inner)):
                return self.function(inner, follow=follow)
            case ast.Call(args=[first, *_]):
                return self.function(first, follow=follow)
        return None

    def _passed_function(self, parameter: ast.Name) -> Function | None:
        around = self.function_around(parameter)
        taken = [arg.arg for arg in around.args.args] if around is not None else []
        if around is None or parameter.id not in taken:
            return None
        position = taken.index(parameter.id) - (taken[0] in ("self", "cls"))
        passed: list[ast.expr | None] = []
        for call in self.calls(around.name):
            by_name = [keyword.value for keyword in call.keywords if keyword.arg == parameter.id]
            passed.append(next(iter([*by_name, *call.args[position : position + 1]]), None))
        found = {self.function(value, follow=False) for value in passed}
        return found.pop() if len(found) == 1 else None

    def reachable_from(self, function: Function) -> list[Function]:
        """The function itself and all functions of the file that it calls, directly or indirectly."""
        found, todo = [], [function]
        while todo:
            reached = todo.pop(0)
            if reached not in found:
                found.append(reached)
                todo += [callee for call in calls_in(reached) if (callee := self.function(call.func)) is not None]
        return found

    @cached_property
    def node_classes(self) -> list[str]:
        """The names of the file's node classes."""
        found: list[str] = []
        for node in self.nodes:
            if isinstance(node, ast.ClassDef) and any(
                "Node" in (base := ast.unparse(parent)) or base in found for parent in node.bases
            ):
                found.append(node.name)
        return found

    @cached_property
    def imports(self) -> list[tuple[ast.Import | ast.ImportFrom, ast.alias]]:
        """Each imported name, with its import statement."""
        found = [node for node in self.nodes if isinstance(node, ast.Import | ast.ImportFrom)]
        return [(statement, alias) for statement in found for alias in statement.names]


def calls_in(node: ast.AST | None, *names: str) -> list[ast.Call]:
    """The calls within a syntax tree: all, or only those of functions and methods with these names."""
    found = [part for part in ast.walk(node) if isinstance(part, ast.Call)] if node is not None else []
    return [call for call in found if not names or called_name(call) in names]


def values_of(target: str, node: ast.AST) -> list[ast.expr]:
    """The values assigned within a syntax tree to a variable or an attribute, such as "self.count"."""
    assignments = [part for part in ast.walk(node) if isinstance(part, ast.Assign)]
    return [assignment.value for assignment in assignments if target in map(ast.unparse, assignment.targets)]


def is_endless(loop: ast.While) -> bool:
    """Whether nothing in the code of a loop ends it: no condition, and no `break`, `return` or `raise`."""
    ends = any(isinstance(node, ast.Break | ast.Return | ast.Raise) for node in ast.walk(loop))
    return isinstance(loop.test, ast.Constant) and bool(loop.test.value) and not ends


def where(node: ast.stmt | ast.expr) -> str:
    """The line number and code of a syntax node, for use in a sentence."""
    return f"line {node.lineno}: {ast.unparse(node)}"


def is_abstract(function: Function) -> bool:
    """Whether a function has nothing but a docstring, `pass`, `...`, or `raise`."""
    return all(
        isinstance(statement, ast.Pass | ast.Raise)
        or (isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant))
        for statement in function.body
    )


def called_name(call: ast.Call) -> str:
    """The last part of the name of the called function, such as "b" for a.b(); empty if it has no name."""
    return last_name(call.func)


def last_name(expression: ast.AST | None) -> str:
    """The last part of a (dotted) name, such as "b" for a.b; empty for any other expression."""
    match expression:
        case ast.Attribute(attr=name) | ast.Name(id=name):
            return name
    return ""
