"""An index like PyPI, on this machine only: a folder for each package, served over HTTP."""

from __future__ import annotations

import re
import threading
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from types import TracebackType


class _Quiet(SimpleHTTPRequestHandler):
    def log_message(self, format: str, *args: object) -> None:
        pass


class LocalIndex:
    """Serves a folder during the block: its listings are pages as the simple repository API wants them."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._server = ThreadingHTTPServer(("127.0.0.1", 0), partial(_Quiet, directory=str(folder)))

    @property
    def url(self) -> str:
        """The address of the index."""
        return f"http://127.0.0.1:{self._server.server_port}/"

    def add(self, wheels: Path) -> None:
        """Move the wheels in a folder into the index."""
        for wheel in wheels.glob("*.whl"):
            package = self._folder / re.sub(r"[-_.]+", "-", wheel.name.partition("-")[0]).lower()
            package.mkdir(parents=True, exist_ok=True)
            wheel.rename(package / wheel.name)

    def __enter__(self) -> LocalIndex:
        threading.Thread(target=self._server.serve_forever, daemon=True).start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._server.shutdown()
        self._server.server_close()
