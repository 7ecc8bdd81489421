"""`ros2 interface show`."""

from __future__ import annotations

import argparse
import re
import sys
from pathlib import Path
from typing import Any

from tutor.sandbox import packages
from tutor.sandbox.ros2.errors import CommandError
from tutor.sandbox.ros2.interface.kinds import type_names
from tutor.sandbox.ros2.parsing import complete_with

_PRIMITIVE = re.compile(
    r"(bool|byte|char|float(32|64)|u?int(8|16|32|64)|w?string(<=\d+)?|duration|time)(\[(<=)?\d*\])?$"
)
_FIELD = re.compile(r"\s*(?P<type>[A-Za-z][\w/]*(<=\d+)?)(?P<array>\[(<=)?\d*\])?\s+[A-Za-z]\w*")
_CONSTANT = re.compile(r"\s*\w+(<=\d+)?\s+\w+\s*=")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """[--all-comments | --no-comments] TYPE."""
    group = parser.add_mutually_exclusive_group()
    group.add_argument("--all-comments", action="store_true", help="the comments of nested types as well")
    group.add_argument("--no-comments", action="store_true", help="neither comments nor empty lines")
    complete_with(
        parser.add_argument(
            "type", action=_TypeOrStdin, help="the type, such as std_msgs/msg/String; - reads it from standard input"
        ),
        type_names,
    )


def main(arguments: argparse.Namespace) -> None:
    """Print the definition, that of nested types set in below their field. Raises CommandError where there is none."""
    _show(arguments.type, comments=not arguments.no_comments, nested_comments=arguments.all_comments, depth=0)


def _show(name: str, *, comments: bool, nested_comments: bool, depth: int) -> None:
    for line in _definition(name).splitlines():
        line = line.rstrip()
        shown = line if comments else _without_comment(line)
        if shown:
            print("\t" * depth + shown)
        elif comments:
            print()
        if (nested := _nested(line, name.split("/")[0])) is not None:
            _show(nested, comments=nested_comments, nested_comments=nested_comments, depth=depth + 1)


def _definition(name: str) -> str:
    parts = name.split("/")
    if len(parts) == 3 and not all(parts):
        raise CommandError(f"Invalid name '{name}'. Must not contain empty parts")
    if len(parts) != 3:
        raise CommandError(f"Invalid name '{name}'. Expected three parts separated by '/'")
    try:
        share = packages.find_share(parts[0])
    except packages.PackageNotFound as error:
        raise CommandError(f"Unknown package '{parts[0]}'") from error
    if not (share / parts[1] / f"{parts[2]}.{parts[1]}").is_file() and (found := _in_another_prefix(name)) is not None:
        share = found
    file = share / parts[1] / f"{parts[2]}.{parts[1]}"
    try:
        return file.read_text(encoding="utf-8")
    except OSError as error:
        raise CommandError(f"Could not find the interface '{file.with_suffix('.idl')}'") from error


def _in_another_prefix(name: str) -> Path | None:
    """The share folder that has this definition, where the first prefix with the package has only part of it."""
    import os

    package, kind, last = name.split("/")
    for prefix in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep):
        share = Path(prefix) / "share" / package
        if prefix and (share / kind / f"{last}.{kind}").is_file():
            return share
    return None


def _nested(line: str, package: str) -> str | None:
    """The message type of a field that has one; types of its own package are named without it."""
    bare = line.split("#", 1)[0]
    found = _FIELD.match(bare)
    if found is None or _CONSTANT.match(bare) or _PRIMITIVE.match(found["type"]):
        return None
    where, _, last = found["type"].rpartition("/")
    return f"{where.partition('/')[0] or package}/msg/{last}"


def _without_comment(line: str) -> str:
    """A line without its comment; a `#` in a text's default is none."""
    return re.sub(r"""^((?:[^#"']|"[^"]*"|'[^']*')*?)\s*#.*$""", r"\1", line).strip()


class _TypeOrStdin(argparse.Action):
    """Reads the type from standard input where it is given as `-`."""

    def __call__(self, parser: argparse.ArgumentParser, namespace: argparse.Namespace, values: Any, *_: Any) -> None:
        if values == "-":
            if sys.stdin.isatty():
                parser.error("expected stdin pipe")
            values = sys.stdin.readline().strip()
        if not values:
            parser.error("the passed value is empty")
        setattr(namespace, self.dest, values)
