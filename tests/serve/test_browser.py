"""One lesson in a real browser, by its keys: run, check, tick, export. Asserts on what is then on disk."""

from __future__ import annotations

import asyncio
import os
import signal
import sys
from pathlib import Path

import pytest

from tests.running import is_running
from tests.serve.chromium import LIMIT_S, PROGRAM, browser, wait_until
from tutor.content import load_course
from tutor.judge.verdict import Status
from tutor.workspace import Workspace

SERVE = "import sys; from tutor.cli import main; sys.exit(main(['serve', '--port', '0', '--workspace', sys.argv[1]]))"


@pytest.mark.skipif(PROGRAM is None, reason="there is no chromium on this machine")
@pytest.mark.timeout(300)
async def test_one_lesson_in_a_browser(tmp_path: Path) -> None:
    workspace = Workspace(tmp_path / "ws")
    lesson = load_course().find("i1.1")
    node = workspace.path_of("temperature_publisher.py")
    server = await asyncio.create_subprocess_exec(
        *(sys.executable, "-c", SERVE, str(workspace.root)),
        stdout=asyncio.subprocess.PIPE,
        stderr=asyncio.subprocess.PIPE,
        env={
            **os.environ,
            "HOME": str(tmp_path),
            "ROS_DOMAIN_ID": "93",
            "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        },
    )
    assert server.stdout is not None
    try:
        address = (await server.stdout.readline()).decode().split()[-1]
        async with browser(tmp_path) as page:
            await page.call("Page.navigate", url=address)
            await page.sees("Press Enter")
            await page.sees("Another folder")  # the keys, before the first one is pressed
            # The workspace exists, and the criteria are shown, by name only where there is no room for more.
            await page.press_for("publishes, range, random", "Enter")
            assert workspace.progress().read().of("i1.1").started_at

            node.write_text(lesson.files[0].solution.read_text())
            await page.press("r")
            await wait_until(lambda: is_running(node), "the node runs")
            await page.press("r")
            await wait_until(lambda: not is_running(node), "the node is stopped")

            await page.press("c")
            await wait_until(lambda: workspace.progress().read().of("i1.1").attempts, "the check is over")
            assert workspace.progress().read().of("i1.1").best is Status.PASSED

            await page.press_for("Tick", "6")  # the footer shows it once an item has the focus
            await page.press(" ")
            await wait_until(lambda: workspace.progress().read().ticks, "an item is ticked")
            await page.press_for("Export the checklist", "x")
            await page.press("Enter")
            exported = workspace.root / "checklist.md"
            await wait_until(exported.is_file, "the checklist is exported")
            text = exported.read_text()
            assert text.count("- [x] ") == 1
            assert "i1.1" in text
            assert "passed" in text

            await page.press_for("6 of 6 passed", "Escape")
            await page.press("r")
            await wait_until(lambda: is_running(node), "the node runs")

            await page.press_for("(ROS 2: ws)", "7")
            for letter in "cd src; echo $$ > new; mv new shell":
                await page.press(letter)
            await page.press("Enter")
            await wait_until((workspace.root / "src" / "shell").is_file, "the terminal's shell does what is typed")

            elsewhere = [url for url in page.requested if not url.startswith((address, address.replace("http", "ws")))]
            assert elsewhere == []
            assert page.complaints == []
        await wait_until(lambda: not is_running(node), "closing the page ends its node")
        shell = int((workspace.root / "src" / "shell").read_text())
        await wait_until(lambda: not Path(f"/proc/{shell}").exists(), "and the shell in its terminal")
        server.send_signal(signal.SIGINT)
        async with asyncio.timeout(LIMIT_S):
            await server.communicate()
        assert server.returncode == 130
    finally:
        if server.returncode is None:
            server.kill()
            await server.communicate()
