"""`ros-tutor shell`: a shell with ROS 2 and the workspace sourced, in the same ROS domain as the app."""

from __future__ import annotations

import argparse
import shlex
import signal
import subprocess
import sys

from tutor.cli import context, terminal
from tutor.cli.interfaces import build_interfaces
from tutor.errors import UsageError


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add `[-c COMMAND]`."""
    parser.add_argument("-c", dest="line", metavar="COMMAND", help="run this command line in it, then exit")


def run(arguments: argparse.Namespace) -> int:
    """Run the user's shell, or one command line in it, and return its exit code."""
    from tutor import private_folders
    from tutor.session.shell import shell_command
    from tutor.workspace import domain_of

    workspace = context.choose_workspace(arguments)
    build_interfaces(workspace)
    with private_folders.temporary("shell") as tools:
        try:
            shell = shell_command(workspace, tools)
        except LookupError as error:
            raise UsageError(str(error)) from error
        if arguments.line is not None:
            first = "" if shell.setup is None else f". {shlex.quote(str(shell.setup))}\n"
            return _run([str(shell.path), "-c", first + arguments.line], shell.env)
        where, domain = context.display_path(workspace.root), domain_of(workspace)
        terminal.say(f"ROS 2 is sourced here: workspace {where}, domain {domain}. `exit` leaves this shell.")
        return _run(list(shell.argv), shell.env)


def _run(command: list[str], env: dict[str, str]) -> int:
    from tutor.process import prctl

    sys.stdout.flush()

    def behave_as_in_a_terminal() -> None:
        for signum in (signal.SIGINT, signal.SIGHUP):  # the child would inherit ignored signals; nohup ignores SIGHUP
            signal.signal(signum, signal.SIG_DFL)
        prctl.die_with_parent(signal.SIGHUP)  # as when its terminal is closed

    # Ctrl+C is for the shell; this process only cleans up after it.
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        shell = subprocess.Popen(command, env=env, preexec_fn=behave_as_in_a_terminal)
        for signum in (signal.SIGTERM, signal.SIGHUP):
            signal.signal(signum, lambda received, _: shell.send_signal(received))
        code = shell.wait()
    except OSError as error:
        raise UsageError(f"{command[0]} cannot be started: {error.strerror}") from error
    finally:
        signal.signal(signal.SIGINT, before)
    return code if code >= 0 else 128 - code
