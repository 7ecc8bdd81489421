"""In which order and scope a launch file's actions are executed, as far as the source shows it."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum
from itertools import islice, takewhile

from tutor.source.file import SourceFile, called_name

_HANDLERS = ("OnProcessExit", "OnProcessStart", "OnProcessIO", "OnExecutionComplete", "OnShutdown", "TimerAction")
_ADDING = ("add_action", "add_entity", "append", "extend")
_MAX_DEPTH, _MAX_ACTIONS = 20, 500


class Reach(Enum):
    """That a setting holds for a node, or why it does not."""

    REACHED = "it holds for the node"
    TOO_LATE = "the node comes first"
    GROUP_ENDED = "its group has ended by then"
    HANDLER = "the node is started by a handler, when the group of both has ended"


@dataclass(frozen=True, slots=True)
class Action:
    """One action: the groups and handlers around it, outermost first, and its place in the order of the file."""

    call: ast.Call
    around: tuple[ast.Call, ...]
    place: int


def actions_of(file: SourceFile, *names: str) -> list[Action]:
    """The actions with these names that are part of the launch description, in order."""
    walked = islice(_Walk(file).actions(), _MAX_ACTIONS)
    found = [Action(call, around, place) for place, (call, around) in enumerate(walked)]
    return [action for action in found if called_name(action.call) in names]


def reach(setting: Action, node: Action) -> Reach:
    """Why what an action sets (a pushed namespace, a remapping) does not hold for a node; `REACHED` if it does.

    The end of a group takes back what is set in it. What a handler starts comes when the groups around have ended.
    """
    groups = tuple(call for call in setting.around if called_name(call) == "GroupAction")
    shared = len(tuple(takewhile(lambda pair: pair[0] is pair[1], zip(setting.around, node.around, strict=False))))
    if any(group not in node.around for group in groups):
        return Reach.GROUP_ENDED
    if any(called_name(call) in _HANDLERS for call in setting.around[shared:]):
        return Reach.TOO_LATE
    deferred = any(called_name(call) in _HANDLERS for call in node.around[shared:])
    if deferred and groups:
        return Reach.HANDLER
    return Reach.TOO_LATE if node.place < setting.place and not deferred else Reach.REACHED


class _Walk:
    def __init__(self, file: SourceFile) -> None:
        self._file = file

    def actions(self) -> Iterator[tuple[ast.Call, tuple[ast.Call, ...]]]:
        described = self._file.functions_named("generate_launch_description")
        for root in _returned(described[0]) if described else _statements(self._file.tree):
            yield from self._within(root, (), 0)

    def _within(
        self, part: ast.expr, around: tuple[ast.Call, ...], depth: int
    ) -> Iterator[tuple[ast.Call, tuple[ast.Call, ...]]]:
        """The calls that an expression stands for; variables and functions of the file are followed."""
        if depth > _MAX_DEPTH:
            return
        inside: list[ast.expr] = []
        match part:
            case ast.Name(id=name):
                own = self._file.functions_named(name)
                inside = [*self._kept_in(name), *(value for function in own for value in _returned(function))]
            case ast.Call():
                yield part, around
                if called_name(part) in _HANDLERS or (called_name(part) == "GroupAction" and _is_scoped(part)):
                    around = (*around, part)
                given = [
                    keyword.value for keyword in part.keywords if keyword.arg not in ("target_action", "condition")
                ]
                own = self._file.functions_named(called_name(part))
                inside = [*part.args, *given, *(value for function in own for value in _returned(function))]
            case _:
                inside = [child for child in ast.iter_child_nodes(part) if isinstance(child, ast.expr)]
        for expression in inside:
            yield from self._within(expression, around, depth + 1)

    def _kept_in(self, name: str) -> list[ast.expr]:
        """What a variable is set to, and what is added to it later."""
        found: list[ast.expr] = []
        for node in sorted(self._file.nodes, key=lambda node: getattr(node, "lineno", 0)):
            match node:
                case ast.Assign(targets=[ast.Name(id=target)], value=value) if target == name:
                    found.append(value)
                case ast.Assign(targets=[ast.Tuple(elts=targets)], value=ast.Tuple(elts=values)):
                    pairs = zip(targets, values, strict=False)
                    found += [value for target, value in pairs if ast.unparse(target) == name]
                case ast.AugAssign(target=ast.Name(id=target), value=value) if target == name:
                    found.append(value)
                case ast.Call(func=ast.Attribute(value=ast.Name(id=target), attr=added)) if target == name:
                    found += node.args if added in _ADDING else []
        return found


def _is_scoped(group: ast.Call) -> bool:
    return not any(
        keyword.arg == "scoped" and isinstance(keyword.value, ast.Constant) and not keyword.value.value
        for keyword in group.keywords
    )


def _returned(function: ast.AST) -> list[ast.expr]:
    return [node.value for node in ast.walk(function) if isinstance(node, ast.Return) and node.value is not None]


def _statements(tree: ast.Module) -> list[ast.expr]:
    return [statement.value for statement in tree.body if isinstance(statement, ast.Expr)]
