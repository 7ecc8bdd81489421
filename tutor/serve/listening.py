"""Where the server listens: one socket, on this machine only unless someone asks for more."""

from __future__ import annotations

import errno
import ipaddress
import os
import socket

from tutor.errors import NoAddress, ServeError

USUAL_PORT = 8000
"""Taken where it is free and none is asked for, so that a bookmark stays good."""


def listen(host: str, port: int | None) -> socket.socket:
    """A listening socket at `host`. Without `port`, the usual one, or a free one where that is taken; 0 is a free one.

    Raises NoAddress where `host` is none of this machine's, ServeError where the port is not to be had.
    """
    if port is not None:
        return _listen(host, port)
    try:
        return _listen(host, USUAL_PORT)
    except NoAddress:
        raise
    except ServeError:
        return _listen(host, 0)


def address(listener: socket.socket, token: str = "") -> str:
    """What to type into a browser on this machine. With `token`, it may be anyone who has it."""
    host, port = listener.getsockname()[:2]
    if ipaddress.ip_address(host).is_unspecified:
        host = "127.0.0.1" if listener.family == socket.AF_INET else "::1"
    page = f"http://[{host}]:{port}/" if ":" in host else f"http://{host}:{port}/"
    return f"{page}?token={token}" if token else page


def is_loopback(listener: socket.socket) -> bool:
    """Whether only this machine can reach it."""
    return ipaddress.ip_address(listener.getsockname()[0]).is_loopback


def _listen(host: str, port: int) -> socket.socket:
    try:
        found = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)
    except (OSError, UnicodeError) as error:
        raise NoAddress(
            f"--host {host}: no such host", "leave --host out, or give an address of this machine"
        ) from error
    family, kind, protocol, _, place = found[0]
    listener = socket.socket(family, kind, protocol)
    try:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)  # what was served a moment ago is no hindrance
        listener.bind(place)
        listener.listen()
    except OSError as error:
        listener.close()
        raise _refused(host, port, error) from error
    listener.setblocking(False)
    return listener


def _refused(host: str, port: int, error: OSError) -> ServeError:
    if error.errno == errno.EADDRINUSE:
        what, hint = f"port {port} of {host} is taken", "name another with --port, or leave it out to get a free one"
    elif error.errno == errno.EADDRNOTAVAIL:
        return NoAddress(f"--host {host}: this machine has no such address", "leave --host out for this machine only")
    elif error.errno == errno.EACCES:
        what, hint = f"you may not listen on port {port}", "name one from 1024 on with --port"
    else:
        what, hint = f"cannot listen on port {port} of {host}: {os.strerror(error.errno or 0)}", "try another --port"
    return ServeError(what, hint)
