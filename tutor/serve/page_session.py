"""An open page and the app behind it."""

from __future__ import annotations

import asyncio
import contextlib
import signal
from asyncio.subprocess import PIPE, Process
from collections.abc import Sequence

from aiohttp import web
from textual_serve.app_service import AppService
from textual_serve.download_manager import DownloadManager

LEAVE_LIMIT_S = 20.0
"""Time for an app to save and to end the learner's node and check. After that, it is killed."""


class Session(AppService):
    """An app in a separate process, which lives as long as its page."""

    def __init__(self, argv: Sequence[str], page: web.WebSocketResponse, downloads: DownloadManager) -> None:
        super().__init__(
            "",
            write_bytes=self._send_bytes,
            write_str=self._send_text,
            close=self._close_page,
            download_manager=downloads,
        )
        self._argv = argv
        self._page = page
        self._ending: asyncio.Task[None] | None = None

    async def _open_app_process(self, width: int = 80, height: int = 24) -> Process:
        """Start the app without a shell, and out of reach of our Ctrl+C, so that it can save when we stop it."""
        self._process = await asyncio.create_subprocess_exec(
            *self._argv,
            stdin=PIPE,
            stdout=PIPE,
            stderr=PIPE,
            env=self._build_environment(width, height),
            process_group=0,
        )
        self._stdin = self._process.stdin
        return self._process

    async def run(self) -> None:
        """Forward the app's output to the page until the app ends, then close the page."""
        await super().run()
        await self._close_page()

    async def stop(self) -> None:
        """Make the app save, end what it runs and exit, and wait for that. Idempotent."""
        if self._ending is None:
            self._ending = asyncio.create_task(self._stop())
        await asyncio.shield(self._ending)

    async def _stop(self) -> None:
        process = self._process
        if process is None:
            return
        await self._download_manager.cancel_app_downloads(app_service_id=self.app_service_id)
        with contextlib.suppress(ProcessLookupError):
            process.send_signal(signal.SIGTERM)
        try:
            async with asyncio.timeout(LEAVE_LIMIT_S):
                await process.wait()
        except TimeoutError:
            process.kill()
            await process.wait()
        if self._task is not None:
            await self._task

    # After the page is gone, we must keep reading the app's output, or the app would block on it while exiting.

    async def _send_bytes(self, data: bytes) -> None:
        with contextlib.suppress(ConnectionError):
            await self._page.send_bytes(data)

    async def _send_text(self, text: str) -> None:
        with contextlib.suppress(ConnectionError):
            await self._page.send_str(text)

    async def _close_page(self) -> None:
        with contextlib.suppress(ConnectionError):
            await self._page.close()
