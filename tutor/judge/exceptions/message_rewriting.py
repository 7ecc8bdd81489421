"""Edits of known exceptions that concern message types and their fields."""

from __future__ import annotations

import ast
import re
from collections.abc import Sequence

from tutor.judge import edits
from tutor.judge.edits import Edit
from tutor.judge.exceptions.callback_rewriting import service_callbacks
from tutor.judge.exceptions.log_rewriting import receiver
from tutor.judge.known_exception import Words
from tutor.judge.source import SourceFile, called_name, syntax_nodes

_MESSAGE_TYPES = {"float": "Float64", "int": "Int64", "str": "String", "bool": "Bool"}
"""The message types of std_msgs that hold Python's own types in their field `data`."""


def types_first(text: str, words: Words) -> Sequence[Edit]:
    """Swap type and name in each call that creates a publisher, subscription, service or client with the name first."""
    swaps: list[tuple[ast.expr, str]] = []
    for call in syntax_nodes(text):
        if not isinstance(call, ast.Call) or not re.fullmatch(r"create_(?!timer|rate)\w+", called_name(call)):
            continue
        name, kind = (*call.args, None, None)[:2]
        last = ast.unparse(kind).rpartition(".")[2] if isinstance(kind, ast.Name | ast.Attribute) else ""
        first = ast.unparse(name).rpartition(".")[2] if name is not None else ""
        if name is None or kind is None or not _looks_like_type(last) or _looks_like_type(first):
            continue
        swaps += [(name, ast.unparse(kind)), (kind, ast.unparse(name))]
    return edits.replace_nodes(text, *swaps)


def message_types(text: str, words: Words) -> Sequence[Edit]:
    """Use a message type for a topic in place of Python's own type, and put what is published into its field."""
    file = SourceFile(text)
    swaps: list[tuple[ast.expr, str]] = []
    imported_names: set[str] = set()
    for call in file.calls("create_publisher", "create_subscription"):
        kind = ast.unparse(call.args[0]) if call.args else ""
        if kind not in _MESSAGE_TYPES:
            continue
        name, publisher = _MESSAGE_TYPES[kind], file.assigned_to(call)
        imported_names.add(name)
        swaps.append((call.args[0], name))
        swaps += [
            (each.args[0], f"{name}(data={ast.unparse(each.args[0])})")
            for each in file.calls("publish")
            if publisher and receiver(each) == publisher and len(each.args) == 1
        ]
    added = [edits.add_import(text, f"from std_msgs.msg import {name}") for name in sorted(imported_names)]
    return [*edits.replace_nodes(text, *swaps), *(edit for each in added for edit in each)]


def _looks_like_type(name: str) -> bool:
    return name[:1].isupper() and not name.isupper()


def fields(text: str, words: Words) -> Sequence[Edit] | None:
    """Replace each field that the message does not have by its only one, in this function and in all like it.

    A text for an integer field is logged as an error instead, or used where the field is read below, and a truth
    value is left out, or 0.
    """
    file, line = SourceFile(text), int(words["number"])
    used = [each for each in file.nodes if isinstance(each, ast.Attribute)]
    messages = {ast.unparse(each.value) for each in used if each.lineno == line and each.attr == words["field"]}
    functions = [file.function_at(line), *(service_callbacks(text) if words["name"].endswith("_Response") else [])]
    wrong = [
        each
        for each in used
        if ast.unparse(each.value) in messages and each.attr != words["found"] and not each.attr.startswith("get_")
        if file.function_around(each) in functions
    ]
    assigned = [
        each
        for each in file.nodes
        if isinstance(each, ast.Assign) and each.targets[0] in wrong and words["name"] == "AddTwoInts_Response"
    ]
    changed: list[Edit] = []
    swaps: list[tuple[ast.expr, str]] = []
    for each in assigned:
        if _is_text(each.value) and (reads := _reads_below(file, each, wrong)):
            swaps += [(read, ast.unparse(each.value)) for read in reads]
            changed.append(edits.remove_statement(text, each))
        elif _is_text(each.value) and file.class_of(each) is not None:
            changed.append(edits.replace_statement(each, f"self.get_logger().error({ast.unparse(each.value)})"))
        elif isinstance(each.value, ast.Constant) and isinstance(each.value.value, bool):
            if len(file.block_of(each)) > 1:
                changed.append(edits.remove_statement(text, each))
            else:
                swaps.append((each.value, "0"))
    lines = {edit.first for edit in changed}
    swapped = {node for node, _ in swaps}
    swaps += [
        (each, f"{ast.unparse(each.value)}.{words['found']}")
        for each in wrong
        if each.lineno not in lines and each not in swapped
    ]
    return [*edits.replace_nodes(text, *swaps), *changed]


def _reads_below(file: SourceFile, assigned: ast.Assign, among: Sequence[ast.Attribute]) -> list[ast.Attribute]:
    """Where an assigned attribute is read below, in the same block."""
    block = file.block_of(assigned)
    below = {id(node) for each in block[block.index(assigned) + 1 :] for node in ast.walk(each)}
    target = ast.unparse(assigned.targets[0])
    return [
        each for each in among if id(each) in below and isinstance(each.ctx, ast.Load) and ast.unparse(each) == target
    ]


def _is_text(value: ast.expr) -> bool:
    return isinstance(value, ast.JoinedStr) or (isinstance(value, ast.Constant) and isinstance(value.value, str))
