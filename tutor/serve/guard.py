"""Keeps other web sites out: a page of theirs, open in the same browser, could otherwise type into the learner's app.

A browser lets any page open a WebSocket to 127.0.0.1, but says in `Origin` whose page it is. And a site can give its
own name the address 127.0.0.1, but the browser then says that name in `Host`.
"""

from __future__ import annotations

import ipaddress
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


def only_own_pages(*, loopback: bool) -> Middleware:
    """Refuse what another site's page asks for; where we listen on `loopback`, also names that mean no such address."""

    @web.middleware
    async def guard(request: web.Request, handler: Handler) -> web.StreamResponse:
        origin = request.headers.get("Origin")
        if origin is not None and urlsplit(origin).netloc.lower() != request.host.lower():
            raise web.HTTPForbidden(text="This page belongs to another site.\n")
        if loopback and not is_this_machine(request.host):
            raise web.HTTPForbidden(text="Only this machine may open this: use the address that ros-tutor printed.\n")
        return await handler(request)

    return guard


async def add_headers(request: web.Request, response: web.StreamResponse) -> None:
    """Tell the browser what the page may load."""
    response.headers.update(_HEADERS)


def is_this_machine(host: str) -> bool:
    """Whether the `Host` that a browser asked for can only mean the machine it runs on."""
    name = (urlsplit(f"//{host}").hostname or "").rstrip(".")
    if name == "localhost" or name.endswith(".localhost"):
        return True
    try:
        return ipaddress.ip_address(name).is_loopback
    except ValueError:
        return False
