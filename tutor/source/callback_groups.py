"""Callback groups and executors, as one file sets them up."""

from __future__ import annotations

import ast

from tutor.source.file import called_name, values_of
from tutor.source.node import NodeFile
from tutor.source.patterns import argument

GROUPS = ("ReentrantCallbackGroup", "MutuallyExclusiveCallbackGroup")
MULTI_THREADED = "MultiThreadedExecutor"


def group_of(call: ast.Call) -> str:
    """The expression for the callback group of a timer, service and so on; "" is the node's default group."""
    given = argument(call, "callback_group")
    code = ast.unparse(given) if given is not None else ""
    return "" if code in ("None", "self.default_callback_group") else code


def names_of(file: NodeFile, group: str) -> set[str]:
    """All names of a group: `a = b = MutuallyExclusiveCallbackGroup()` makes one group with two names."""
    assignments = [[ast.unparse(one) for one in each.targets] for each in file.nodes if isinstance(each, ast.Assign)]
    return {group, *(name for targets in assignments if group in targets for name in targets)}


def is_reentrant(file: NodeFile, group: str) -> bool:
    """Whether this expression is, or is assigned, a ReentrantCallbackGroup."""
    made = {file.assigned_to(each) for each in file.calls("ReentrantCallbackGroup")} - {""}
    return "Reentrant" in group or group in made


def timers_sharing_group(file: NodeFile, service: ast.Call) -> list[ast.Call]:
    """The calls that create timers in the service's callback group, unless that is reentrant."""
    own = group_of(service)
    names = names_of(file, own)
    return [] if is_reentrant(file, own) else [timer for timer in file.timers if group_of(timer) in names]


def threads_of(file: NodeFile) -> tuple[ast.Call | None, int | None]:
    """The call that makes a MultiThreadedExecutor, and its number of threads; None for each that is unknown."""
    made = next(iter(file.calls(MULTI_THREADED)), None)
    given = argument(made, "num_threads")
    if isinstance(given, ast.Name | ast.Attribute):
        values = values_of(ast.unparse(given), file.tree)
        given = values[0] if len(values) == 1 else given
    number = given.value if isinstance(given, ast.Constant) and isinstance(given.value, int) else None
    return made, number


def is_set_after(file: NodeFile, group: ast.Call, creator: ast.AST) -> bool:
    """Whether `super().__init__()` must have run `creator`, since nothing does so once the group is set."""
    init = file.function_around(group)
    if init is None or init.name != "__init__" or creator is init or not isinstance(creator, ast.FunctionDef):
        return False
    calls = [each for each in ast.walk(init) if isinstance(each, ast.Call)]
    supers = [each for each in calls if called_name(each) == "__init__" and each.lineno < group.lineno]
    later = [
        each
        for each in file.calls(creator.name)
        if (each.lineno > group.lineno and each in calls) or not ast.unparse(each.func).startswith("self.")
    ]
    return bool(supers) and not later
