"""A real browser with one page, driven as by a person, over its DevTools socket on this machine."""

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

_OPTIONS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-3d-apis",  # rendered in software, they would cost more than everything else
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
    # Whatever the page or the browser requests, no name but this machine's is ever resolved.
    "--host-resolver-rules=MAP * ~NOTFOUND , EXCLUDE 127.0.0.1",
    "--no-proxy-server",
    "--window-size=1300,800",
    "--remote-debugging-port=0",
)

_ESCAPE_SEQUENCE = re.compile(r"\x1b\[[0-9;?<>=$]*[ -/]*[@-~]|\x1b\][^\x07\x1b]*(?:\x07|\x1b\\\\)|\x1b.")

_KEYS = {"Enter": 13, "Escape": 27, "Tab": 9, "ArrowDown": 40, "ArrowUp": 38}


class Page:
    """The open page.

    `requested` holds the URL of every request, `complaints` what the browser logged and the exceptions of its scripts,
    and `drawn` the text that the terminal in it received, without colours and cursor movements.
    """

    def __init__(self, socket: aiohttp.ClientWebSocketResponse) -> None:
        self._socket = socket
        self._ids = itertools.count(1)
        self._replies: dict[int, asyncio.Future[dict[str, Any]]] = {}
        self.requested: list[str] = []
        self.complaints: list[str] = []
        self.drawn = ""

    async def listen(self) -> None:
        """Handle the browser's messages until it is closed."""
        async for message in self._socket:
            content = json.loads(message.data)
            if "id" in content:
                self._replies.pop(content["id"]).set_result(content)
            elif content["method"] in ("Network.requestWillBeSent", "Network.webSocketCreated"):
                self.requested.append(content["params"].get("url") or content["params"]["request"]["url"])
            elif content["method"] == "Network.webSocketFrameReceived":
                frame = content["params"]["response"]
                if frame["opcode"] == 2:
                    text = base64.b64decode(frame["payloadData"]).decode("utf-8", "replace")
                    self.drawn += _ESCAPE_SEQUENCE.sub("", text)
            elif content["method"] == "Log.entryAdded":
                self.complaints.append(content["params"]["entry"]["text"])
            elif content["method"] == "Runtime.exceptionThrown":
                self.complaints.append(json.dumps(content["params"]["exceptionDetails"]))

    async def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        id = next(self._ids)
        future = self._replies[id] = asyncio.get_running_loop().create_future()
        await self._socket.send_json({"id": id, "method": method, "params": parameters})
        async with asyncio.timeout(LIMIT_S):
            reply = await future
        assert "result" in reply, reply
        result: dict[str, Any] = reply["result"]
        return result

    async def evaluate(self, expression: str) -> Any:
        result = await self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        return result["result"].get("value")

    async def press(self, *keys: str) -> None:
        """Press keys: letters, and those named in `_KEYS`."""
        for key in keys:
            if key in _KEYS:
                fields: dict[str, Any] = {"key": key, "code": key, "windowsVirtualKeyCode": _KEYS[key]}
                text = "\r" if key == "Enter" else ""
            else:
                fields, text = {"key": key}, key
            await self.call("Input.dispatchKeyEvent", type="keyDown", text=text, **fields)
            await self.call("Input.dispatchKeyEvent", type="keyUp", **fields)

    async def press_for(self, text: str, *keys: str) -> None:
        """Press keys, and wait until `text` is drawn after that."""
        self.drawn = ""
        await self.press(*keys)
        await self.sees(text)

    async def sees(self, text: str) -> None:
        """Wait until `text` has been drawn."""
        try:
            await wait_until(lambda: text in self.drawn, text)
        except AssertionError as error:
            raise AssertionError(f"{error}\n{self.drawn[-6000:]}\n{self.complaints}\n{self.requested}") from None

    async def picture(self, file: Path) -> None:
        file.write_bytes(base64.b64decode((await self.call("Page.captureScreenshot"))["data"]))


async def wait_until(condition: Callable[[], object], what: str, limit_s: float = LIMIT_S) -> None:
    """Wait until the condition holds, or raise AssertionError."""
    try:
        async with asyncio.timeout(limit_s):
            while not condition():
                await asyncio.sleep(0.05)
    except TimeoutError:
        raise AssertionError(f"not seen within {limit_s:.0f} s: {what}") from None


@asynccontextmanager
async def browser(folder: Path) -> AsyncIterator[Page]:
    """A browser with an empty page. On exit, none of its processes is left."""
    assert PROGRAM is not None
    environment = {**os.environ, "HOME": str(folder), "XDG_CONFIG_HOME": str(folder), "XDG_CACHE_HOME": str(folder)}
    process = await asyncio.create_subprocess_exec(
        PROGRAM,
        *_OPTIONS,
        f"--user-data-dir={folder / 'profile'}",
        "about:blank",
        stdin=asyncio.subprocess.DEVNULL,
        stdout=asyncio.subprocess.DEVNULL,
        stderr=asyncio.subprocess.DEVNULL,
        env=environment,
        start_new_session=True,
    )
    try:
        port = await _read_port(folder / "profile" / "DevToolsActivePort")
        async with aiohttp.ClientSession() as client:
            async with client.get(f"http://127.0.0.1:{port}/json/list") as answer:
                target = next(each for each in await answer.json() if each["type"] == "page")
            async with client.ws_connect(target["webSocketDebuggerUrl"], max_msg_size=1 << 26) as socket:
                page = Page(socket)
                listening = asyncio.create_task(page.listen())
                for domain in ("Page", "Network", "Log", "Runtime"):
                    await page.call(f"{domain}.enable")
                yield page
                await page.call("Browser.close")
                await listening
        async with asyncio.timeout(LIMIT_S):
            await process.wait()
    finally:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        await process.wait()


async def _read_port(file: Path) -> int:
    await wait_until(lambda: file.is_file() and len(file.read_text().splitlines()) == 2, "the browser's port")
    return int(file.read_text().splitlines()[0])
