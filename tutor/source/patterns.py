"""Patterns of Python code with holes, matched on Python's own syntax tree.

`$x` is any expression (two of the same name must be equal), `$_` any, `$$$` any further arguments. An argument of
a call of rclpy matches whether it is passed by position or by name.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import lru_cache

from tutor.source.file import called_name


class Holes(dict[str, ast.expr]):
    """What fills the holes of a pattern, by name. True even if it has no named hole: the pattern matches."""

    def __bool__(self) -> bool:
        return True


SIGNATURES = {
    "create_timer": ("timer_period_sec", "callback", "callback_group", "clock", "autostart"),
    "create_publisher": ("msg_type", "topic", "qos_profile"),
    "create_lifecycle_publisher": ("msg_type", "topic", "qos_profile"),
    "create_subscription": ("msg_type", "topic", "callback", "qos_profile"),
    "create_service": ("srv_type", "srv_name", "callback"),
    "create_client": ("srv_type", "srv_name"),
    "create_rate": ("frequency", "clock"),
    "declare_parameter": ("name", "value", "descriptor", "ignore_override"),
    "declare_parameters": ("namespace", "parameters", "ignore_override"),
    "get_parameter": ("name",),
    "get_parameter_or": ("name", "alternative_value"),
    "add_on_set_parameters_callback": ("callback",),
    "add_post_set_parameters_callback": ("callback",),
    "add_pre_set_parameters_callback": ("callback",),
    "spin": ("node", "executor"),
    "spin_once": ("node", "executor", "timeout_sec"),
    "spin_until_future_complete": ("node", "future", "executor", "timeout_sec"),
    "init": ("args", "context", "domain_id", "signal_handler_options"),
    "MultiThreadedExecutor": ("num_threads", "context"),
    "Parameter": ("name", "type_", "value"),
}
"""The positions of the arguments of rclpy's calls, by name."""

_IGNORED_FIELDS = {"ctx", "type_comment", "kind", "type_params"}


def argument(call: ast.Call | None, name: str) -> ast.expr | None:
    """An argument of one of rclpy's calls, passed by position or by name; None if it is missing."""
    if call is None:
        return None
    for keyword in call.keywords:
        if keyword.arg == name:
            return keyword.value
    names = SIGNATURES.get(called_name(call), ())
    position = names.index(name) if name in names else len(call.args)
    given = call.args[: position + 1]
    has_rest = any(isinstance(expression, ast.Starred) for expression in given)
    return given[position] if position < len(given) and not has_rest else None


def match(pattern: str, node: ast.AST | None) -> Holes | None:
    """What fills the holes of the pattern at this node; None if it does not match."""
    holes = Holes()
    return holes if node is not None and _fits(_parsed(pattern), node, holes) else None


def find(pattern: str, tree: ast.AST) -> Iterator[tuple[ast.AST, Holes]]:
    """The nodes that match, in source order, each with what fills the holes."""
    found = [(node, holes) for node in ast.walk(tree) if (holes := match(pattern, node)) is not None]
    yield from sorted(found, key=lambda pair: (getattr(pair[0], "lineno", 0), getattr(pair[0], "col_offset", 0)))


def fill(template: str, holes: Holes) -> str:
    """The code of a template such as "1.0 / $rate"."""
    return re.sub(r"\$(\w+)", lambda hole: ast.unparse(holes[hole[1]]), template)


@lru_cache(maxsize=256)
def _parsed(pattern: str) -> ast.AST:
    code = pattern.replace("$$$", "*__rest__")
    node = ast.parse(re.sub(r"\$(\w+)", r"__hole_\1", code)).body[0]
    return node.value if isinstance(node, ast.Expr) else node


def _fits(wanted: object, given: object, holes: Holes) -> bool:
    if isinstance(wanted, ast.Name) and wanted.id.startswith("__hole_"):
        name = wanted.id.removeprefix("__hole_")
        if not isinstance(given, ast.expr):
            return False
        return name == "_" or ast.dump(holes.setdefault(name, given)) == ast.dump(given)
    if isinstance(wanted, list):
        return (
            isinstance(given, list)
            and len(wanted) == len(given)
            and all(_fits(one, other, holes) for one, other in zip(wanted, given, strict=True))
        )
    if isinstance(wanted, ast.Call) and isinstance(given, ast.Call):
        return _fits(wanted.func, given.func, holes) and _arguments_fit(wanted, given, holes)
    if isinstance(wanted, ast.AST):
        return type(wanted) is type(given) and all(
            _fits(value, getattr(given, field, None), holes)
            for field, value in ast.iter_fields(wanted)
            if field not in _IGNORED_FIELDS
        )
    return wanted == given


def _arguments_fit(wanted: ast.Call, given: ast.Call, holes: Holes) -> bool:
    names = SIGNATURES.get(called_name(given), ())

    def key(name: str | None) -> object:
        return names.index(name) if name in names else name

    has_rest = any(isinstance(expression, ast.Starred) for expression in wanted.args)
    positional = [expression for expression in wanted.args if not isinstance(expression, ast.Starred)]
    passed: dict[object, ast.expr] = dict(enumerate(given.args))
    passed |= {key(keyword.arg): keyword.value for keyword in given.keywords}
    needed: dict[object, ast.expr] = dict(enumerate(positional))
    needed |= {key(keyword.arg): keyword.value for keyword in wanted.keywords}
    for place, expression in needed.items():
        if place not in passed or not _fits(expression, passed.pop(place), holes):
            return False
    return has_rest or not passed
