"""The web server: the page, its static files, and the apps behind the open pages."""

from __future__ import annotations

import asyncio
import shlex
import socket
from collections.abc import Callable, Sequence
from pathlib import Path

from aiohttp import web
from textual_serve.server import Server, to_int

from tutor.serve import guard
from tutor.serve.page_session import Session

PAGE = Path(__file__).parent / "page"

WIDEST, HIGHEST = 500, 200
"""Limits in columns and lines: more than any screen has, but not too much for an app to draw."""

_GOODBYE_S = 2.0


class AppServer(Server):
    """Serves the app that `argv` starts; if there is a `token`, only to those who have it."""

    def __init__(self, argv: Sequence[str], listener: socket.socket, token: str = "") -> None:
        host, port = listener.getsockname()[:2]
        super().__init__(shlex.join(argv), host=host, port=port, title="ROS Tutor", templates_path=PAGE)
        self._argv = argv
        self._listener = listener
        self._token = token
        self._sessions: set[Session] = set()

    async def run(self, on_ready: Callable[[], None]) -> None:
        """Serve until cancelled, then end the apps. Call `on_ready` once pages can be opened."""
        # No access log: what a learner types is nobody's business.
        runner = web.AppRunner(await self._make_app(), access_log=None, shutdown_timeout=_GOODBYE_S)
        await runner.setup()
        try:
            site = web.SockSite(runner, self._listener)
            await site.start()
            on_ready()
            try:
                await asyncio.Event().wait()
            finally:
                await site.stop()  # accept no new page while the open ones are being closed
        finally:
            await asyncio.gather(*(session.stop() for session in self._sessions))
            await runner.cleanup()

    async def _make_app(self) -> web.Application:
        app = await super()._make_app()
        app.router.add_static("/page", PAGE)
        app.middlewares.append(guard.only_own_pages(self._token))
        app.on_response_prepare.append(guard.add_headers)
        return app

    async def on_startup(self, app: web.Application) -> None:
        """Override: print nothing, as the caller does that."""

    async def handle_websocket(self, request: web.Request) -> web.WebSocketResponse:
        """Start an app for a page that was opened, and end it when the page is closed."""
        page = web.WebSocketResponse(heartbeat=15, timeout=_GOODBYE_S)
        await page.prepare(request)
        width, height = (
            to_int(request.query.get(name, ""), default) for name, default in (("width", 80), ("height", 24))
        )
        session = Session(self._argv, page, self.download_manager)
        self._sessions.add(session)
        try:
            await session.start(min(max(width, 20), WIDEST), min(max(height, 5), HIGHEST))
            await self._process_messages(page, session)
        finally:
            await session.stop()
            self._sessions.discard(session)
        return page
