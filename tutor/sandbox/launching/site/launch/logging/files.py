"""The log files of one launch: a folder of its own below ROS_LOG_DIR, ROS_HOME/log or ~/.ros/log."""

from __future__ import annotations

import datetime
import logging
import os
import socket
from pathlib import Path


class LogFiles:
    """Opened at the first need. Where no folder can be made, there are none: the screen still shows everything."""

    def __init__(self) -> None:
        self._folder: Path | None = None
        self._handlers: dict[str, logging.Handler] = {}
        self._impossible = False

    @property
    def any_open(self) -> bool:
        return bool(self._handlers)

    @property
    def folder(self) -> Path:
        """The folder, made now if need be; OSError where that fails."""
        if self._folder is None:
            now = datetime.datetime.now().strftime("%Y-%m-%d-%H-%M-%S-%f")
            folder = _base() / f"{now}-{socket.gethostname()}-{os.getpid()}"
            folder.mkdir(parents=True)
            self._folder = folder
            _point_latest_to(folder)
        return self._folder

    def handler(self, file_name: str, form: str) -> logging.Handler | None:
        """The handler that writes to this file in this form ({-style); None where there are no files."""
        key = f"{file_name} {form}"
        if key not in self._handlers and not self._impossible:
            try:
                handler = logging.FileHandler(self.folder / file_name, encoding="utf-8", errors="replace")
            except OSError:
                self._impossible = True
            else:
                handler.setFormatter(logging.Formatter(form, style="{"))
                self._handlers[key] = handler
        return self._handlers.get(key)


def _base() -> Path:
    if chosen := os.environ.get("ROS_LOG_DIR"):
        return Path(chosen).expanduser()
    return Path(os.environ.get("ROS_HOME") or "~/.ros").expanduser() / "log"


def _point_latest_to(folder: Path) -> None:
    """Keep the link that ROS users know; a folder of that name is left alone."""
    latest = folder.parent / "latest"
    try:
        if latest.is_symlink():
            latest.unlink()
        latest.symlink_to(folder, target_is_directory=True)
    except OSError:
        pass
