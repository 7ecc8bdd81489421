"""Tracebacks as Python really writes them, without starting a process."""

from __future__ import annotations

import linecache
import traceback
from types import CodeType, TracebackType

OWN = "/home/me/ws/node.py"


def crash(source: str, path: str = OWN) -> str:
    """What Python writes to stderr for an exception that nothing in `source` catches."""
    linecache.cache[path] = (len(source), None, source.splitlines(keepends=True), path)
    try:
        code: CodeType = compile(source, path, "exec")
    except SyntaxError as error:  # of the main file: Python has no frame to show
        return "".join(traceback.format_exception_only(error))
    try:
        exec(code, {"__name__": "__main__"})
    except BaseException as error:
        _drop_our_frames(error)
        return "".join(traceback.format_exception(error))
    raise AssertionError("the source raises nothing")


def _drop_our_frames(error: BaseException | None) -> None:
    while error is not None:
        step: TracebackType | None = error.__traceback__
        while step is not None and step.tb_frame.f_code.co_filename == __file__:
            step = step.tb_next
        error.__traceback__ = step
        error = error.__cause__ or error.__context__
