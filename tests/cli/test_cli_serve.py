"""The app in a browser: who can reach it, what it is made of, and that nothing of it is left."""

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
from tutor.serve.guard import is_address_or_ours, is_this_machine, owner
from tutor.workspace import Workspace, start

LIMIT_S = 60.0
PROGRAM = "import sys; from tutor.cli import main; sys.exit(main(sys.argv[1:]))"


@pytest.fixture
def workspace(home: Path) -> Workspace:
    """A learner's workspace in which i1.1 is solved."""
    lesson = load_course().find("i1.1")
    made = Workspace(home / "ws")
    start(lesson, made)
    shutil.copyfile(lesson.files[0].solution, made.path_of(lesson.files[0].name))
    return made


@asynccontextmanager
async def serving(workspace: Workspace) -> AsyncIterator[tuple[asyncio.subprocess.Process, str]]:
    """`ros-tutor serve`, and the address that it prints."""
    process = await asyncio.create_subprocess_exec(
        *(sys.executable, "-c", PROGRAM, "serve", "--port", "0", "--workspace", str(workspace.root)),
        stdout=asyncio.subprocess.PIPE,
        stderr=asyncio.subprocess.PIPE,
        env={**os.environ, "ROS_DOMAIN_ID": "91", "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"},
    )
    try:
        assert process.stdout is not None
        async with asyncio.timeout(LIMIT_S):
            said = (await process.stdout.readline()).decode()
        found = re.fullmatch(r"ros-tutor is at (http://127\.0\.0\.1:\d+/)\n", said)
        assert found is not None, said
        yield process, found[1]
    finally:
        if process.returncode is None:
            process.kill()
        await process.communicate()


@asynccontextmanager
async def opened(client: aiohttp.ClientSession, url: str) -> AsyncIterator[aiohttp.ClientWebSocketResponse]:
    """What a browser does when it opens the page; it is left with the lesson's node running."""
    async with client.ws_connect(f"{url}ws?width=120&height=36", origin=url.rstrip("/")) as page:
        drawn = b""
        async with asyncio.timeout(LIMIT_S):
            while b"publishes" not in drawn:  # the criteria: the main screen is there
                drawn += await page.receive_bytes()
        await page.send_json(["stdin", "r"])
        yield page


def processes_with(text: str) -> dict[int, str]:
    """The living processes that have `text` in their command line."""
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


async def until(seen: Callable[[], bool], what: str) -> None:
    try:
        async with asyncio.timeout(LIMIT_S):
            while not seen():
                await asyncio.sleep(0.02)
    except TimeoutError:
        pytest.fail(f"not seen: {what}")


def listening_at(pid: int) -> list[tuple[str, int]]:
    """The addresses and ports at which a process listens for TCP."""
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


async def test_this_machine_alone_gets_a_page_that_needs_no_internet_and_ctrl_c_ends_it_all(
    workspace: Workspace,
) -> None:
    async with serving(workspace) as (server, url), aiohttp.ClientSession() as client:
        assert listening_at(server.pid) == [("127.0.0.1", int(url.rstrip("/").rpartition(":")[2]))]

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
        for name in named:  # all of it from here
            assert "//" not in name
            async with client.get(url + name) as answer:
                assert answer.status == 200, name

        for strange in ({"Origin": "http://elsewhere.example"}, {"Origin": "null"}, {"Host": "elsewhere.example"}):
            async with client.get(url + "ws", headers=strange) as answer:
                assert answer.status == 403
        async with opened(client, url):
            await until(lambda: len(processes_with("temperature_publisher.py")) >= 1, "the node runs")
            assert processes_with(f"tutor.serve {workspace.root}")
            server.send_signal(signal.SIGINT)
            async with asyncio.timeout(LIMIT_S):
                _, said = await server.communicate()
        assert server.returncode == 130
        assert (
            said.decode()
            == "ros-tutor: Ctrl+C ends it\nros-tutor: ending the app and everything that was started in it\n"
        )
        assert processes_with(str(workspace.root)) == {}


async def test_a_server_that_is_killed_takes_app_and_node_along(workspace: Workspace) -> None:
    async with serving(workspace) as (server, url), aiohttp.ClientSession() as client, opened(client, url):
        node = str(workspace.path_of("temperature_publisher.py"))
        await until(lambda: bool(processes_with(node)), "the node runs")
        server.kill()
        await until(lambda: not processes_with(str(workspace.root)), "nothing is left")


@pytest.fixture
def taken() -> Iterator[int]:
    with socket.create_server(("127.0.0.1", 0)) as other:
        yield other.getsockname()[1]


def test_what_cannot_be_had_is_told_in_a_line(run: Run, taken: int) -> None:
    ran = run("serve", "--port", str(taken))
    assert (ran.code, ran.out) == (3, "")
    assert ran.err == (
        f"ros-tutor: port {taken} of 127.0.0.1 is taken; name another with --port, or leave it out to get a free one\n"
    )
    for wrong in (["--port", "65536"], ["--port", "http"], ["--host", "192.0.2.1"], ["--host", "x" * 64]):
        ran = run("serve", *wrong)
        assert (ran.code, ran.out) == (2, "")
        assert ran.err.count("\n") == 1
        assert wrong[1] in ran.err


def test_without_the_library_it_says_how_to_get_it(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(sys.modules, "tutor.serve.server", raising=False)
    monkeypatch.setitem(sys.modules, "textual_serve.server", None)
    ran = run("serve")
    assert ran.code == 3
    assert ran.err.startswith("ros-tutor: the app cannot be served: textual_serve.server is not installed; install")


def test_a_taken_usual_port_is_replaced_by_a_free_one(taken: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(listening, "USUAL_PORT", taken)
    with listen("127.0.0.1", None) as listener:
        assert listener.getsockname()[1] != taken
        assert is_loopback(listener)
    with pytest.raises(errors.ServeError):
        listen("127.0.0.1", taken)


def test_anyone_who_opens_it_to_others_is_warned(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    from tutor.serve.server import AppServer

    async def run_shortly(self: AppServer, on_ready: Callable[[], None]) -> None:
        on_ready()

    monkeypatch.setattr(AppServer, "run", run_shortly)
    ran = run("serve", "--host", "0.0.0.0", "--port", "0")
    assert re.fullmatch(r"ros-tutor is at http://127\.0\.0\.1:\d+/\?token=[\w-]{22}\n", ran.out)
    assert "warning: 0.0.0.0 can be reached from other machines, and anyone who has this address can run" in ran.err
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
def test_which_names_can_only_mean_this_machine(host: str, ours: bool) -> None:
    assert is_this_machine(host) is ours


async def test_from_elsewhere_it_is_opened_with_the_token_only() -> None:
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
                    cookie_said = answer.history[0].headers["Set-Cookie"]
                assert "HttpOnly" in cookie_said
                assert "SameSite=Strict" in cookie_said
                for strange in ({"Host": f"elsewhere.example:{own}"}, {"Origin": "http://elsewhere.example"}):
                    async with client.get(url + "ws", headers=strange) as answer:
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
def test_which_names_another_machine_may_use(host: str, ours: bool) -> None:
    assert is_address_or_ours(host) is ours


@pytest.mark.parametrize("width", ["100000", "-5", "0"])
async def test_a_page_has_a_size_that_an_app_can_draw(width: str, monkeypatch: pytest.MonkeyPatch) -> None:
    from tutor.serve.server import HIGHEST, WIDEST, AppServer
    from tutor.serve.session import Session

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
                address_ = f"http://127.0.0.1:{listener.getsockname()[1]}/ws?width={width}&height={width}"
                async with client.ws_connect(address_) as page:
                    await page.receive()
        finally:
            await runner.cleanup()
    assert 20 <= sizes[0][0] <= WIDEST
    assert 5 <= sizes[0][1] <= HIGHEST


@pytest.mark.parametrize("host", ["127.0.0.1", "::1"])
async def test_the_user_at_the_other_end_is_known(host: str) -> None:
    found: list[int | None] = []

    async def look(request: web.Request) -> web.Response:
        found.append(owner(request))
        return web.Response()

    app = web.Application()
    app.router.add_get("/", look)
    runner = web.AppRunner(app)
    await runner.setup()
    with listen(host, 0) as listener:
        await web.SockSite(runner, listener).start()
        async with aiohttp.ClientSession() as client, client.get(address(listener)) as answer:
            assert answer.status == 200
        await runner.cleanup()
    assert found == [os.getuid()]


async def test_another_user_of_this_machine_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(guard, "owner", lambda request: os.getuid() + 1)
    app = web.Application(middlewares=[guard.only_own_pages()])
    runner = web.AppRunner(app)
    await runner.setup()
    with listen("127.0.0.1", 0) as listener:
        await web.SockSite(runner, listener).start()
        async with aiohttp.ClientSession() as client, client.get(address(listener)) as answer:
            assert (answer.status, await answer.text()) == (403, "This app belongs to another user of this machine.\n")
        await runner.cleanup()
