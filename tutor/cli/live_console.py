"""A part of the terminal that is redrawn several times a second, on stderr."""

from __future__ import annotations

import sys
from collections.abc import Callable

from rich.console import Console, RenderableType
from rich.live import Live

from tutor.cli import terminal


def stderr_console() -> Console:
    """Return a console for stderr, in which nothing in a text is markup."""
    return Console(
        stderr=True, highlight=False, markup=False, emoji=False, no_color=not terminal.wants_color(sys.stderr)
    )


def live(console: Console, draw: Callable[[], RenderableType], refresh_hz: float, *, vanishing: bool) -> Live:
    """Return a display of what `draw` returns, not started yet, though `draw` is called at once.

    `vanishing`: it erases itself at the end.
    """
    return Live(
        console=console,
        get_renderable=draw,
        refresh_per_second=refresh_hz,
        transient=vanishing,
        redirect_stdout=False,  # stdout carries the report and may go elsewhere
        redirect_stderr=False,
    )
