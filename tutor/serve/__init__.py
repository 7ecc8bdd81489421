"""The app in a browser: a small web server of this machine that starts one app for each page that is open."""

from __future__ import annotations

from tutor.serve.listening import address, is_loopback, listen

__all__ = ["address", "is_loopback", "listen"]
