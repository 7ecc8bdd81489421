"""The command line. `main` is the one place that prints errors and chooses exit codes."""

from __future__ import annotations

import os
import sys
import traceback
from collections.abc import Sequence

from tutor.cli import terminal
from tutor.cli.errors import INTERRUPTED, describe, exit_code


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command and return its exit code: 0 passed, 1 not passed, 2 usage, 3 fault, 130 interrupted."""
    try:
        return _run(argv)
    except KeyboardInterrupt:
        return INTERRUPTED
    except SystemExit as end:  # argparse, after --help and --version
        return end.code if isinstance(end.code, int) else 0
    except Exception as error:  # top level: whatever happened, the learner gets a single line
        if _caused_by_ctrl_c(error):
            return INTERRUPTED
        if os.environ.get("ROS_TUTOR_DEBUG") == "1":
            traceback.print_exc(file=sys.stderr)
        terminal.say(describe(error))
        return exit_code(error)


def _caused_by_ctrl_c(error: BaseException | None) -> bool:
    """Whether Ctrl+C led to this error: a library's `finally` (argparse has one) may then raise an error of its own."""
    while error is not None:
        if isinstance(error, KeyboardInterrupt):
            return True
        error = error.__cause__ or error.__context__
    return False


def _run(argv: Sequence[str] | None) -> int:
    from tutor.cli import app, completion
    from tutor.cli.global_options import read_alone
    from tutor.errors import UsageError
    from tutor.invocation import export_program_name

    export_program_name()
    if completion.is_requested():
        from tutor.cli.parser import build

        completion.answer(build)
    arguments = read_alone(argv)
    try:
        if arguments is None:
            from tutor.cli.parser import parse

            arguments = parse(argv)
        if arguments.command is None:
            return app.run(arguments)
        if arguments.plain:
            raise UsageError(f"--plain takes no command: {arguments.command} writes plain text anyway")
        code: int = arguments.run(arguments)
        return code
    except Exception as error:
        if not _caused_by_ctrl_c(error):
            from tutor.cli.error_documents import write_error_document

            write_error_document(error, arguments, sys.argv[1:] if argv is None else argv)
        raise
