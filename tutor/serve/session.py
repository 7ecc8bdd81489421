"""One page that is open, and the app behind it."""

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
"""How long an app may take to save, and to end the learner's node and a check, in seconds. Then it is killed."""


class Session(AppService):
    """An app in a process of its own, which lives as long as its page."""

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
        """Start the app, without a shell, and away from our Ctrl+C: it is asked to leave, and then saves first."""
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
        """Carry what the app draws to the page, until the app ends; then the page is closed, too."""
        await super().run()
        await self._close_page()

    async def stop(self) -> None:
        """Have the app save, end what it runs, and leave; wait for that. May be called more than once."""
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

    # A page that is gone must not keep the app's output from being read: the app would hang in its last words.

    async def _send_bytes(self, data: bytes) -> None:
        with contextlib.suppress(ConnectionError):
            await self._page.send_bytes(data)

    async def _send_text(self, text: str) -> None:
        with contextlib.suppress(ConnectionError):
            await self._page.send_str(text)

    async def _close_page(self) -> None:
        with contextlib.suppress(ConnectionError):
            await self._page.close()
