"""`ros-tutor serve`: the app in a browser."""

from __future__ import annotations

import argparse
import contextlib
import secrets

from tutor import interpreter
from tutor.cli import context, terminal
from tutor.cli.errors import INTERRUPTED


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add `[--port N] [--host ADDRESS]`."""
    parser.add_argument(
        "--port", metavar="N", type=_parse_port, help="the port (default: 8000, or a free one if that is taken)"
    )
    parser.add_argument(
        "--host", metavar="ADDRESS", default="127.0.0.1", help="where to listen (default: 127.0.0.1, this machine only)"
    )


def run(arguments: argparse.Namespace) -> int:
    """Serve until Ctrl+C; each open page gets its own app."""
    from tutor.errors import ServeError
    from tutor.serve import address, is_loopback, listen
    from tutor.stop_signals import Stopped, run_until_stopped

    try:
        from tutor.serve.server import AppServer
    except ImportError as error:
        raise ServeError(f"the app cannot be served: {error.name} is not installed", _INSTALL) from error

    courses = context.choose_courses(arguments)
    context.load(courses)  # a broken course is reported here, not in the browser
    more = [word for word in courses.arguments if word != "--lessons"]
    argv = interpreter.module_command("tutor.serve", str(context.choose_workspace(arguments).root.absolute()), *more)
    listener = listen(arguments.host, arguments.port)

    token = "" if is_loopback(listener) else secrets.token_urlsafe(16)

    def ready() -> None:
        terminal.out(f"ros-tutor is at {address(listener, token)}\n")
        if token:
            terminal.say(
                f"warning: {arguments.host} can be reached from other machines, and anyone who has this address can "
                "run programs as you; it is not encrypted, so use it only in a network that you trust"
            )
        terminal.say("Ctrl+C ends it")

    def stopping() -> None:
        terminal.say("ending the app and everything that was started in it")

    with listener, contextlib.suppress(Stopped):
        run_until_stopped(lambda: AppServer(argv, listener, token).run(ready), stopping)
    return INTERRUPTED


_INSTALL = "install textual-serve (in a clone: ./.ci/uv sync)"


def _parse_port(text: str) -> int:
    if text.isdecimal() and int(text) <= 65535:
        return int(text)
    raise argparse.ArgumentTypeError(f"{text!r} is not a port: a number from 0 (any that is free) to 65535")
