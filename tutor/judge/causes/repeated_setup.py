"""A set-up method that runs twice, since both a class and its base class call it when the node is made."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from tutor.judge import edits, source
from tutor.judge.source import Function, called_name, calls_in, last_name
from tutor.judge.trace import Trace
from tutor.judge.verdict import Cause


def diagnose_repeated_setup(trace: Trace, maker: str) -> Cause | None:
    """Whether a method is called by a class that its base class has called already, and calls `maker` in the end.

    `maker`: what makes the superfluous subscription or timer, such as "create_timer".
    """
    files = source.files(trace)
    classes = {each.name: each for file in files for each in file.nodes if isinstance(each, ast.ClassDef)}
    for file in files:
        for owner in (each for each in classes.values() if each in file.nodes):
            for base in (classes[name] for name in map(last_name, owner.bases) if name in classes):
                done = {name for name, _ in _own_calls(base)}
                for name, call in _own_calls(owner):
                    if name not in done or not _reaches(name, maker, list(classes.values())):
                        continue
                    step = edits.describe_edits_of(file, edits.remove_statement(file.text, call))
                    if step is not None:
                        text = f"line {call.lineno}: {ast.unparse(call)}, which {base.name}.__init__ has called already"
                        return Cause("set up twice", text, step)
    return None


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
