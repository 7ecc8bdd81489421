"""The app in a browser: who can reach it, that its page is self-contained, and that nothing of it is left behind."""

from __future__ import annotations

import asyncio
import os
import re
import shutil
import signal
import socket
import sys
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import asynccontextmanager
from pathlib import Path

import aiohttp
import pytest
from aiohttp import web

from tests.cli.conftest import Run
from tutor import errors
from tutor.content import load_course
from tutor.serve import address, guard, is_loopback, listen, listening
from tutor.serve.guard import is_address_or_own_name, is_this_machine, peer_uid
from tutor.workspace import Workspace, start

LIMIT_S = 60.0
PROGRAM = "import sys; from tutor.cli import main; sys.exit(main(sys.argv[1:]))"


@pytest.fixture
def workspace(home: Path) -> Workspace:
    """A learner's workspace in which i1.1 is solved."""
    lesson = load_course().find("i1.1")
    workspace = Workspace(home / "ws")
    start(lesson, workspace)
    shutil.copyfile(lesson.files[0].solution, workspace.path_of(lesson.files[0].name))
    return workspace


@asynccontextmanager
async def serving(workspace: Workspace) -> AsyncIterator[tuple[asyncio.subprocess.Process, str]]:
    """Run `ros-tutor serve`. Yields its process and the address that it prints."""
    process = await asyncio.create_subprocess_exec(
        *(sys.executable, "-c", PROGRAM, "serve", "--port", "0", "--workspace", str(workspace.root)),
        stdout=asyncio.subprocess.PIPE,
        stderr=asyncio.subprocess.PIPE,
        env={**os.environ, "ROS_DOMAIN_ID": "91", "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"},
    )
    try:
        assert process.stdout is not None
        async with asyncio.timeout(LIMIT_S):
            printed = (await process.stdout.readline()).decode()
        found = re.fullmatch(r"ros-tutor is at (http://127\.0\.0\.1:\d+/)\n", printed)
        assert found is not None, printed
        yield process, found[1]
    finally:
        if process.returncode is None:
            process.kill()
        await process.communicate()


@asynccontextmanager
async def open_page(client: aiohttp.ClientSession, url: str) -> AsyncIterator[aiohttp.ClientWebSocketResponse]:
    """Open the page as a browser does, and press r to run the lesson's node, which is still running on exit."""
    async with client.ws_connect(f"{url}ws?width=120&height=36", origin=url.rstrip("/")) as page:
        drawn = b""
        async with asyncio.timeout(LIMIT_S):
            while b"publishes" not in drawn:  # the criteria: the main screen is there
                drawn += await page.receive_bytes()
        await page.send_json(["stdin", "r"])
        yield page


def processes_with(text: str) -> dict[int, str]:
    """The live processes with `text` in their command line."""
    found = {}
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            words = (folder / "cmdline").read_bytes().replace(b"\0", b" ").decode("utf-8", "replace")
            state = (folder / "stat").read_text().rpartition(")")[2].split()[0]
        except OSError:
            continue
        if text in words and state not in "ZX" and folder.name != str(os.getpid()):
            found[int(folder.name)] = words
    return found


async def wait_until(condition: Callable[[], bool], what: str) -> None:
    try:
        async with asyncio.timeout(LIMIT_S):
            while not condition():
                await asyncio.sleep(0.1)  # most conditions read all of /proc
    except TimeoutError:
        pytest.fail(f"not seen: {what}")


def listening_sockets(pid: int) -> list[tuple[str, int]]:
    """The addresses and ports on which a process listens for TCP connections."""
    own = set()
    for handle in Path(f"/proc/{pid}/fd").iterdir():
        try:
            own.add(os.readlink(handle))
        except OSError:
            continue
    found = []
    for family, table in ((socket.AF_INET, "tcp"), (socket.AF_INET6, "tcp6")):
        for line in Path(f"/proc/{pid}/net/{table}").read_text().splitlines()[1:]:
            _, local, _, state, *rest = line.split()
            if state == "0A" and f"socket:[{rest[5]}]" in own:
                host, _, port = local.partition(":")
                raw = b"".join(bytes.fromhex(host[n : n + 8])[::-1] for n in range(0, len(host), 8))
                found.append((socket.inet_ntop(family, raw), int(port, 16)))
    return found


async def test_only_this_machine_gets_a_page_that_needs_no_internet_and_ctrl_c_ends_everything(
    workspace: Workspace,
) -> None:
    async with serving(workspace) as (server, url), aiohttp.ClientSession() as client:
        assert listening_sockets(server.pid) == [("127.0.0.1", int(url.rstrip("/").rpartition(":")[2]))]

        async with client.get(url) as answer:
            page = await answer.text()
            policy = answer.headers["Content-Security-Policy"]
        assert "'self'" in policy
        assert not re.search(r"https?:|\*", policy)
        named = re.findall(r'(?:src|href)="(?!data:)([^"]+)"', page)
        assert len(named) == 4
        async with client.get(url + "page/page.css") as answer:
            named += [part.removeprefix("../") for part in re.findall(r'url\("([^"]+)"\)', await answer.text())]
        assert len(named) == 6
        for name in named:  # everything comes from this server
            assert "//" not in name
            async with client.get(url + name) as answer:
                assert answer.status == 200, name

        for headers in ({"Origin": "http://elsewhere.example"}, {"Origin": "null"}, {"Host": "elsewhere.example"}):
            async with client.get(url + "ws", headers=headers) as answer:
                assert answer.status == 403
        async with open_page(client, url):
            await wait_until(lambda: len(processes_with("temperature_publisher.py")) >= 1, "the node runs")
            assert processes_with(f"tutor.serve {workspace.root}")
            server.send_signal(signal.SIGINT)
            async with asyncio.timeout(LIMIT_S):
                _, printed = await server.communicate()
        assert server.returncode == 130
        assert (
            printed.decode()
            == "ros-tutor: Ctrl+C ends it\nros-tutor: ending the app and everything that was started in it\n"
        )
        assert processes_with(str(workspace.root)) == {}


async def test_killing_the_server_ends_the_app_and_the_node(workspace: Workspace) -> None:
    async with serving(workspace) as (server, url), aiohttp.ClientSession() as client, open_page(client, url):
        node = str(workspace.path_of("temperature_publisher.py"))
        await wait_until(lambda: bool(processes_with(node)), "the node runs")
        server.kill()
        await wait_until(lambda: not processes_with(str(workspace.root)), "nothing is left")


@pytest.fixture
def taken_port() -> Iterator[int]:
    with socket.create_server(("127.0.0.1", 0)) as other:
        yield other.getsockname()[1]


def test_unusable_ports_and_hosts_are_reported_in_one_line(run: Run, taken_port: int) -> None:
    result = run("serve", "--port", str(taken_port))
    assert (result.code, result.out) == (3, "")
    assert result.err == (
        f"ros-tutor: port {taken_port} of 127.0.0.1 is taken; "
        "name another with --port, or leave it out to get a free one\n"
    )
    for wrong in (["--port", "65536"], ["--port", "http"], ["--host", "192.0.2.1"], ["--host", "x" * 64]):
        result = run("serve", *wrong)
        assert (result.code, result.out) == (2, "")
        assert result.err.count("\n") == 1
        assert wrong[1] in result.err


def test_without_textual_serve_it_says_what_to_install(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(sys.modules, "tutor.serve.server", raising=False)
    monkeypatch.setitem(sys.modules, "textual_serve.server", None)
    result = run("serve")
    assert result.code == 3
    assert result.err.startswith("ros-tutor: the app cannot be served: textual_serve.server is not installed; install")


def test_if_the_usual_port_is_taken_a_free_one_is_used(taken_port: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(listening, "USUAL_PORT", taken_port)
    with listen("127.0.0.1", None) as listener:
        assert listener.getsockname()[1] != taken_port
        assert is_loopback(listener)
    with pytest.raises(errors.ServeError):
        listen("127.0.0.1", taken_port)


def test_serving_to_other_machines_prints_a_warning(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    from tutor.serve.server import AppServer

    async def start_and_return(self: AppServer, on_ready: Callable[[], None]) -> None:
        on_ready()

    monkeypatch.setattr(AppServer, "run", start_and_return)
    result = run("serve", "--host", "0.0.0.0", "--port", "0")
    assert re.fullmatch(r"ros-tutor is at http://127\.0\.0\.1:\d+/\?token=[\w-]{22}\n", result.out)
    assert "warning: 0.0.0.0 can be reached from other machines, and anyone who has this address can run" in result.err
    assert "warning" not in run("serve", "--port", "0").err
    with listen("::1", 0) as listener:
        assert address(listener).startswith("http://[::1]:")


@pytest.mark.parametrize(
    ("host", "ours"),
    [
        ("127.0.0.1:8000", True),
        ("localhost", True),
        ("LOCALHOST:9", True),
        ("app.localhost:9", True),
        ("[::1]:8000", True),
        ("127.8.8.8", True),
        ("127.0.0.1.elsewhere.example", False),
        ("localhost.elsewhere.example:8000", False),
        ("192.0.2.1:8000", False),
        ("", False),
    ],
)
def test_host_names_that_can_only_mean_this_machine(host: str, ours: bool) -> None:
    assert is_this_machine(host) is ours


async def test_other_machines_need_the_token() -> None:
    from tutor.serve.server import AppServer

    with listen("0.0.0.0", 0) as listener:
        own = listener.getsockname()[1]
        server = AppServer(["true"], listener, "secret")
        runner = web.AppRunner(await server._make_app(), access_log=None)
        await runner.setup()
        await web.SockSite(runner, listener).start()
        try:
            url = f"http://127.0.0.1:{own}/"
            for cookie in ({}, {"token": "guessed"}):
                async with aiohttp.ClientSession(cookies=cookie) as client:
                    for page in ("", "ws", "page/page.css", "?token=guessed"):
                        async with client.get(url + page) as answer:
                            assert answer.status == 403, page
            async with aiohttp.ClientSession(cookie_jar=aiohttp.CookieJar(unsafe=True)) as client:
                async with client.get(f"{url}?token=secret") as answer:
                    assert answer.status == 200
                    assert str(answer.url) == url  # the token is out of the address
                    set_cookie = answer.history[0].headers["Set-Cookie"]
                assert "HttpOnly" in set_cookie
                assert "SameSite=Strict" in set_cookie
                for headers in ({"Host": f"elsewhere.example:{own}"}, {"Origin": "http://elsewhere.example"}):
                    async with client.get(url + "ws", headers=headers) as answer:
                        assert answer.status == 403
        finally:
            await runner.cleanup()


@pytest.mark.parametrize(
    ("host", "ours"),
    [
        ("192.0.2.1:8000", True),
        ("[2001:db8::1]:8000", True),
        (f"{socket.gethostname()}:8000", True),
        ("elsewhere.example", False),
        ("192.0.2.1.elsewhere.example", False),
        ("", False),
    ],
)
def test_host_names_that_other_machines_may_use(host: str, ours: bool) -> None:
    assert is_address_or_own_name(host) is ours


@pytest.mark.parametrize("width", ["100000", "-5", "0"])
async def test_the_size_of_a_page_is_limited_to_what_an_app_can_draw(
    width: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    from tutor.serve.page_session import Session
    from tutor.serve.server import HIGHEST, WIDEST, AppServer

    sizes: list[tuple[int, int]] = []

    async def start(self: Session, width: int, height: int) -> None:
        sizes.append((width, height))
        await self._close_page()

    monkeypatch.setattr(Session, "start", start)
    with listen("127.0.0.1", 0) as listener:
        runner = web.AppRunner(await AppServer(["true"], listener)._make_app(), access_log=None)
        await runner.setup()
        await web.SockSite(runner, listener).start()
        try:
            async with aiohttp.ClientSession() as client:
                page_url = f"http://127.0.0.1:{listener.getsockname()[1]}/ws?width={width}&height={width}"
                async with client.ws_connect(page_url) as page:
                    await page.receive()
        finally:
            await runner.cleanup()
    assert 20 <= sizes[0][0] <= WIDEST
    assert 5 <= sizes[0][1] <= HIGHEST


@pytest.mark.parametrize("host", ["127.0.0.1", "::1"])
async def test_the_user_at_the_other_end_is_identified(host: str) -> None:
    found: list[int | None] = []

    async def record_uid(request: web.Request) -> web.Response:
        found.append(peer_uid(request))
        return web.Response()

    app = web.Application()
    app.router.add_get("/", record_uid)
    runner = web.AppRunner(app)
    await runner.setup()
    with listen(host, 0) as listener:
        await web.SockSite(runner, listener).start()
        async with aiohttp.ClientSession() as client, client.get(address(listener)) as answer:
            assert answer.status == 200
        await runner.cleanup()
    assert found == [os.getuid()]


async def test_another_user_of_this_machine_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(guard, "peer_uid", lambda request: os.getuid() + 1)
    app = web.Application(middlewares=[guard.only_own_pages()])
    runner = web.AppRunner(app)
    await runner.setup()
    with listen("127.0.0.1", 0) as listener:
        await web.SockSite(runner, listener).start()
        async with aiohttp.ClientSession() as client, client.get(address(listener)) as answer:
            assert (answer.status, await answer.text()) == (403, "This app belongs to another user of this machine.\n")
        await runner.cleanup()
