"""A real browser with one page, driven as a person drives it, over its DevTools socket on this machine."""

from __future__ import annotations

import asyncio
import base64
import itertools
import json
import os
import re
import shutil
import signal
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager, suppress
from pathlib import Path
from typing import Any

import aiohttp

PROGRAM = shutil.which("chromium")
LIMIT_S = 60.0

_QUIET = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-3d-apis",  # drawn in software they would cost more than all the rest
    "--disable-dev-shm-usage",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-default-apps",
    "--disable-domain-reliability",
    "--disable-sync",
    "--metrics-recording-only",
    "--no-default-browser-check",
    "--no-first-run",
    "--no-pings",
    # Whatever the page or the browser asks for: no name but this machine's is ever looked up.
    "--host-resolver-rules=MAP * ~NOTFOUND , EXCLUDE 127.0.0.1",
    "--no-proxy-server",
    "--window-size=1300,800",
    "--remote-debugging-port=0",
)

_STEERING = re.compile(r"\x1b\[[0-9;?<>=$]*[ -/]*[@-~]|\x1b\][^\x07\x1b]*(?:\x07|\x1b\\\\)|\x1b.")

_KEYS = {"Enter": 13, "Escape": 27, "Tab": 9, "ArrowDown": 40, "ArrowUp": 38}


class Page:
    """The page that is open.

    `requested` holds every address that it asked for, `complaints` what the browser complained of, and `drawn` what the
    terminal in it was given to draw, without colours and cursor movements.
    """

    def __init__(self, socket: aiohttp.ClientWebSocketResponse) -> None:
        self._socket = socket
        self._numbers = itertools.count(1)
        self._answers: dict[int, asyncio.Future[dict[str, Any]]] = {}
        self.requested: list[str] = []
        self.complaints: list[str] = []
        self.drawn = ""

    async def listen(self) -> None:
        """Take in what the browser says, until it is closed."""
        async for message in self._socket:
            said = json.loads(message.data)
            if "id" in said:
                self._answers.pop(said["id"]).set_result(said)
            elif said["method"] in ("Network.requestWillBeSent", "Network.webSocketCreated"):
                self.requested.append(said["params"].get("url") or said["params"]["request"]["url"])
            elif said["method"] == "Network.webSocketFrameReceived":
                frame = said["params"]["response"]
                if frame["opcode"] == 2:
                    text = base64.b64decode(frame["payloadData"]).decode("utf-8", "replace")
                    self.drawn += _STEERING.sub("", text)
            elif said["method"] == "Log.entryAdded":
                self.complaints.append(said["params"]["entry"]["text"])
            elif said["method"] == "Runtime.exceptionThrown":
                self.complaints.append(json.dumps(said["params"]["exceptionDetails"]))

    async def do(self, method: str, **parameters: Any) -> dict[str, Any]:
        number = next(self._numbers)
        answer = self._answers[number] = asyncio.get_running_loop().create_future()
        await self._socket.send_json({"id": number, "method": method, "params": parameters})
        async with asyncio.timeout(LIMIT_S):
            said = await answer
        assert "result" in said, said
        result: dict[str, Any] = said["result"]
        return result

    async def evaluate(self, expression: str) -> Any:
        answer = await self.do("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        return answer["result"].get("value")

    async def press(self, *keys: str) -> None:
        """Press keys: letters, and the named ones of a keyboard."""
        for key in keys:
            if key in _KEYS:
                given: dict[str, Any] = {"key": key, "code": key, "windowsVirtualKeyCode": _KEYS[key]}
                text = "\r" if key == "Enter" else ""
            else:
                given, text = {"key": key}, key
            await self.do("Input.dispatchKeyEvent", type="keyDown", text=text, **given)
            await self.do("Input.dispatchKeyEvent", type="keyUp", **given)

    async def press_for(self, text: str, *keys: str) -> None:
        """Press keys, and wait until `text` is redrawn."""
        self.drawn = ""
        await self.press(*keys)
        await self.sees(text)

    async def sees(self, text: str) -> None:
        """Wait until `text` has been drawn."""
        try:
            await until(lambda: text in self.drawn, text)
        except AssertionError as error:
            raise AssertionError(f"{error}\n{self.drawn[-6000:]}\n{self.complaints}\n{self.requested}") from None

    async def picture(self, file: Path) -> None:
        file.write_bytes(base64.b64decode((await self.do("Page.captureScreenshot"))["data"]))


async def until(seen: Callable[[], object], what: str, limit_s: float = LIMIT_S) -> None:
    """Wait for evidence."""
    try:
        async with asyncio.timeout(limit_s):
            while not seen():
                await asyncio.sleep(0.05)
    except TimeoutError:
        raise AssertionError(f"not seen within {limit_s:.0f} s: {what}") from None


@asynccontextmanager
async def browser(folder: Path) -> AsyncIterator[Page]:
    """A browser with an empty page; when it is left, no process of it is."""
    assert PROGRAM is not None
    environment = {**os.environ, "HOME": str(folder), "XDG_CONFIG_HOME": str(folder), "XDG_CACHE_HOME": str(folder)}
    process = await asyncio.create_subprocess_exec(
        PROGRAM,
        *_QUIET,
        f"--user-data-dir={folder / 'profile'}",
        "about:blank",
        stdin=asyncio.subprocess.DEVNULL,
        stdout=asyncio.subprocess.DEVNULL,
        stderr=asyncio.subprocess.DEVNULL,
        env=environment,
        start_new_session=True,
    )
    try:
        port = await _port(folder / "profile" / "DevToolsActivePort")
        async with aiohttp.ClientSession() as client:
            async with client.get(f"http://127.0.0.1:{port}/json/list") as answer:
                target = next(each for each in await answer.json() if each["type"] == "page")
            async with client.ws_connect(target["webSocketDebuggerUrl"], max_msg_size=1 << 26) as socket:
                page = Page(socket)
                listening = asyncio.create_task(page.listen())
                for domain in ("Page", "Network", "Log", "Runtime"):
                    await page.do(f"{domain}.enable")
                yield page
                await page.do("Browser.close")
                await listening
        async with asyncio.timeout(LIMIT_S):
            await process.wait()
    finally:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        await process.wait()


async def _port(file: Path) -> int:
    await until(lambda: file.is_file() and len(file.read_text().splitlines()) == 2, "the browser's port")
    return int(file.read_text().splitlines()[0])
