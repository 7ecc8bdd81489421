"""The grammar of `ros2`, as in ros2cli: commands, verbs and the value types of options."""

from __future__ import annotations

import argparse
import importlib
from collections.abc import Callable, Mapping, Sequence
from typing import Any

PACKAGE = __name__.rpartition(".")[0]

Fill = Callable[[argparse.ArgumentParser], None]


class LazyParser(argparse.ArgumentParser):
    """A parser that adds its arguments on first use, so that only the verb that was typed is imported."""

    def __init__(self, *, fill: Fill | None = None, **options: Any) -> None:
        options.setdefault("formatter_class", argparse.RawDescriptionHelpFormatter)
        super().__init__(**options)
        self._fill = fill

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        self.fill()
        return super().parse_known_args(args, namespace)

    def fill(self) -> None:
        """Add the arguments now, if that has not been done yet."""
        if self._fill is not None:
            fill, self._fill = self._fill, None
            fill(self)

    def fill_for(self, words: Sequence[str]) -> None:
        """Fill this parser and those of the command and verb named in `words`."""
        self.fill()
        for action in self._actions:
            if isinstance(action, argparse._SubParsersAction):
                for position, word in enumerate(words):
                    if isinstance(chosen := action.choices.get(word), LazyParser):
                        return chosen.fill_for(words[position + 1 :])


def add_choices(parser: argparse.ArgumentParser, helps: Mapping[str, str], module_of: Callable[[str], str]) -> None:
    """Add a subparser for each name in `helps`; `module_of` returns the name of the module that fills it.

    A module has `add_arguments(parser)` and `main(arguments)`; a command with verbs has `VERBS` instead of `main`.
    """
    width = max(map(len, helps))
    listed = "".join(f"{name.ljust(width)}  {text}\n" for name, text in sorted(helps.items()))
    metavar = f"Call `{parser.prog} <command> -h` for more detailed usage."
    choices = parser.add_subparsers(title="Commands", description=listed, metavar=metavar, parser_class=LazyParser)
    # Not required: without a choice, the help is shown.
    for name, text in sorted(helps.items()):
        choices.add_parser(name, description=text, fill=_filler_for(module_of(name)), prog=f"{parser.prog} {name}")
    parser.set_defaults(run=lambda _: parser.print_help())


def _filler_for(module_name: str) -> Fill:
    def fill(parser: argparse.ArgumentParser) -> None:
        module = importlib.import_module(module_name)
        if hasattr(module, "add_arguments"):
            module.add_arguments(parser)
        if verbs := getattr(module, "VERBS", None):
            add_choices(parser, verbs, lambda verb: f"{module_name}.{verb}")
        else:
            parser.set_defaults(run=module.main)

    return fill


def complete_with(action: argparse.Action, completer: Callable[..., Sequence[str]]) -> None:
    """Complete an argument on Tab. `completer` is called with `prefix` and `parsed_args`."""
    action.completer = completer  # type: ignore[attr-defined]  # the attribute that argcomplete looks for


def positive_int(text: str) -> int:
    """Parse an option that takes a whole number above 0."""
    if (value := _int_or_negative(text)) <= 0:
        raise argparse.ArgumentTypeError("value must be a positive integer")
    return value


def unsigned_int(text: str) -> int:
    """Parse an option that takes a whole number, 0 included."""
    if (value := _int_or_negative(text)) < 0:
        raise argparse.ArgumentTypeError("value must be non-negative integer")
    return value


def nonnegative_int(text: str) -> int:
    """Like `unsigned_int`, but with the error message that argparse builds from this function's name."""
    if (value := int(text)) < 0:
        raise ValueError
    return value


def positive_float(text: str) -> float:
    """Parse an option that takes a number above 0."""
    try:
        value = float(text)
    except ValueError:
        raise argparse.ArgumentTypeError("Expects a floating point number") from None
    if not value > 0.0:
        raise argparse.ArgumentTypeError("Value must be positive")
    return value


def _int_or_negative(text: str) -> int:
    try:
        return int(text)
    except ValueError:
        return -1
