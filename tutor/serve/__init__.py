"""The app in a browser: a small local web server that starts one app per open page."""

from __future__ import annotations

from tutor.serve.listening import address, is_loopback, listen

__all__ = ["address", "is_loopback", "listen"]
