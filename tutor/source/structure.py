"""The structure of a node's file, as far as it is the usual one."""

from __future__ import annotations

import ast
import re

from tutor.source.node import NodeFile

_UNUSUAL_CALLS = ("sleep", "create_rate", "wait", "parse_args", "parse_known_args", "Thread", "Timer", "partial")


def is_usual(file: NodeFile) -> bool:
    """Whether a node has the usual structure: one class, its timer kept in an attribute, its callbacks methods."""
    setup, timer, tick = file.setup, file.first_timer, file.timer_callback
    owner = file.class_of(setup) if setup is not None else None
    if owner is None or timer is None or tick is None or tick is setup or file.class_of(tick) is not owner:
        return False
    has_loop = any(isinstance(node, ast.While) for node in file.nodes)
    return (
        file.node == "self"
        and not has_loop
        and re.fullmatch(r"self\.\w+", file.assigned_to(timer)) is not None
        and len([node for node in file.tree.body if isinstance(node, ast.ClassDef)]) == 1
        and not file.calls(*_UNUSUAL_CALLS)
    )
