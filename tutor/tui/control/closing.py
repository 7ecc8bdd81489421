"""The way out: everything saved, nothing running."""

from __future__ import annotations

import asyncio

from tutor.tui.control.checks import Checks
from tutor.tui.control.files import Files
from tutor.tui.control.host import HostScreen
from tutor.tui.control.nodes import Nodes
from tutor.tui.control.pages import Pages
from tutor.tui.control.preferences import Preferences

SAVE_LIMIT_S = 5.0
"""While a question on two versions of a file is open, both are on the disk, and saving waits for the answer."""


async def close_down(
    host: HostScreen, files: Files, nodes: Nodes, checks: Checks, preferences: Preferences, pages: Pages
) -> None:
    """Save, end the check and the nodes, and wait until nothing of them is left."""
    checks.leave()
    nodes.leave()
    terminal = pages.terminal
    if terminal is not None:
        terminal.leave()
        host.model.session.keep_typed_commands(terminal.typed_commands)
    try:
        async with asyncio.timeout(SAVE_LIMIT_S):
            await files.save_all()
    except TimeoutError:
        pass
    await preferences.flush()
    if (live := pages.live) is not None:
        await live.close_down()
    busy = [worker for worker in host.workers if worker.group in ("check", "node", "progress", "terminal")]
    if busy:  # an empty list would mean all of them, and the one that follows the file never ends
        await host.app.workers.wait_for_complete(busy)
    files.leave()
    host.workers.cancel_node(host)  # whatever still reads or follows a file would find no widget to show it in
