"""Mistakes between a class and its base class, which may be in another file of the learner's."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from tutor.judge import edits, source
from tutor.judge.causes import names
from tutor.judge.source import Function, SourceFile, called_name, calls_in, last_name
from tutor.judge.source_changes import mangled
from tutor.judge.trace import Trace
from tutor.judge.verdict import Cause


def diagnose_repeated_setup(trace: Trace, maker: str) -> Cause | None:
    """Whether a method is called by a class that its base class has called already, and calls `maker` in the end.

    `maker`: what makes the superfluous subscription or timer, such as "create_timer".
    """
    classes = [each for file in source.files(trace) for each in file.nodes if isinstance(each, ast.ClassDef)]
    for file, owner, base in _with_bases(trace):
        done = {name for name, _ in _own_calls(base)}
        for name, call in _own_calls(owner):
            if name not in done or not _reaches(name, maker, classes):
                continue
            step = edits.describe_edits_of(file, edits.remove_statement(file.text, call))
            if step is not None:
                text = f"line {call.lineno}: {ast.unparse(call)}, which {base.name}.__init__ has called already"
                return Cause("set up twice", text, step)
    return None


def diagnose_timer_of_base_class(trace: Trace) -> Cause | None:
    """Whether a class replaces a timer in another attribute than that in which its base class keeps the first one."""
    for file, owner, base in _with_bases(trace):
        first, own = _kept_timers(_methods(base).get("__init__")), _kept_timers(owner)
        made = _methods(owner).get("__init__")
        if made is None or len(first) != 1 or len(own) != 1 or _outside(own[0], owner) == _outside(first[0], base):
            continue
        placed = [each for each in made.body if _is_super_call(each) or own[0] in map(ast.unparse, _targets(each))]
        if not placed:
            continue
        kept = _outside(first[0], base)
        step = edits.describe_edits_of(file, edits.insert_after(placed[-1], f"{own[0]} = {kept}"), defined=[kept])
        if step is not None:
            text = f"{base.name} keeps its timer in {first[0]}, but {owner.name} replaces {own[0]}"
            private = f"; {first[0]} belongs to {base.name} alone" if first[0] != kept else ""
            return Cause(names.OLD_TIMER_KEPT, f"{text}, so that the first one goes on{private}", step)
    return None


def _with_bases(trace: Trace) -> Iterator[tuple[SourceFile, ast.ClassDef, ast.ClassDef]]:
    """Each class with each of its base classes that the learner has written, and the file of the former."""
    files = source.files(trace)
    classes = {each.name: each for file in files for each in file.nodes if isinstance(each, ast.ClassDef)}
    for file in files:
        for owner in (each for each in classes.values() if each in file.nodes):
            for base in (classes[name] for name in map(last_name, owner.bases) if name in classes):
                yield file, owner, base


def _kept_timers(node: ast.AST | None) -> list[str]:
    """The attributes in which timers are kept."""
    made = [each for each in ast.walk(node) if isinstance(each, ast.Assign)] if node is not None else []
    kept = (each for each in made if isinstance(each.value, ast.Call) and called_name(each.value) == "create_timer")
    return list(dict.fromkeys(ast.unparse(target) for each in kept for target in each.targets))


def _outside(attribute: str, owner: ast.ClassDef) -> str:
    """An attribute of `self`, as another class writes it."""
    first, _, name = attribute.partition(".")
    return f"{first}.{mangled(name, owner.name)}"


def _targets(statement: ast.stmt) -> list[ast.expr]:
    return statement.targets if isinstance(statement, ast.Assign) else []


def _is_super_call(statement: ast.stmt) -> bool:
    return isinstance(statement, ast.Expr) and ast.unparse(statement).startswith("super().__init__(")


def _methods(owner: ast.ClassDef) -> dict[str, Function]:
    return {each.name: each for each in owner.body if isinstance(each, Function)}


def _own_calls(owner: ast.ClassDef) -> Iterator[tuple[str, ast.Expr]]:
    """The statements in a class's `__init__` that call a method of its own: its name, and the statement."""
    made = _methods(owner).get("__init__")
    for each in made.body if made is not None else ():
        match each:
            case ast.Expr(value=ast.Call(func=ast.Attribute(value=ast.Name(id="self"), attr=name))):
                yield name, each


def _reaches(name: str, maker: str, classes: list[ast.ClassDef]) -> bool:
    """Whether a method of this name, of any of these classes, calls `maker`, if only by way of others."""
    todo, seen = [name], set[str]()
    while todo:
        current = todo.pop()
        seen.add(current)
        for method in (found for each in classes if (found := _methods(each).get(current)) is not None):
            if calls_in(method, maker):
                return True
            called = {called_name(each) for each in ast.walk(method) if isinstance(each, ast.Call)}
            todo += called - seen
    return False
