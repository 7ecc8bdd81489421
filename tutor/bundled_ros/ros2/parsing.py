"""The grammar of `ros2`, as in ros2cli: a table of commands, verbs and their arguments, and the values of options."""

from __future__ import annotations

import argparse
import importlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

_PACKAGE = __name__.rpartition(".")[0]

Completer = Callable[..., Sequence[str]]
"""Called with `prefix` and `parsed_args`, for completion on Tab."""


@dataclass(frozen=True, slots=True)
class Argument:
    """An argument of a command or verb, as argparse takes it."""

    names: tuple[str, ...]
    options: Mapping[str, Any]
    complete: Completer | None

    def add_to(self, container: Any) -> None:
        """Add the argument to a parser or a group of one."""
        action = container.add_argument(*self.names, **self.options)
        if self.complete is not None:
            action.completer = self.complete  # the attribute that argcomplete looks for


class OneOf:
    """Arguments of which at most one may be given."""

    def __init__(self, *arguments: Argument) -> None:
        self._arguments = arguments

    def add_to(self, parser: argparse.ArgumentParser) -> None:
        """Add the arguments to a parser."""
        group = parser.add_mutually_exclusive_group()
        for item in self._arguments:
            item.add_to(group)


class Verb:
    """What a verb, or a command without verbs, does: `run` returns its exit code, or None for 0."""

    def __init__(self, run: Callable[[argparse.Namespace], int | None], *arguments: Argument | OneOf) -> None:
        self.run = run
        self.arguments = arguments


Verbs = Mapping[str, tuple[str, Verb | str]]
"""The help text of each verb, and the Verb itself or the module whose GRAMMAR has it."""


class Group:
    """A command with verbs."""

    def __init__(self, verbs: Verbs, *arguments: Argument) -> None:
        self.verbs = verbs
        self.arguments = arguments


def argument(*names: str, complete: Completer | None = None, **options: Any) -> Argument:
    """Describe an argument; `options` are those of argparse."""
    return Argument(names, options, complete)


def flag(*names: str, **options: Any) -> Argument:
    """Describe an option without a value."""
    return Argument(names, {"action": "store_true", **options}, None)


class LazyParser(argparse.ArgumentParser):
    """A parser that adds its arguments on first use, so that only the verb that was typed is imported."""

    def __init__(self, *, fill: Callable[[argparse.ArgumentParser], None], **options: Any) -> None:
        super().__init__(formatter_class=argparse.RawDescriptionHelpFormatter, **options)
        self._fill: Callable[[argparse.ArgumentParser], None] | None = fill

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


def fill(parser: argparse.ArgumentParser, grammar: Verb | Group) -> None:
    """Add the arguments of a verb to its parser, or those of a group and its verbs."""
    for item in grammar.arguments:
        item.add_to(parser)
    if isinstance(grammar, Verb):
        parser.set_defaults(run=grammar.run)
        return
    helps = {name: text for name, (text, _) in sorted(grammar.verbs.items())}
    width = max(map(len, helps))
    listed = "".join(f"{name.ljust(width)}  {text}\n" for name, text in helps.items())
    metavar = f"Call `{parser.prog} <command> -h` for more detailed usage."
    choices = parser.add_subparsers(title="Commands", description=listed, metavar=metavar, parser_class=LazyParser)
    # Not required: without a choice, the help is shown.
    for name, text in helps.items():
        fill_choice = _filler(name, grammar.verbs[name][1])
        choices.add_parser(name, description=text, fill=fill_choice, prog=f"{parser.prog} {name}")
    parser.set_defaults(run=lambda _: parser.print_help())


def _filler(name: str, grammar: Verb | str) -> Callable[[argparse.ArgumentParser], None]:
    def fill_choice(parser: argparse.ArgumentParser) -> None:
        if isinstance(grammar, Verb):
            fill(parser, grammar)
        else:
            fill(parser, importlib.import_module(f"{_PACKAGE}.{grammar}").GRAMMAR[name])

    return fill_choice


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
