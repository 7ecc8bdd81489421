"""Callback groups and executors, as one file sets them up."""

from __future__ import annotations

import ast

from tutor.source.file import called_name, values_of
from tutor.source.node import NodeFile
from tutor.source.patterns import argument

GROUPS = ("ReentrantCallbackGroup", "MutuallyExclusiveCallbackGroup")
MULTI_THREADED = "MultiThreadedExecutor"


UNKNOWN = "?"


def group_of(call: ast.Call) -> str:
    """The expression for the callback group of a timer, service and so on; "" is the node's default group.

    `UNKNOWN`: it may be among arguments that are unpacked there.
    """
    given = argument(call, "callback_group")
    if given is None and any(keyword.arg is None for keyword in call.keywords):
        return UNKNOWN
    code = ast.unparse(given) if given is not None else ""
    return "" if code in ("None", "self.default_callback_group") else code


def names_of(file: NodeFile, group: str) -> set[str]:
    """All names of a group: `a = b = MutuallyExclusiveCallbackGroup()` makes one group with two names."""
    assignments = [
        [ast.unparse(target) for target in node.targets] for node in file.nodes if isinstance(node, ast.Assign)
    ]
    return {group, *(name for targets in assignments if group in targets for name in targets)}


def is_reentrant(file: NodeFile, group: str) -> bool:
    """Whether this is, or is assigned, a ReentrantCallbackGroup."""
    made = [names_of(file, file.assigned_to(call)) for call in file.calls("ReentrantCallbackGroup")]
    return "ReentrantCallbackGroup" in group or (bool(group) and any(group in names for names in made))


def is_exclusive(file: NodeFile, group: str) -> bool:
    """Whether this is the node's default group, or is (assigned) a MutuallyExclusiveCallbackGroup."""
    made = [names_of(file, file.assigned_to(call)) for call in file.calls("MutuallyExclusiveCallbackGroup")]
    return not group or "MutuallyExclusive" in group or any(group in names for names in made)


def timers_sharing_group(file: NodeFile, service: ast.Call) -> list[ast.Call]:
    """The calls that create timers of the same node in the service's callback group, unless that is reentrant."""
    own = group_of(service)
    if not is_exclusive(file, own) or own.endswith(")"):  # a call makes another group each time
        return []
    names = names_of(file, own)
    return [timer for timer in file.timers if group_of(timer) in names and are_of_one_node(file, timer, service)]


def are_of_one_node(file: NodeFile, one: ast.AST, other: ast.AST) -> bool:
    """Whether two syntax nodes are in one class, or in a class and one that inherits from it, or in none."""
    classes = [owner for node in (one, other) if (owner := file.class_of(node)) is not None]
    names = {owner.name for owner in classes}
    return len(names) < 2 or any(ast.unparse(base) in names for owner in classes for base in owner.bases)


def threads_of(file: NodeFile) -> tuple[ast.Call | None, int | None]:
    """The call that makes a MultiThreadedExecutor, and its number of threads; None for each that is unknown.

    The number is 0 if none is given: then it is that of the machine's cores.
    """
    made = next(iter(file.calls(MULTI_THREADED)), None)
    given = argument(made, "num_threads")
    if isinstance(given, ast.Name | ast.Attribute):
        values = values_of(ast.unparse(given), file.tree)
        given = values[0] if len(values) == 1 else given
    match given:
        case None if made is not None and not any(keyword.arg is None for keyword in made.keywords):
            return made, 0
        case ast.Constant(value=None):
            return made, 0
        case ast.Constant(value=int() as number):
            return made, number
    return made, None


def is_set_after(file: NodeFile, group: ast.Call, creator: ast.AST) -> bool:
    """Whether `super().__init__()` must have run `creator`, since nothing does so once the group is set."""
    init = file.function_around(group)
    if init is None or init.name != "__init__" or creator is init or not isinstance(creator, ast.FunctionDef):
        return False
    calls = [node for node in ast.walk(init) if isinstance(node, ast.Call)]
    supers = [call for call in calls if called_name(call) == "__init__" and call.lineno < group.lineno]
    later = [
        call
        for call in file.calls(creator.name)
        if (call.lineno > group.lineno and call in calls) or not ast.unparse(call.func).startswith("self.")
    ]
    return bool(supers) and not later
