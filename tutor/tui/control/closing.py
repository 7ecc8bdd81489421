"""Shutdown: save everything and leave nothing running."""

from __future__ import annotations

import asyncio

from tutor.tui.control.checks import Checks
from tutor.tui.control.files import Files
from tutor.tui.control.host import HostScreen
from tutor.tui.control.nodes import Nodes
from tutor.tui.control.pages import Pages
from tutor.tui.control.preferences import Preferences

SAVE_LIMIT_S = 5.0
"""Timeout for saving: a save blocks while a conflict dialog is open, and by then both versions are on disk anyway."""


async def close_down(
    host: HostScreen, files: Files, nodes: Nodes, checks: Checks, preferences: Preferences, pages: Pages
) -> None:
    """Save, stop the check, the nodes and the terminals, and wait until they are all gone."""
    checks.shut_down()
    nodes.shut_down()
    terminal = pages.terminal
    if terminal is not None:
        terminal.close_all()
    try:
        async with asyncio.timeout(SAVE_LIMIT_S):
            await files.save_all()
    except TimeoutError:
        pass
    await preferences.flush()
    if (live := pages.live) is not None:
        await live.close_down()
    busy = [worker for worker in host.workers if worker.group in ("check", "node", "progress", "terminal")]
    if busy:  # an empty list would mean all workers, and the file watcher never ends
        await host.app.workers.wait_for_complete(busy)
    files.close()
    host.workers.cancel_node(host)  # workers that still read or watch a file would find no widget to show it in
