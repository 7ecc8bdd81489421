"""`ros2 interface show`."""

from __future__ import annotations

import argparse
import contextlib
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tutor.bundled_ros import packages
from tutor.bundled_ros.ros2 import completion
from tutor.bundled_ros.ros2.parsing import OneOf, Verb, argument, flag
from tutor.errors import CommandError
from tutor.ros.prefixes import ament_prefixes


def _show_type(arguments: argparse.Namespace) -> None:
    """Print the definition, with nested types indented below their field. Raises CommandError if there is none."""
    _show(arguments.type, comments=not arguments.no_comments, nested_comments=arguments.all_comments, depth=0)


def _show(name: str, *, comments: bool, nested_comments: bool, depth: int) -> None:
    for text in _read_definition(name).splitlines():
        line = _Line.of(name, text.rstrip())
        shown = line.text if comments else line.without_comment()
        if shown is not None:
            print("\t" * depth + shown if shown else "")
        if line.nested is not None:
            _show(line.nested, comments=nested_comments, nested_comments=nested_comments, depth=depth + 1)


@dataclass(frozen=True, slots=True)
class _Line:
    """One line of a definition, parsed by rosidl's own parser. It sees a single line, so it recognises few comments."""

    text: str
    is_comment: bool = False
    trailing_comment: str | None = None
    nested: str | None = None

    @classmethod
    def of(cls, name: str, text: str) -> _Line:
        """Parse a line of the type `name`. Raises CommandError if it is not valid."""
        from rosidl_adapter.parser import InvalidSpecification, parse_message_string

        if text == "---":
            return cls(text)
        package, _, last = name.split("/")
        try:
            with contextlib.redirect_stderr(None):  # the parser also prints the error that it raises
                parsed = parse_message_string(package, last, text)
        except (InvalidSpecification, ValueError, TypeError) as error:
            raise CommandError(f"{name} has a line that is not a field: {text}") from error
        element = next(iter([*parsed.fields, *parsed.constants]), None)
        comments = element.annotations.get("comment") if element is not None else None
        nested = parsed.fields[0].type if parsed.fields and not parsed.fields[0].type.is_primitive_type() else None
        return cls(
            text,
            is_comment=bool(parsed.annotations["comment"]),
            trailing_comment=comments[0] if comments else None,
            nested=f"{nested.pkg_name}/msg/{nested.type}" if nested is not None else None,
        )

    def without_comment(self) -> str | None:
        """Return the line without its comment; None if nothing is left."""
        if not self.text or self.is_comment:
            return None
        if self.trailing_comment is None:
            return self.text
        return self.text[: self.text.find(self.trailing_comment) - 1].strip()


def _read_definition(name: str) -> str:
    parts = name.split("/")
    if len(parts) == 3 and not all(parts):
        raise CommandError(f"Invalid name '{name}'. Must not contain empty parts")
    if len(parts) != 3:
        raise CommandError(f"Invalid name '{name}'. Expected three parts separated by '/'")
    try:
        share = packages.find_share(parts[0])
    except packages.PackageNotFound as error:
        raise CommandError(f"Unknown package '{parts[0]}'") from error
    path = Path(parts[1]) / f"{parts[2]}.{parts[1]}"
    # The first prefix with this package may have only part of its types.
    shares = [share, *(prefix / "share" / parts[0] for prefix in ament_prefixes())]
    file = next((share / path for share in shares if (share / path).is_file()), share / path)
    try:
        return file.read_text(encoding="utf-8")
    except OSError as error:
        raise CommandError(f"Could not find the interface '{file.with_suffix('.idl')}'") from error


class _TypeOrStdin(argparse.Action):
    """Reads the type from standard input if it is given as `-`."""

    def __call__(self, parser: argparse.ArgumentParser, namespace: argparse.Namespace, values: Any, *_: Any) -> None:
        if values == "-":
            if sys.stdin.isatty():
                parser.error("expected stdin pipe")
            values = sys.stdin.readline().strip()
        if not values:
            parser.error("the passed value is empty")
        setattr(namespace, self.dest, values)


GRAMMAR = {
    "show": Verb(
        _show_type,
        OneOf(
            flag("--all-comments", help="the comments of nested types as well"),
            flag("--no-comments", help="neither comments nor empty lines"),
        ),
        argument(
            "type",
            action=_TypeOrStdin,
            complete=completion.types_of_kind(),
            help="the type, such as std_msgs/msg/String; - reads it from standard input",
        ),
    )
}
