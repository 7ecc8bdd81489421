"""`ros-tutor explain`: the page of a mistake, the list of all, or a search by words."""

from __future__ import annotations

import argparse
import sys

from tutor.cli import context, terminal
from tutor.cli.errors import PASSED
from tutor.errors import UsageError
from tutor.invocation import command


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add `[MISTAKE | WORD ...]`."""
    parser.add_argument(
        "words",
        nargs="*",
        metavar="MISTAKE",
        help="the name of a mistake, as in a report, or words to look for; without it, the list of all",
    )


def run(arguments: argparse.Namespace) -> int:
    """Print a page, the mistakes that the words fit, or all. Raises UsageError if there is none."""
    from tutor.engine.loading import load_catalogues
    from tutor.mistakes import pages

    mistakes = pages.every_mistake(load_catalogues(context.load_course(arguments)))
    if not arguments.words:
        _print_list(sorted((entry.id, entry.summary) for entry in mistakes.values()))
        terminal.say(f"`{command('explain', 'MISTAKE')}` shows the page of one")
        return PASSED
    wanted = "-".join(" ".join(arguments.words).lower().split())
    entry = mistakes.get(wanted)
    found = [entry] if entry is not None else pages.search(" ".join(arguments.words), mistakes.values())
    if not found:
        near = pages.nearest(wanted, mistakes)
        guess = f"; did you mean {' or '.join(near)}?" if near else f"; `{command('explain')}` lists all"
        raise UsageError(f"there is no mistake {' '.join(arguments.words)!r}{guess}")
    if len(found) > 1:
        _print_list([(entry.id, entry.summary) for entry in found])
        return PASSED
    if entry is None and "-" in arguments.words[0]:
        terminal.say(f"there is no mistake {wanted!r}; {found[0].id} is the one that has these words")
    heading, _, body = pages.text_of(found[0]).partition("\n")
    columns = terminal.width(sys.stdout)
    terminal.out(f"{terminal.style(heading, '1', sys.stdout)}\n{terminal.wrap(body, columns)}")
    return PASSED


def _print_list(rows: list[tuple[str, str]]) -> None:
    width = max(len(id) for id, _ in rows)
    terminal.out("".join(f"{id:<{width}}  {summary}\n" for id, summary in rows))
