"""What can keep the app from being served."""

from __future__ import annotations


class ServeError(Exception):
    """The app cannot be served; the message is one line. `hint` says what to do about it."""

    def __init__(self, what: str, hint: str) -> None:
        super().__init__(what)
        self.hint = hint


class NoAddress(ServeError):
    """The host that was asked for is none of this machine's addresses."""
