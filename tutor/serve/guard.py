"""Keeps other web sites out: a page of theirs, open in the same browser, could otherwise type into the learner's app.

A browser lets any page open a WebSocket to 127.0.0.1, but names the page's site in `Origin`. A site can also resolve
its own name to 127.0.0.1 (DNS rebinding), but then the browser sends that name in `Host`.

If other machines can reach the server, it requires a token, which is printed where the server was started: anyone who
opens the page can run programs as the user.

It also keeps out other users of this machine: for a local connection, the kernel knows the user at the other end.
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
    # The page loads everything from here: it works offline, and no third party learns that it is open.
    "Content-Security-Policy": (
        "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; font-src 'self'; "
        "img-src 'self' data:; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    ),
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
}


TOKEN = "token"
"""The name of the token in the URL, and of the cookie that replaces it."""


def only_own_pages(token: str = "") -> Middleware:
    """Return a middleware that refuses requests from other sites' pages and, if there is a `token`, those without it.

    Without a token, only this machine can reach us, so host names other than localhost are refused as well.
    """

    @web.middleware
    async def guard(request: web.Request, handler: Handler) -> web.StreamResponse:
        origin = request.headers.get("Origin")
        if origin is not None and urlsplit(origin).netloc.lower() != request.host.lower():
            raise web.HTTPForbidden(text="This page belongs to another site.\n")
        if not (is_this_machine(request.host) or (token and is_address_or_own_name(request.host))):
            raise web.HTTPForbidden(text="This name is not known here: use the address that ros-tutor printed.\n")
        if peer_uid(request) not in (None, 0, os.getuid()):
            raise web.HTTPForbidden(text="This app belongs to another user of this machine.\n")
        if token and _is_same_token(request.query.get(TOKEN, ""), token):
            # Move the token from the URL, which is easily shown to others, to a cookie.
            redirect = web.HTTPFound(request.path)
            redirect.set_cookie(TOKEN, token, httponly=True, samesite="Strict")
            raise redirect
        if token and not _is_same_token(request.cookies.get(TOKEN, ""), token):
            raise web.HTTPForbidden(text="Use the address that ros-tutor printed, with its token.\n")
        return await handler(request)

    return guard


async def add_headers(request: web.Request, response: web.StreamResponse) -> None:
    """Add security headers, which tell the browser what the page may load."""
    response.headers.update(_HEADERS)


def _is_same_token(given: str, token: str) -> bool:
    return hmac.compare_digest(given.encode(errors="replace"), token.encode())


def is_address_or_own_name(host: str) -> bool:
    """Return whether a `Host` header holds an IP address or this machine's own name, so not another site's name."""
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
    """Return whether a `Host` header can only mean the machine that the browser runs on."""
    name = (urlsplit(f"//{host}").hostname or "").rstrip(".")
    if name == "localhost" or name.endswith(".localhost"):
        return True
    try:
        return ipaddress.ip_address(name).is_loopback
    except ValueError:
        return False


def peer_uid(request: web.Request) -> int | None:
    """Return the user id at the other end; None if that is another machine, or cannot be known."""
    transport = request.transport
    peer, here = (None, None) if transport is None else map(transport.get_extra_info, ("peername", "sockname"))
    if peer is None or here is None:
        return None
    table = "tcp6" if ":" in peer[0] else "tcp"
    # The row of the other end's socket: its own address comes first.
    addresses = [_proc_address(*peer[:2]), _proc_address(*here[:2])]
    try:
        rows = Path(f"/proc/self/net/{table}").read_text().splitlines()[1:]
    except OSError:
        return None
    return next((int(words[7]) for words in map(str.split, rows) if words[1:3] == addresses), None)


def _proc_address(host: str, port: int) -> str:
    """Format an address as /proc/net/tcp does: in groups of four bytes, each in native byte order."""
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    raw = socket.inet_pton(family, host.partition("%")[0])
    words = (int.from_bytes(raw[n : n + 4], sys.byteorder) for n in range(0, len(raw), 4))
    return f"{''.join(f'{word:08X}' for word in words)}:{port:04X}"
