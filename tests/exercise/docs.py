"""Write docs/forms.md, the public interface of `tutor.exercise`, from its docstrings.

uv run python -m tests.exercise.docs
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Iterator
from dataclasses import MISSING, fields, is_dataclass
from pathlib import Path
from typing import Any

from tutor import exercise
from tutor.exercise import Form, Node

ROOT = Path(__file__).parents[2]
FILE = ROOT / "docs/forms.md"
COMMAND = "./.ci/uv run python -m tests.exercise.docs"

NOUNS = (
    "Program",
    "LaunchFile",
    "Topic",
    "GivenPublisher",
    "QoS",
    "Parameter",
    "ShownIn",
    "SetsRate",
    "SwitchesOff",
    "Service",
    "Action",
    "Asking",
    "Lifecycle",
)


def document() -> str:
    """The text of the file."""
    names = [name for name in exercise.__all__ if name not in ("Form", "Node", "Fields")]
    objects = {name: getattr(exercise, name) for name in names}
    forms = [name for name, found in objects.items() if inspect.isclass(found) and issubclass(found, Form)]
    others = [name for name, found in objects.items() if name not in (*NOUNS, *forms) and _is_documented(found)]
    parts = [
        "# What an exercise is written in",
        "All of it is imported from `tutor.exercise`; [authoring.md](authoring.md) shows how it goes together. This "
        f"file is made from the docstrings: change these, and run `{COMMAND}`.",
        "## Nouns: what the learner's node has",
        *_sections(NOUNS),
        "## Forms: criteria",
        f"Each takes these as well, by name. {_prose(Form)}",
        *_sections(forms),
        "## Functions, and what forms are given",
        *_sections(others),
        "## The running node, in a criterion that is a function",
        _prose(Node),
        *(_section(f"node.{name}", method) for name, method in _public(Node)),
    ]
    return "\n\n".join(parts) + "\n"


def _is_documented(found: object) -> bool:
    return inspect.isclass(found) or inspect.isfunction(found)


def _sections(names: tuple[str, ...] | list[str]) -> Iterator[str]:
    for name in names:
        yield _section(name, getattr(exercise, name))


def _section(name: str, found: Any) -> str:
    return f"### {name}\n\n`{name}{_signature(found)}`\n\n{_prose(found)}"


def _signature(found: Any) -> str:
    """The arguments with their types and defaults, without those that all forms have."""
    if is_dataclass(found):
        shared = {field.name for field in fields(Form)} - {"id"} if issubclass(found, Form) else set()  # type: ignore[arg-type]
        arguments = []
        for field in sorted(fields(found), key=lambda field: field.kw_only is True):
            if field.name in shared:
                continue
            default = "" if field.default is MISSING else f" = {_shown(field.default)}"
            if field.default_factory is not MISSING:
                default = f" = {field.default_factory()!r}"
            arguments.append(f"{field.name}: {field.type}{default}")
        return f"({', '.join(arguments)})"
    parameters = [parameter for parameter in inspect.signature(found).parameters.values() if parameter.name != "self"]
    return f"({', '.join(_parameter(parameter) for parameter in parameters)})"


def _parameter(parameter: inspect.Parameter) -> str:
    """A parameter as it is written: its annotation is a string already, its default is not."""
    bare = str(parameter.replace(default=inspect.Parameter.empty)).replace("'", "")
    return bare if parameter.default is inspect.Parameter.empty else f"{bare} = {_shown(parameter.default)}"


def _shown(default: object) -> str:
    """A default as an author would write it: a constant that is offered by its name, anything else as it is."""
    names = (name for name in exercise.__all__ if getattr(exercise, name) is default)
    return next(names, repr(default))


def _public(kind: type) -> Iterator[tuple[str, Callable[..., Any]]]:
    for name, method in vars(kind).items():
        if inspect.isfunction(method) and not name.startswith("_"):
            yield name, method


def _prose(found: Any) -> str:
    """The docstring as Markdown: each paragraph on one line, except for code."""
    paragraphs = re.split(r"\n{2,}", inspect.cleandoc(found.__doc__ or ""))
    return "\n\n".join(text if text.startswith("    ") else " ".join(text.split("\n")) for text in paragraphs)


def main() -> None:
    """Write the file."""
    FILE.write_text(document(), encoding="utf-8")
    print(FILE.relative_to(ROOT))


if __name__ == "__main__":
    main()
