"""What a change of a file does to it: whether it changes anything, and whether the file is still sound."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator

from pyflakes import checker, messages

from tutor.judge.source import Function, SourceFile, last_name
from tutor.judge.syntax_tree import compile_quietly, parse

_NODE_ATTRIBUTES = {
    "add_on_set_parameters_callback",
    "add_post_set_parameters_callback",
    "create_client",
    "create_publisher",
    "create_rate",
    "create_service",
    "create_subscription",
    "create_timer",
    "declare_parameter",
    "declare_parameters",
    "destroy_node",
    "destroy_timer",
    "executor",
    "get_clock",
    "get_logger",
    "get_name",
    "get_parameter",
    "get_parameter_or",
    "has_parameter",
    "set_parameters",
}
"""Attributes inherited from `rclpy.node.Node`, as far as next steps use them."""


def differs_in_words(before: str, after: str) -> bool:
    """Whether two texts of Python code differ in more than layout, quotation marks and comments.

    Text that is no valid Python differs in anything but blank lines and the spacing within lines.
    """
    one, other = SourceFile(before).tree, SourceFile(after).tree
    if one.body and other.body:
        return ast.dump(one) != ast.dump(other)

    def words(text: str) -> list[tuple[int, list[str]]]:
        return [(len(line) - len(line.lstrip()), line.split()) for line in text.splitlines() if line.strip()]

    return words(before) != words(after)


def is_sound_change(before: str, after: str, defined: Iterable[str] = ()) -> bool:
    """Whether the changed file still parses and uses no name that is undefined only since the change.

    `defined`: names that another file defines.
    """
    return parses(after) and not set(_undefined_names(after)).difference(_undefined_names(before), defined)


def attributes_of_classes(texts: Iterable[str]) -> set[str]:
    """The attributes of `self` that the classes in these files set, as a derived class writes them ("self.timer")."""
    found = set[str]()
    for text in filter(parses, texts):
        for owner in (each for each in ast.walk(parse(text)) if isinstance(each, ast.ClassDef)):
            own = (each for each in ast.walk(owner) if isinstance(each, ast.Attribute))
            kept = (each.attr for each in own if isinstance(each.ctx, ast.Store) and ast.unparse(each.value) == "self")
            found |= {f"self.{mangled(name, owner.name)}" for name in kept}
    return found


def mangled(attribute: str, owner: str) -> str:
    """An attribute's name outside of its class `owner`: one that begins with two underscores is private to it."""
    return f"_{owner.lstrip('_')}{attribute}" if attribute.startswith("__") else attribute


def _undefined_names(text: str) -> Iterator[str]:
    """The names that a file uses without defining them, attributes of `self` included ("self.publisher")."""
    tree = parse(text) if parses(text) else ast.Module([], [])
    for found in checker.Checker(tree).messages:
        if isinstance(found, messages.UndefinedName | messages.UndefinedLocal):
            yield str(found.message_args[0])
    own = [each for each in ast.walk(tree) if isinstance(each, ast.Attribute) and ast.unparse(each.value) == "self"]
    defined = {each.attr for each in own if isinstance(each.ctx, ast.Store)} | _NODE_ATTRIBUTES
    for each in ast.walk(tree):
        if isinstance(each, Function | ast.ClassDef):
            defined.add(each.name)
        elif isinstance(each, ast.Name) and isinstance(each.ctx, ast.Store):
            defined.add(each.id)  # it may be a class attribute
    yield from (f"self.{each.attr}" for each in own if each.attr not in defined)
    classes = [each for each in ast.walk(tree) if isinstance(each, ast.ClassDef)]
    bases = {last_name(base) for each in classes for base in each.bases}
    for owner in (each for each in classes if not each.bases and each.name not in bases):  # no node, nor part of one
        used = {each.attr for each in ast.walk(owner) if each in own} & _NODE_ATTRIBUTES
        yield from (f"self.{name} in {owner.name}" for name in used if not _sets(owner, name))


def _sets(owner: ast.ClassDef, name: str) -> bool:
    """Whether a class defines this method or attribute."""
    nodes = list(ast.walk(owner))
    stored = (each for each in nodes if isinstance(each, ast.Attribute | ast.Name) and isinstance(each.ctx, ast.Store))
    names = {each.attr if isinstance(each, ast.Attribute) else each.id for each in stored}
    return name in names | {each.name for each in nodes if isinstance(each, Function)}


def parses(text: str) -> bool:
    """Whether a text is valid Python."""
    try:
        compile_quietly(text)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return False
    return True
