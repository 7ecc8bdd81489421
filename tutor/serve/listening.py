"""The server's listening socket: reachable only from this machine unless requested otherwise."""

from __future__ import annotations

import errno
import ipaddress
import os
import socket

from tutor.errors import NoAddress, ServeError

USUAL_PORT = 8000
"""The default port, if it is free, so that bookmarks keep working."""


def listen(host: str, port: int | None) -> socket.socket:
    """Return a listening socket at `host`.

    `port` None means the usual port, or a free one if that is taken; 0 means a free one. Raises NoAddress if `host` is
    not an address of this machine, ServeError if the port cannot be used.
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
    """Return the URL to open in a browser on this machine, including the `token` if there is one."""
    host, port = listener.getsockname()[:2]
    if ipaddress.ip_address(host).is_unspecified:
        host = "127.0.0.1" if listener.family == socket.AF_INET else "::1"
    page = f"http://[{host}]:{port}/" if ":" in host else f"http://{host}:{port}/"
    return f"{page}?token={token}" if token else page


def is_loopback(listener: socket.socket) -> bool:
    """Return whether only this machine can reach the socket."""
    return ipaddress.ip_address(listener.getsockname()[0]).is_loopback


def _listen(host: str, port: int) -> socket.socket:
    try:
        candidates = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)
    except (OSError, UnicodeError) as error:
        raise NoAddress(
            f"--host {host}: no such host", "leave --host out, or give an address of this machine"
        ) from error
    family, kind, protocol, _, sockaddr = candidates[0]
    listener = socket.socket(family, kind, protocol)
    try:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)  # the port may have been in use a moment ago
        listener.bind(sockaddr)
        listener.listen()
    except OSError as error:
        listener.close()
        raise _listen_error(host, port, error) from error
    listener.setblocking(False)
    return listener


def _listen_error(host: str, port: int, error: OSError) -> ServeError:
    if error.errno == errno.EADDRINUSE:
        what, hint = f"port {port} of {host} is taken", "name another with --port, or leave it out to get a free one"
    elif error.errno == errno.EADDRNOTAVAIL:
        return NoAddress(f"--host {host}: this machine has no such address", "leave --host out for this machine only")
    elif error.errno == errno.EACCES:
        what, hint = f"you may not listen on port {port}", "choose one from 1024 up with --port"
    else:
        what, hint = f"cannot listen on port {port} of {host}: {os.strerror(error.errno or 0)}", "try another --port"
    return ServeError(what, hint)
