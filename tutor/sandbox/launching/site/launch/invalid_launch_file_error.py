"""A launch file that cannot be loaded."""

from __future__ import annotations

from collections.abc import Sequence


class InvalidLaunchFileError(Exception):
    """No way of reading the file worked; `likely_errors` says why, way by way."""

    def __init__(self, extension: str = "", *, likely_errors: Sequence[Exception] = ()) -> None:
        super().__init__(extension)
        if not extension or not likely_errors:
            self._message = "The launch file may have a syntax error, or its format is unknown"
            return
        count = "multiple exceptions" if len(likely_errors) > 1 else "exception"
        lines = [f"Caught {count} when trying to load file of format [{extension}]:"]
        lines += [f" - {type(error).__name__}: {error}" for error in likely_errors]
        self._message = "\n".join(lines)
        self.__cause__ = likely_errors[0]

    def __str__(self) -> str:
        return self._message
