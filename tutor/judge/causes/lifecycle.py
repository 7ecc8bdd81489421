"""A lifecycle node that nothing has activated, which keeps its publishers switched off."""

from __future__ import annotations

import ast

from tutor.judge.edits import Edit, append_to_function, insert_above, insert_after, replace_node, replace_statement
from tutor.judge.rewriting.node import NodeFile, started_node
from tutor.judge.source import Function, called_name, mentions
from tutor.judge.trace import Trace
from tutor.judge.verdict import Cause

_NOT_ACTIVATED = "lifecycle node not activated"


def diagnose_lifecycle(trace: Trace) -> Cause | None:
    """Whether there is a lifecycle node that nothing has activated."""
    lifecycle_nodes = [each.node for each in trace.graph.servers if each.type == "lifecycle_msgs/srv/ChangeState"]
    if not lifecycle_nodes:
        return None
    file = started_node(trace)
    own = next((each for each in file.functions if each.name == "on_activate"), None)
    lacks_super = own is not None and not any(
        isinstance(each, ast.Call) and called_name(each) == "on_activate" for each in ast.walk(own)
    )
    call_super = _call_super(own) if lacks_super and own is not None else []
    if mentions(trace, "trigger_activate"):
        if not lacks_super:
            return None
        step = file.step(call_super) or "end on_activate with: return super().on_activate(state)"
        return Cause(_NOT_ACTIVATED, f"{lifecycle_nodes[0]} keeps its publishers switched off", step)
    return Cause(
        _NOT_ACTIVATED,
        f"{lifecycle_nodes[0]} is a lifecycle node: it does its work only once it has been configured and activated, "
        "and nothing does that here (an ordinary Node needs none of it)",
        file.step([*_activate_in_program(file), *call_super])
        or "in main(), before node is spun: node.trigger_configure(), then node.trigger_activate()",
    )


def _call_super(on_activate: Function) -> list[Edit]:
    """Let `on_activate` return `super().on_activate()`, which enables the node's publishers."""
    code = f"return super().on_activate({on_activate.args.args[-1].arg})"
    last = on_activate.body[-1]
    if isinstance(last, ast.Return):
        return [replace_statement(last, code)]
    return [append_to_function(on_activate, code)]


def _activate_in_program(file: NodeFile) -> list[Edit]:
    """Configure and activate the lifecycle node once it is created; only activate it if the program configures it."""
    for call in file.calls("trigger_configure"):
        if isinstance(call.func, ast.Attribute):
            return [insert_after(file.statement(call), f"{ast.unparse(call.func.value)}.trigger_activate()")]
    classes = [
        each.name
        for each in ast.walk(file.tree)
        if isinstance(each, ast.ClassDef) and (_has_lifecycle_base(each) or _has_transitions(each))
    ]
    for call in file.calls(*classes):
        statement, node = file.statement(call), file.assigned_to(call)
        if node:
            code = f"{node}.trigger_configure()\n{node}.trigger_activate()"
            return [insert_after(statement, code)]
        code = f"node = {ast.unparse(call)}\nnode.trigger_configure()\nnode.trigger_activate()"
        return [insert_above(statement.lineno, code), replace_node(file.text, call, "node")]
    return []


def _has_lifecycle_base(class_: ast.ClassDef) -> bool:
    return any("Lifecycle" in ast.unparse(base) for base in class_.bases)


def _has_transitions(class_: ast.ClassDef) -> bool:
    """Whether the class is a lifecycle node under another name, such as rclpy.lifecycle's Node."""
    methods = [each.name for each in class_.body if isinstance(each, ast.FunctionDef)]
    return "on_configure" in methods or "on_activate" in methods
