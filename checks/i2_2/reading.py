"""I2.2: what a launch file says, call by call: it serves the words of a diagnosis, never a verdict.

Read by its syntax tree only; whatever cannot be parsed says nothing.
"""

from __future__ import annotations

import ast
import copy
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

from tutor.judge.source import SourceFile, called_name


@dataclass(frozen=True, slots=True)
class Call:
    """One call: `name` is the last part of what is called; `given` and `named` are its arguments, as written.

    `code` is the whole call in one line; `within` the function around it, or empty; `kept` what its result is assigned
    to ("self.timer"), or empty. `named` has what comes by `**common`, too, where `common` is a dict in the same file.
    """

    name: str
    line: int
    code: str
    given: tuple[str, ...]
    named: Mapping[str, str]
    within: str
    kept: str

    def argument(self, position: int, name: str) -> str:
        """One argument, given by position or by name; empty where it is not there."""
        return self.given[position] if len(self.given) > position else self.named.get(name, "")

    @property
    def where(self) -> str:
        """Line and code, to be put into a sentence."""
        return f"line {self.line}: {self.code}"


@dataclass(frozen=True)
class Source:
    """A launch file, by its text, as if each imported class went by its own name, whatever it is called.

    With `from a import Name as N`, or `import a`, both N(...) and a.Name(...) read Name(...).
    """

    text: str = ""

    @cached_property
    def _file(self) -> SourceFile:
        return _PlainFile(self.text)

    @property
    def readable(self) -> bool:
        """Whether Python can read it, and it says anything."""
        return bool(self._file.tree.body)

    def own(self, name: str) -> str:
        """How the file calls a class: "Name", "N" or "a.Name"; `name` where it knows none of this name."""
        classes = _Plain(SourceFile(self.text)).classes()
        return next((written for written, plain in classes if plain == name), name)

    def calls(self, *names: str) -> list[Call]:
        """The calls of functions or methods of these names, in the order of the file."""
        return [_call(each, self._file) for each in self._file.calls(*names)]

    def assignments(self) -> list[tuple[str, str]]:
        """Each target ("self.rate") with the value that it is set to, as written, in the order of the file."""
        found = [each for each in self._file.nodes if isinstance(each, ast.Assign | ast.AnnAssign) and each.value]
        found.sort(key=lambda each: each.lineno)
        return [
            (ast.unparse(target), ast.unparse(each.value))
            for each in found
            for target in (each.targets if isinstance(each, ast.Assign) else [each.target])
            if each.value is not None
        ]

    def texts(self) -> list[tuple[str, ...]]:
        """The texts that are put together by an f-string, + or join(): their parts, as written."""
        return [parts for each in self._file.nodes if (parts := _parts(each, self._file))]

    def uses(self, name: str) -> int:
        """How often the variable of this name is read."""
        names = [each for each in self._file.nodes if isinstance(each, ast.Name) and isinstance(each.ctx, ast.Load)]
        return [each.id for each in names].count(name)

    def imports(self, name: str) -> bool:
        """Whether something of this name is imported."""
        return any((alias.asname or alias.name).split(".")[0] == name for _, alias in self._file.imports)


class _PlainFile(SourceFile):
    """A file with the name of each imported class in place of what the file calls it."""

    @cached_property
    def tree(self) -> ast.Module:
        plain: ast.Module = _Plain(SourceFile(self.text)).visit(copy.deepcopy(super().tree))
        return plain


class _Plain(ast.NodeTransformer):
    """Puts the name of each imported class in place of what the file calls it."""

    def __init__(self, file: SourceFile) -> None:
        self._file = file
        self._roots = {(alias.asname or alias.name).split(".")[0] for _, alias in file.imports}
        self._renamed = {
            alias.asname: alias.name
            for node, alias in file.imports
            if isinstance(node, ast.ImportFrom) and alias.asname and alias.name[:1].isupper()
        }

    def classes(self) -> Iterator[tuple[str, str]]:
        """Every class that is imported under another name, or by its module: as it is written, and its own name."""
        yield from self._renamed.items()
        for node in self._file.nodes:
            if isinstance(node, ast.Attribute) and self._is_of_module(node):
                yield ast.unparse(node), node.attr

    def visit_Name(self, node: ast.Name) -> ast.AST:
        return ast.copy_location(ast.Name(self._renamed.get(node.id, node.id), node.ctx), node)

    def visit_Attribute(self, node: ast.Attribute) -> ast.AST:
        if self._is_of_module(node):
            return ast.copy_location(ast.Name(node.attr, node.ctx), node)
        return self.generic_visit(node)

    def _is_of_module(self, node: ast.Attribute) -> bool:
        """Whether this is a.b.Name, with `a` imported: all parts but the last in small letters, as modules are."""
        *path, last = ast.unparse(node).split(".")
        return (
            path[0] in self._roots
            and last[:1].isupper()
            and all(each.isidentifier() and each.islower() for each in path)
        )


def _dicts(tree: ast.AST) -> dict[str, dict[str, ast.expr]]:
    """The dicts that the file gives a name: what each has under its keys that are texts."""
    found: dict[str, dict[str, ast.expr]] = {}
    for node in ast.walk(tree):
        match node:
            case ast.Assign(targets=[ast.Name(id=name)], value=ast.Call(func=ast.Name(id="dict"), keywords=given)):
                found[name] = {each.arg: each.value for each in given if each.arg}
            case ast.Assign(targets=[ast.Name(id=name)], value=ast.Dict(keys=keys, values=values)):
                pairs = zip(keys, values, strict=True)
                found[name] = {
                    key.value: each
                    for key, each in pairs
                    if isinstance(key, ast.Constant) and isinstance(key.value, str)
                }
    return found


def _call(node: ast.Call, file: SourceFile) -> Call:
    named: dict[str, ast.expr] = {}
    for each in node.keywords:
        if each.arg:
            named[each.arg] = each.value
        elif isinstance(each.value, ast.Name):
            named |= _dicts(file.tree).get(each.value.id, {})
    function = file.function_around(node)
    return Call(
        name=called_name(node),
        line=node.lineno,
        code=ast.unparse(node),
        given=tuple(map(ast.unparse, node.args)),
        named={name: ast.unparse(value) for name, value in named.items()},
        within=function.name if function is not None else "",
        kept=file.assigned_to(node),
    )


def _parts(node: ast.AST, file: SourceFile) -> tuple[str, ...]:
    """The parts of a text that is put together; none where this is no such text, or only a part of one."""
    match node:
        case ast.JoinedStr():
            return tuple(
                ast.unparse(each.value) if isinstance(each, ast.FormattedValue) else ast.unparse(each)
                for each in node.values
            )
        case ast.BinOp(op=ast.Add()) if not isinstance(next(file.ancestors(node), None), ast.BinOp):
            return tuple(_added(node))
        case ast.Call(
            func=ast.Attribute(value=ast.Constant(value=str() as between), attr="join"), args=[ast.List(elts=parts)]
        ):
            every = [[ast.unparse(part), repr(between)] for part in parts]
            return tuple(each for pair in every for each in pair)[:-1]
        case _:
            return ()


def _added(node: ast.expr) -> Iterator[str]:
    match node:
        case ast.BinOp(left=left, op=ast.Add(), right=right):
            yield from _added(left)
            yield from _added(right)
        case ast.Call(func=ast.Name(id="str"), args=[inner]):
            yield ast.unparse(inner)
        case _:
            yield ast.unparse(node)
