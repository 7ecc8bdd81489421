"""Arguments of forms and nouns that are of another type than these take: only a running check would notice."""

from __future__ import annotations

import types
import typing
from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields, is_dataclass
from typing import Any, Union, get_args, get_origin, get_type_hints


def reject_wrong_types(declared: Any, name: str) -> None:
    """Raise ValueError if an argument of a form, or of a noun that it takes, is of another type than that takes.

    `name`: what the message begins with, such as the criterion's id.
    """
    hints = get_type_hints(type(declared))
    for argument in fields(declared):
        value, hint = getattr(declared, argument.name), hints[argument.name]
        if get_origin(hint) is tuple and not isinstance(value, tuple | list):
            raise ValueError(f"{name}: {argument.name} takes several values, so put one into parentheses: (…,)")
        if not _fits(value, hint):
            raise ValueError(f"{name}: {argument.name} takes {_describe(hint)}, not {value!r}")
        for noun in value if isinstance(value, tuple | list) else (value,):
            if is_dataclass(noun) and type(noun).__module__ == "tutor.exercise.nouns":
                reject_wrong_types(noun, f"{name}: {type(noun).__name__}")


def _fits(value: Any, hint: Any) -> bool:
    origin, arguments = get_origin(hint), get_args(hint)
    if origin in (Union, types.UnionType):
        return any(_fits(value, choice) for choice in arguments)
    if origin is typing.Literal:
        return value in arguments
    if origin is tuple:
        return isinstance(value, tuple | list) and _items_fit(value, arguments)
    if origin in (Mapping, dict):
        key, item = arguments
        return isinstance(value, Mapping) and all(_fits(k, key) and _fits(v, item) for k, v in value.items())
    if origin is Callable:
        return callable(value)
    if hint is Any or origin is not None or not isinstance(hint, type):
        return True
    if hint is float:
        return isinstance(value, int | float) and not isinstance(value, bool)
    if hint is int:
        return isinstance(value, int) and not isinstance(value, bool)
    return isinstance(value, hint) or getattr(hint, "_is_protocol", False)


def _items_fit(values: Sequence[Any], arguments: tuple[Any, ...]) -> bool:
    if len(arguments) == 2 and arguments[1] is Ellipsis:
        return all(_fits(value, arguments[0]) for value in values)
    return len(values) == len(arguments) and all(map(_fits, values, arguments))


def _describe(hint: Any) -> str:
    """A type as an author writes it: "a Topic", "2 values, each a number", "one of 'aborted', 'succeeded'"."""
    origin, arguments = get_origin(hint), get_args(hint)
    if origin in (Union, types.UnionType):
        return " or ".join(_describe(choice) for choice in arguments)
    if origin is typing.Literal:
        return f"one of {', '.join(map(repr, arguments))}"
    if origin is tuple:
        of = [argument for argument in arguments if argument is not Ellipsis]
        count = "several values" if len(of) < len(arguments) else f"{len(of)} values"
        return f"{count}, each {' or '.join(dict.fromkeys(_describe(argument) for argument in of))}"
    if hint in (None, type(None)):
        return "None"
    if origin is Callable:
        return "a function"
    if origin in (Mapping, dict):
        return "a dict"
    name = getattr(hint, "__name__", str(hint))
    words = {"str": "a text", "int": "a whole number", "float": "a number", "bool": "True or False"}
    return words.get(name, f"{'an' if name[0] in 'AEIOU' else 'a'} {name}")
