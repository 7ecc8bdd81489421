"""The calls in a launch file, with imported classes under their own names.

Only the syntax tree is read; a file that cannot be parsed has no calls.
"""

from __future__ import annotations

import ast
import copy
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from tutor.source.file import SourceFile, called_name


@dataclass(frozen=True, slots=True)
class Call:
    """One call. `name`: the last part of what is called; `given` and `named`: its arguments as source text.

    `code`: the whole call on one line; `within`: the name of the enclosing function, or ""; `kept`: the variable that
    its result is assigned to ("self.timer"), or "". `named` includes the items of `**common` if `common` is a dict in
    the same file.
    """

    name: str
    line: int
    code: str
    given: tuple[str, ...]
    named: Mapping[str, str]
    within: str
    kept: str

    def argument(self, position: int, name: str) -> str:
        """The argument, given by position or by name; "" if it is missing."""
        return self.given[position] if len(self.given) > position else self.named.get(name, "")

    @property
    def where(self) -> str:
        """Line number and code, to be put into a sentence."""
        return f"line {self.line}: {self.code}"


@dataclass(frozen=True)
class LaunchFile:
    """A launch file as source text, with import aliases resolved.

    With `from a import Name as N` or `import a`, both N(...) and a.Name(...) are read as Name(...).
    """

    text: str = ""

    @cached_property
    def file(self) -> SourceFile:
        """The file, in which each imported class goes by its original name."""
        return _ResolvedFile(self.text)

    def calls(self, *names: str) -> list[Call]:
        """The calls of functions or methods with these names, in file order."""
        return [_call(call, self.file) for call in self.file.calls(*names)]

    def uses(self, name: str) -> int:
        """How often the variable with this name is read."""
        names = [node for node in self.file.nodes if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load)]
        return [variable.id for variable in names].count(name)


class _ResolvedFile(SourceFile):
    """A file in which each imported class goes by its original name."""

    @cached_property
    def tree(self) -> ast.Module:
        plain: ast.Module = _AliasResolver(SourceFile(self.text)).visit(copy.deepcopy(super().tree))
        return plain


class _AliasResolver(ast.NodeTransformer):
    """Replaces aliases and qualified names of imported classes by their original names."""

    def __init__(self, file: SourceFile) -> None:
        self._file = file
        self._roots = {(alias.asname or alias.name).split(".")[0] for _, alias in file.imports}
        self._renamed = {
            alias.asname: alias.name
            for node, alias in file.imports
            if isinstance(node, ast.ImportFrom) and alias.asname and alias.name[:1].isupper()
        }

    def visit_Name(self, node: ast.Name) -> ast.AST:
        return ast.copy_location(ast.Name(self._renamed.get(node.id, node.id), node.ctx), node)

    def visit_Attribute(self, node: ast.Attribute) -> ast.AST:
        if self._is_of_module(node):
            return ast.copy_location(ast.Name(node.attr, node.ctx), node)
        return self.generic_visit(node)

    def _is_of_module(self, node: ast.Attribute) -> bool:
        """Whether this is a.b.Name with `a` imported: all parts but the last are lower case, like module names."""
        *path, last = ast.unparse(node).split(".")
        return (
            path[0] in self._roots
            and last[:1].isupper()
            and all(part.isidentifier() and part.islower() for part in path)
        )


def _dicts(tree: ast.AST) -> dict[str, dict[str, ast.expr]]:
    """The dicts that are assigned to a variable, by its name: their values by string key."""
    found: dict[str, dict[str, ast.expr]] = {}
    for node in ast.walk(tree):
        match node:
            case ast.Assign(targets=[ast.Name(id=name)], value=ast.Call(func=ast.Name(id="dict"), keywords=given)):
                found[name] = {keyword.arg: keyword.value for keyword in given if keyword.arg}
            case ast.Assign(targets=[ast.Name(id=name)], value=ast.Dict(keys=keys, values=values)):
                pairs = zip(keys, values, strict=True)
                found[name] = {
                    key.value: value
                    for key, value in pairs
                    if isinstance(key, ast.Constant) and isinstance(key.value, str)
                }
    return found


def _call(node: ast.Call, file: SourceFile) -> Call:
    named: dict[str, ast.expr] = {}
    for keyword in node.keywords:
        if keyword.arg:
            named[keyword.arg] = keyword.value
        elif isinstance(keyword.value, ast.Name):
            named |= _dicts(file.tree).get(keyword.value.id, {})
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
