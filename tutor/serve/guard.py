"""Keeps other web sites out: a page of theirs, open in the same browser, could otherwise type into the learner's app.

A browser lets any page open a WebSocket to 127.0.0.1, but says in `Origin` whose page it is. And a site can give its
own name the address 127.0.0.1, but the browser then says that name in `Host`.

Where other machines can reach it, a token is required, which is printed where the server was started: anyone who opens
the page can run programs as the user.

Keeps other users of this machine out, too: the kernel says whose a connection is that comes from the machine itself.
"""

from __future__ import annotations

import hmac
import ipaddress
import os
import socket
import sys
from pathlib import Path
from urllib.parse import urlsplit

from aiohttp import web
from aiohttp.typedefs import Handler, Middleware

_HEADERS = {
    # All that the page is made of comes from here: it works offline, and tells nobody that it is open.
    "Content-Security-Policy": (
        "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; font-src 'self'; "
        "img-src 'self' data:; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    ),
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
}


TOKEN = "token"
"""The name of the token, in the address and in the cookie that takes its place."""


def only_own_pages(token: str = "") -> Middleware:
    """Refuse requests of another site's pages, and those without the `token`, where there is one.

    Without a token, only this machine can reach us: then also names are refused that mean no address of its own.
    """

    @web.middleware
    async def guard(request: web.Request, handler: Handler) -> web.StreamResponse:
        origin = request.headers.get("Origin")
        if origin is not None and urlsplit(origin).netloc.lower() != request.host.lower():
            raise web.HTTPForbidden(text="This page belongs to another site.\n")
        if not (is_this_machine(request.host) or (token and is_address_or_ours(request.host))):
            raise web.HTTPForbidden(text="Nothing has this name here: use the address that ros-tutor printed.\n")
        if owner(request) not in (None, 0, os.getuid()):
            raise web.HTTPForbidden(text="This app belongs to another user of this machine.\n")
        if token and _same(request.query.get(TOKEN, ""), token):
            # From here on in a cookie, and out of the address, which is easily shown to others.
            answer = web.HTTPFound(request.path)
            answer.set_cookie(TOKEN, token, httponly=True, samesite="Strict")
            raise answer
        if token and not _same(request.cookies.get(TOKEN, ""), token):
            raise web.HTTPForbidden(text="Use the address that ros-tutor printed, with its token.\n")
        return await handler(request)

    return guard


async def add_headers(request: web.Request, response: web.StreamResponse) -> None:
    """Tell the browser what the page may load."""
    response.headers.update(_HEADERS)


def _same(given: str, token: str) -> bool:
    return hmac.compare_digest(given.encode(errors="replace"), token.encode())


def is_address_or_ours(host: str) -> bool:
    """Whether the `Host` that a browser asked for is an address, or this machine's own name: no other site's."""
    name = (urlsplit(f"//{host}").hostname or "").rstrip(".")
    own = socket.gethostname().lower()
    if name in (own, own.partition(".")[0], f"{own.partition('.')[0]}.local"):
        return True
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


def is_this_machine(host: str) -> bool:
    """Whether the `Host` that a browser asked for can only mean the machine it runs on."""
    name = (urlsplit(f"//{host}").hostname or "").rstrip(".")
    if name == "localhost" or name.endswith(".localhost"):
        return True
    try:
        return ipaddress.ip_address(name).is_loopback
    except ValueError:
        return False


def owner(request: web.Request) -> int | None:
    """The user id at the other end, on this machine; None where that is elsewhere or cannot be known."""
    transport = request.transport
    peer, here = (None, None) if transport is None else map(transport.get_extra_info, ("peername", "sockname"))
    if peer is None or here is None:
        return None
    table = "tcp6" if ":" in peer[0] else "tcp"
    # Seen from the other end, its own address comes first.
    wanted = [_as_listed(*peer[:2]), _as_listed(*here[:2])]
    try:
        rows = Path(f"/proc/self/net/{table}").read_text().splitlines()[1:]
    except OSError:
        return None
    return next((int(words[7]) for words in map(str.split, rows) if words[1:3] == wanted), None)


def _as_listed(host: str, port: int) -> str:
    """An address as the kernel lists it: groups of four bytes, each in the machine's own order."""
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    raw = socket.inet_pton(family, host.partition("%")[0])
    words = (int.from_bytes(raw[n : n + 4], sys.byteorder) for n in range(0, len(raw), 4))
    return f"{''.join(f'{word:08X}' for word in words)}:{port:04X}"
