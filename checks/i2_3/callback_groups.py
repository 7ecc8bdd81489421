"""I2.3: the callback groups of the timer and the service, and the edits that give them separate ones."""

from __future__ import annotations

import ast

from checks.i2_3.rewriting import service, timer
from tutor.judge.edits import Edit, replace_node
from tutor.judge.rewriting.node import NodeFile, argument
from tutor.judge.source import Function, called_name, calls_in, values_of
from tutor.judge.verdict import Cause

_GROUP = "callback_group"
_GROUPS = "ReentrantCallbackGroup", "MutuallyExclusiveCallbackGroup"


def group_edits(file: NodeFile) -> list[Edit]:
    """Give each timer that shares the service's callback group another one: what one timer logs, another may count."""
    shared, service_call = timers_in_its_group(file), service(file)
    own = group_of(service_call) if service_call is not None else ""
    name, imported = file.import_name("ReentrantCallbackGroup", "rclpy.callback_groups")
    taken = {"", *_names_of(file, own)}
    others = [each for each in file.calls(*_GROUPS) if file.assigned_to(each) not in taken]
    found: list[Edit] = []
    for timer_call in shared:
        kept = [file.assigned_to(each) for each in others if each.lineno < timer_call.lineno and _is_set_up(file, each)]
        spare = next((each for each in kept if each.startswith("self.")), "")
        found += [*([] if spare else imported), set_group(file, timer_call, spare or f"{name}()")]
    return found


def _is_set_up(file: NodeFile, group: ast.Call) -> bool:
    """Whether a group is created for certain, and not by a property, which creates it when it is first read."""
    function = file.function_around(group)
    return function is None or not function.decorator_list


def timers_in_its_group(file: NodeFile) -> list[ast.Call]:
    """The calls that create timers in the service's callback group, if that is a MutuallyExclusiveCallbackGroup."""
    service_call = service(file)
    if service_call is None or timer(file) is None or is_reentrant(file, own := group_of(service_call)):
        return []
    names = _names_of(file, own)
    return [each for each in file.timers if group_of(each) in names]


def _names_of(file: NodeFile, group: str) -> set[str]:
    """All names of a group: `a = b = MutuallyExclusiveCallbackGroup()` makes one group with two names."""
    assignments = [[ast.unparse(one) for one in each.targets] for each in file.nodes if isinstance(each, ast.Assign)]
    return {group, *(name for targets in assignments if group in targets for name in targets)}


def replace_looked_up_group(file: NodeFile) -> list[Edit]:
    """Give the timer a group of its own if its group is looked up, as in a table, or is of the learner's own class.

    It may be the service's group, or one that does not always let the timer run.
    """
    made = timer(file)
    given = _given_group(made) if made is not None else None
    values = [given, *(values_of(ast.unparse(given), file.tree) if given is not None else [])]
    other = any(isinstance(each, ast.Call) and called_name(each) not in _GROUPS for each in values)
    if made is None or not (other or isinstance(given, ast.Subscript)):
        return []
    name, imported = file.import_name("ReentrantCallbackGroup", "rclpy.callback_groups")
    return [*imported, set_group(file, made, f"{name}()")]


def set_group(file: NodeFile, call: ast.Call, group: str) -> Edit:
    """Create the timer or service of this call in another callback group."""
    given = _given_group(call)
    if given is not None:
        return replace_node(file.text, given, group)
    unpacked = [each for each in call.keywords if each.arg is None]  # a dict of options, which may hold a group
    code = ast.unparse(ast.Call(call.func, call.args, [each for each in call.keywords if each not in unpacked]))
    return replace_node(file.text, call, f"{code[:-1]}, {_GROUP}={group})")


def group_of(call: ast.Call) -> str:
    """The expression for the callback group of a timer or service; "" is the node's default group."""
    given = _given_group(call)
    code = ast.unparse(given) if given is not None else ""
    return "" if code in ("None", "self.default_callback_group") else code


def _given_group(call: ast.Call) -> ast.expr | None:
    return argument(call, 2 if called_name(call) == "create_timer" else len(call.args), _GROUP)


def is_reentrant(file: NodeFile, group: str) -> bool:
    """Whether this expression is, or is assigned, a ReentrantCallbackGroup."""
    made = {file.assigned_to(each) for each in file.calls("ReentrantCallbackGroup")} - {""}
    return "Reentrant" in group or group in made


def diagnose_late_group(file: NodeFile) -> Cause | None:
    """Whether the timer gets a group of its own that is still None when it is created.

    Only for a timer that does share a group with the service, although by the source it should not.
    """
    made = timer(file)
    given = _given_group(made) if made is not None else None
    if made is None or not isinstance(given, ast.Attribute) or group_edits(file):
        return None
    groups = [call for call in file.calls(*_GROUPS) if file.assigned_to(call) == ast.unparse(given)]
    creator = file.function_around(made)
    if len(groups) != 1 or creator is None or not _is_set_after(file, groups[0], creator):
        return None
    name, imported = file.import_name("ReentrantCallbackGroup", "rclpy.callback_groups")
    step = file.step([*imported, set_group(file, made, f"{name}()")])
    text = (
        f"line {given.lineno} creates the timer before line {groups[0].lineno} sets {ast.unparse(given)}, so that the "
        "timer, like the service, is in the node's default group, which is a MutuallyExclusiveCallbackGroup"
    )
    return Cause("callback group set too late", text, step) if step else None


def _is_set_after(file: NodeFile, group: ast.Call, creator: Function) -> bool:
    """Whether `super().__init__()` must have called `creator`, since nothing does so once the group is set."""
    init = file.function_around(group)
    if init is None or init.name != "__init__" or creator is init:
        return False
    supers = [each for each in calls_in(init, "__init__") if each.lineno < group.lineno]
    others = [
        each
        for each in file.calls(creator.name)
        if (each.lineno > group.lineno and each in ast.walk(init)) or not ast.unparse(each.func).startswith("self.")
    ]
    return bool(supers) and not others
