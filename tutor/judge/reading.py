"""What a learner's file says, call by call: it serves the words of a diagnosis, never a verdict.

Read by its syntax tree only; whatever cannot be parsed says nothing.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import lru_cache

from tutor.judge.trace import Trace


@dataclass(frozen=True, slots=True)
class Call:
    """One call: `name` is the last part of what is called; `given` and `named` are its arguments, as written.

    `code` is the whole call in one line; `within` the function around it, or empty; `kept` what its result is assigned
    to ("self.timer"), or empty; `tests` are the conditions around it, innermost first. `named` has what comes by
    `**common`, too, where `common` is a dict in the same file; `lines` are the lines in which `named` are written.
    """

    name: str
    line: int
    code: str
    given: tuple[str, ...] = ()
    named: Mapping[str, str] = field(default_factory=dict)
    within: str = ""
    kept: str = ""
    tests: tuple[Line, ...] = ()
    lines: Mapping[str, int] = field(default_factory=dict)

    def argument(self, position: int, name: str) -> str:
        """One argument, given by position or by name; empty where it is not there."""
        return self.given[position] if len(self.given) > position else self.named.get(name, "")

    @property
    def where(self) -> str:
        """Line and code, to be put into a sentence."""
        return f"line {self.line}: {self.code}"

    def instead(self, old: str, new: str) -> str:
        """The line with one of its arguments (or what stands behind them) written otherwise, as it should be."""
        called, bracket, arguments = self.code.partition("(")
        return self.becomes(f"{called}{bracket}{arguments.replace(old, new, 1)}")

    def becomes(self, code: str) -> str:
        """The line with this call in it: "line 8: self.timer = self.create_timer(1.0, self.tick)"."""
        return f"line {self.line}: {f'{self.kept} = ' if self.kept else ''}{code}"


@dataclass(frozen=True, slots=True)
class Line:
    """A place in the source, and what it says."""

    line: int
    code: str

    @property
    def where(self) -> str:
        """Line and code, to be put into a sentence."""
        return f"line {self.line}: {self.code}"


@dataclass(frozen=True, slots=True)
class Assignment:
    """`target` is set to `value`, both as written; `within` is the function around it, or empty."""

    line: int
    target: str
    value: str
    within: str
    constant: bool

    @property
    def where(self) -> str:
        """Line and code, to be put into a sentence."""
        return f"line {self.line}: {self.target} = {self.value}"


@dataclass(frozen=True, slots=True)
class Function:
    """A function: its arguments without self, the functions that it calls, and the texts (constants) in it."""

    name: str
    line: int
    owner: str
    arguments: tuple[str, ...]
    calls: frozenset[str]
    texts: frozenset[str]
    code: str


@dataclass(frozen=True, slots=True)
class Text:
    """A text that is put together, by an f-string, + or join(): its parts, as written."""

    line: int
    code: str
    parts: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Source:
    """A learner's file, by its text. `plain`: as if each imported class went by its own name, whatever it is called.

    With `from a import Name as N`, or `import a`, both N(...) and a.Name(...) read Name(...) then.
    """

    text: str = ""
    plain: bool = False

    @property
    def _read(self) -> _Read:
        return _read(self.text, self.plain)

    def own(self, name: str) -> str:
        """How the file calls a class: "Name", "N" or "a.Name"; `name` where it knows none of this name."""
        return next((written for written, plain in _read(self.text).classes if plain == name), name)

    def calls(self, *names: str) -> list[Call]:
        """The calls of functions or methods of these names, in the order of the file."""
        return [call for call in self._read.calls if call.name in names]

    def functions(self, name: str) -> list[Function]:
        """The functions of this name: more than one where a later one replaces an earlier one."""
        return [function for function in self._read.functions if function.name == name]

    def all_functions(self) -> list[Function]:
        """Every function of the file."""
        return list(self._read.functions)

    def assignments(self, target: str = "") -> list[Assignment]:
        """What is assigned to `target` ("self.rate"), or all assignments, in the order of the file."""
        return [each for each in self._read.assignments if not target or each.target == target]

    def texts(self) -> list[Text]:
        """The texts that are put together from parts."""
        return list(self._read.texts)

    def bases(self) -> dict[str, tuple[str, ...]]:
        """Each class with its base classes, as written."""
        return dict(self._read.bases)

    def reached(self, name: str) -> list[Function]:
        """The function of this name (the last one), and those of the file that it leads to."""
        last = {function.name: function for function in self._read.functions}
        found: dict[str, Function] = {}
        todo = [name]
        while todo:
            each = todo.pop(0)
            if each in last and each not in found:
                found[each] = last[each]
                todo += sorted(last[each].calls)
        return list(found.values())

    def line(self, number: int) -> str:
        """One line, counted from 1, without what surrounds it."""
        lines = self.text.splitlines()
        return lines[number - 1].strip() if 0 < number <= len(lines) else ""

    def uses(self, name: str) -> int:
        """How often the variable of this name is read."""
        return self._read.read.count(name)

    def lines_with(self, word: str) -> list[int]:
        """The numbers of the lines that have this word in them."""
        found = re.compile(rf"\b{re.escape(word)}\b").search
        return [number for number, line in enumerate(self.text.splitlines(), 1) if found(line)]

    def imports(self, name: str) -> bool:
        """Whether something of this name is imported."""
        return name in self._read.imported


@dataclass(frozen=True)
class _Read:
    calls: tuple[Call, ...] = ()
    functions: tuple[Function, ...] = ()
    assignments: tuple[Assignment, ...] = ()
    bases: tuple[tuple[str, tuple[str, ...]], ...] = ()
    imported: frozenset[str] = frozenset()
    texts: tuple[Text, ...] = ()
    read: tuple[str, ...] = ()
    classes: tuple[tuple[str, str], ...] = ()


@lru_cache(maxsize=16)
def _read(text: str, plain: bool = False) -> _Read:
    try:
        tree = ast.parse(text)
    except (SyntaxError, ValueError, RecursionError):
        return _Read()
    naming = _Plain(tree)
    if plain:
        tree = naming.visit(tree)
    kept = _dicts(tree)
    around = {child: parent for parent in ast.walk(tree) for child in ast.iter_child_nodes(parent)}
    nodes = list(_in_order(tree))
    imported = frozenset(
        (alias.asname or alias.name).split(".")[0]
        for node in nodes
        if isinstance(node, ast.Import | ast.ImportFrom)
        for alias in node.names
    )
    return _Read(
        tuple(_call(node, around, kept) for node in nodes if isinstance(node, ast.Call)),
        tuple(_function(node, around) for node in nodes if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)),
        tuple(each for node in nodes for each in _assigned(node, around)),
        tuple((node.name, tuple(map(ast.unparse, node.bases))) for node in nodes if isinstance(node, ast.ClassDef)),
        imported,
        tuple(
            Text(node.lineno, ast.unparse(node), parts)
            for node in nodes
            if isinstance(node, ast.expr) and (parts := _parts(node, around))
        ),
        tuple(node.id for node in nodes if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load)),
        tuple(naming.classes()),
    )


class _Plain(ast.NodeTransformer):
    """Puts the name of each imported class in place of what the file calls it."""

    def __init__(self, tree: ast.Module) -> None:
        self._tree = tree
        imports = [node for node in ast.walk(tree) if isinstance(node, ast.Import | ast.ImportFrom)]
        every = [(node, alias) for node in imports for alias in node.names]
        self._roots = {(alias.asname or alias.name).split(".")[0] for _, alias in every}
        self._renamed = {
            alias.asname: alias.name
            for node, alias in every
            if isinstance(node, ast.ImportFrom) and alias.asname and alias.name[:1].isupper()
        }

    def classes(self) -> Iterator[tuple[str, str]]:
        """Every class that is imported under another name, or by its module: as it is written, and its own name."""
        yield from self._renamed.items()
        for node in ast.walk(self._tree):
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


def _in_order(node: ast.AST) -> Iterator[ast.AST]:
    yield node
    for child in ast.iter_child_nodes(node):
        yield from _in_order(child)


def _call(node: ast.Call, around: Mapping[ast.AST, ast.AST], dicts: Mapping[str, Mapping[str, ast.expr]]) -> Call:
    named: dict[str, ast.expr] = {}
    for each in node.keywords:
        if each.arg:
            named[each.arg] = each.value
        elif isinstance(each.value, ast.Name):
            named |= dicts.get(each.value.id, {})
    parent = around.get(node)
    kept = parent.targets[0] if isinstance(parent, ast.Assign) and parent.value is node else None
    tests = tuple(
        Line(each.lineno, f"if {ast.unparse(each.test)}:")
        for each, child in _steps_out(node, around)
        if isinstance(each, ast.If) and child not in each.orelse
    )
    return Call(
        name=_last_name(node.func),
        line=node.lineno,
        code=ast.unparse(node),
        given=tuple(map(ast.unparse, node.args)),
        named={name: ast.unparse(value) for name, value in named.items()},
        within=_within(node, around),
        kept=ast.unparse(kept) if kept is not None else "",
        tests=tests,
        lines={name: value.lineno for name, value in named.items()},
    )


def _function(node: ast.FunctionDef | ast.AsyncFunctionDef, around: Mapping[ast.AST, ast.AST]) -> Function:
    owner = next((each.name for each in _parents(node, around) if isinstance(each, ast.ClassDef)), "")
    inside = list(ast.walk(node))
    arguments = tuple(each.arg for each in node.args.args if each.arg not in ("self", "cls"))
    called = frozenset(_last_name(each.func) for each in inside if isinstance(each, ast.Call))
    texts = frozenset(each.value for each in inside if isinstance(each, ast.Constant) and isinstance(each.value, str))
    return Function(node.name, node.lineno, owner, arguments, called, texts, ast.unparse(node))


def _assigned(node: ast.AST, around: Mapping[ast.AST, ast.AST]) -> Iterator[Assignment]:
    if isinstance(node, ast.Assign):
        targets, value = node.targets, node.value
    elif isinstance(node, ast.AnnAssign) and node.value is not None:
        targets, value = [node.target], node.value
    elif isinstance(node, ast.AugAssign):
        targets, value = [node.target], ast.BinOp(node.target, node.op, node.value)
    else:
        return
    for target in targets:
        constant = isinstance(value, ast.Constant)
        yield Assignment(node.lineno, ast.unparse(target), ast.unparse(value), _within(node, around), constant)


def _parts(node: ast.AST, around: Mapping[ast.AST, ast.AST]) -> tuple[str, ...]:
    """The parts of a text that is put together; none where this is no such text, or only a part of one."""
    match node:
        case ast.JoinedStr():
            return tuple(
                ast.unparse(each.value) if isinstance(each, ast.FormattedValue) else ast.unparse(each)
                for each in node.values
            )
        case ast.BinOp(op=ast.Add()) if not isinstance(around.get(node), ast.BinOp):
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


def _steps_out(node: ast.AST, around: Mapping[ast.AST, ast.AST]) -> Iterator[tuple[ast.AST, ast.AST]]:
    """Each parent, from the inside out, with the child that leads to the node."""
    while (parent := around.get(node)) is not None:
        yield parent, node
        node = parent


def _parents(node: ast.AST, around: Mapping[ast.AST, ast.AST]) -> Iterator[ast.AST]:
    while (parent := around.get(node)) is not None:
        yield parent
        node = parent


def _within(node: ast.AST, around: Mapping[ast.AST, ast.AST]) -> str:
    functions = (each for each in _parents(node, around) if isinstance(each, ast.FunctionDef | ast.AsyncFunctionDef))
    return next((each.name for each in functions), "")


def _last_name(called: ast.expr) -> str:
    return called.attr if isinstance(called, ast.Attribute) else called.id if isinstance(called, ast.Name) else ""


UNREAD = Source()
"""A source that says nothing."""


def read(trace: Trace) -> Source:
    """The learner's file that was started."""
    return Source(trace.sources.get(trace.file, ""))
