"""What a learner's source says, for the words of a diagnosis: a next step must not advise what is there already.

Never for a verdict. A file that Python cannot read says nothing.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property, lru_cache

from tutor.judge.trace import Trace

Function = ast.FunctionDef | ast.AsyncFunctionDef


@dataclass(frozen=True)
class SourceFile:
    """One file, by its syntax tree; `file` is what a step calls it. All that it gives are parts of `tree`."""

    text: str
    file: str = ""

    @cached_property
    def tree(self) -> ast.Module:
        """The file's syntax tree, the same one for the same text; an empty one where Python cannot read it."""
        return _parsed(self.text)

    @cached_property
    def nodes(self) -> list[ast.AST]:
        """All nodes of the syntax tree."""
        return list(ast.walk(self.tree))

    @cached_property
    def _parents(self) -> dict[ast.AST, ast.AST]:
        return {child: parent for parent in self.nodes for child in ast.iter_child_nodes(parent)}

    def ancestors(self, node: ast.AST) -> Iterator[ast.AST]:
        """What is around a part, from the inside out."""
        while (parent := self._parents.get(node)) is not None:
            yield parent
            node = parent

    def function_around(self, node: ast.AST) -> Function | None:
        """The innermost function around a part."""
        return next((each for each in self.ancestors(node) if isinstance(each, Function)), None)

    def class_of(self, function: ast.AST) -> ast.ClassDef | None:
        """The class that a method belongs to."""
        return next((each for each in self.ancestors(function) if isinstance(each, ast.ClassDef)), None)

    def statement(self, node: ast.AST) -> ast.stmt:
        """The innermost statement that a part belongs to, or is."""
        return next(each for each in (node, *self.ancestors(node)) if isinstance(each, ast.stmt))

    def calls(self, *names: str) -> list[ast.Call]:
        """The calls of functions and methods of these names, in the order in which they are written."""
        found = [each for each in self.nodes if isinstance(each, ast.Call) and called_name(each) in names]
        return sorted(found, key=lambda each: (each.lineno, each.col_offset))

    def assigned_to(self, call: ast.Call) -> str:
        """What a call's result is assigned to, such as "self.timer"; empty where it is not."""
        match self._parents.get(call):
            case ast.Assign(targets=[*_, target]) | ast.AnnAssign(target=target):
                return ast.unparse(target)
        return ""

    @cached_property
    def functions(self) -> list[Function]:
        """Every function and method, in the order in which they are written."""
        return sorted((each for each in self.nodes if isinstance(each, Function)), key=lambda each: each.lineno)

    def function_at(self, line: int) -> Function | None:
        """The innermost function that a line is in."""
        found = [each for each in self.functions if each.lineno <= line <= (each.end_lineno or 0)]
        return max(found, key=lambda each: each.lineno, default=None)

    def statement_at(self, line: int) -> ast.stmt | None:
        """The innermost statement that a line belongs to; of a compound one, its head does."""
        statements = [each for each in self.nodes if isinstance(each, ast.stmt)]
        found = [each for each in statements if each.lineno <= line <= (each.end_lineno or 0)]
        return max(found, key=lambda each: (each.lineno, -(each.end_lineno or 0)), default=None)

    def named(self, name: str) -> list[Function]:
        """The functions and methods of this name."""
        return [each for each in self.functions if each.name == name]

    def function(self, callback: ast.expr | None) -> Function | None:
        """The function that an argument names, by itself or in a lambda or a partial: the last one of that name."""
        match callback:
            case ast.Attribute(attr=name) | ast.Name(id=name):
                return next((each for each in reversed(self.functions) if each.name == name), None)
            case ast.Lambda(body=ast.Call(func=inner)):
                return self.function(inner)
            case ast.Call(args=[first, *_]):
                return self.function(first)
        return None

    def reached(self, function: Function) -> list[Function]:
        """The function, and those of the file that it leads to."""
        found, todo = [], [function]
        while todo:
            each = todo.pop(0)
            if each not in found:
                found.append(each)
                todo += [led for inner in calls_in(each) if (led := self.function(inner.func)) is not None]
        return found

    @cached_property
    def node_classes(self) -> list[str]:
        """The names of the file's classes of nodes."""
        found: list[str] = []
        for each in self.nodes:
            if isinstance(each, ast.ClassDef) and any(
                "Node" in (base := ast.unparse(one)) or base in found for one in each.bases
            ):
                found.append(each.name)
        return found

    @cached_property
    def imports(self) -> list[tuple[ast.Import | ast.ImportFrom, ast.alias]]:
        """Each name that is imported, with the statement that does so."""
        found = [each for each in self.nodes if isinstance(each, ast.Import | ast.ImportFrom)]
        return [(each, alias) for each in found for alias in each.names]


def files(trace: Trace) -> list[SourceFile]:
    """The learner's files, with their names where there are several."""
    several = len(trace.sources) > 1
    return [SourceFile(text, name if several else "") for name, text in trace.sources.items()]


def file_holding(trace: Trace, node: ast.AST) -> SourceFile:
    """The file that a part of a syntax tree is of."""
    return next(each for each in files(trace) if node in each.nodes)


def all_nodes(trace: Trace) -> Iterator[ast.AST]:
    """All nodes of the syntax trees of the learner's files."""
    for text in trace.sources.values():
        yield from ast.walk(_parsed(text))


def syntax_nodes(text: str) -> list[ast.AST]:
    """All nodes of the syntax tree of one file, by its text: the same ones each time."""
    return list(ast.walk(_parsed(text)))


def mentions(trace: Trace, *names: str) -> bool:
    """Whether one of these names is used anywhere, as a variable, a function or an attribute."""
    wanted = set(names)
    return any(
        (isinstance(node, ast.Name) and node.id in wanted) or (isinstance(node, ast.Attribute) and node.attr in wanted)
        for node in all_nodes(trace)
    )


def calls(trace: Trace, *names: str) -> list[ast.Call]:
    """The calls of functions and methods of these names, in the order in which they are written."""
    wanted = set(names)
    found = [node for node in all_nodes(trace) if isinstance(node, ast.Call) and called_name(node) in wanted]
    return sorted(found, key=lambda call: call.lineno)


def assigned(trace: Trace, *names: str) -> list[tuple[str, int]]:
    """What the results of calls of these names are assigned to, such as ("self.client", 14), with the line's number.

    Empty where it is no single name or attribute.
    """
    wanted = set(names)
    found = []
    for node in all_nodes(trace):
        if isinstance(node, ast.Assign | ast.AnnAssign) and isinstance(node.value, ast.Call):
            target = node.targets[0] if isinstance(node, ast.Assign) else node.target
            if called_name(node.value) in wanted:
                plain = isinstance(target, ast.Name | ast.Attribute)
                found.append((ast.unparse(target) if plain else "", node.end_lineno or node.lineno))
    return sorted(found, key=lambda each: each[1])


def callbacks(trace: Trace, create: str) -> list[Function]:
    """The functions that are given to `create`, such as "create_subscription", and those that they call, by name."""
    given = [each for call in calls(trace, create) for each in (*call.args, *(k.value for k in call.keywords))]
    inside = [call for each in given if isinstance(each, ast.Lambda) for call in calls_in(each)]
    waiting = [last_name(each) for each in given] + [called_name(call) for call in inside]
    found: dict[str, list[Function]] = {}
    while waiting:
        name = waiting.pop(0)
        named = [each for each in all_nodes(trace) if isinstance(each, Function) and each.name == name]
        if named and name not in found:
            found[name] = named
            waiting += [called_name(call) for function in named for call in calls_in(function)]
    return [function for named in found.values() for function in named]


def calls_in(node: ast.AST | None, *names: str) -> list[ast.Call]:
    """The calls within a part of a syntax tree: all, or those of functions and methods of these names."""
    found = [each for each in ast.walk(node) if isinstance(each, ast.Call)] if node is not None else []
    return [each for each in found if not names or called_name(each) in names]


def values_of(target: str, node: ast.AST) -> list[ast.expr]:
    """What a variable or an attribute, as written, is set to within a part of a syntax tree."""
    made = [each for each in ast.walk(node) if isinstance(each, ast.Assign)]
    return [each.value for each in made if any(ast.unparse(one) == target for one in each.targets)]


def where(node: ast.stmt | ast.expr) -> str:
    """Line and code, to be put into a sentence."""
    return f"line {node.lineno}: {ast.unparse(node)}"


def called_name(call: ast.Call) -> str:
    """The last part of the name of what is called; empty where it has none."""
    return last_name(call.func)


def last_name(expression: ast.AST | None) -> str:
    """The last part of a name, such as "b" of a.b; empty where it is none."""
    match expression:
        case ast.Attribute(attr=name) | ast.Name(id=name):
            return name
    return ""


@lru_cache(maxsize=32)
def _parsed(text: str) -> ast.Module:
    try:
        return ast.parse(text)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return ast.Module([], [])
