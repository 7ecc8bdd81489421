"""Datagrams that the kernel drops, on real sockets."""

from __future__ import annotations

import socket
from pathlib import Path

import pytest

from tutor.process import count_dropped_datagrams, datagram_loss


def test_a_full_socket_buffer_counts_as_a_loss() -> None:
    with socket.socket(type=socket.SOCK_DGRAM) as receiver, socket.socket(type=socket.SOCK_DGRAM) as sender:
        receiver.bind(("127.0.0.1", 0))
        receiver.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        before = count_dropped_datagrams()
        for _ in range(50):
            sender.sendto(bytes(1000), receiver.getsockname())
        after = count_dropped_datagrams()
    assert before is not None
    assert after is not None
    assert after - before >= 40


@pytest.mark.parametrize("text", ["", "Udp: InErrors\nUdp: 3", "Udp: InErrors\n", "Udp: InErrors\nUdp: many"])
def test_a_kernel_that_does_not_say_may_have_dropped_anything(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, text: str
) -> None:
    (tmp_path / "snmp").write_text(text)
    monkeypatch.setattr(datagram_loss, "_SNMP", tmp_path / "snmp")
    assert count_dropped_datagrams() is None


def test_a_kernel_without_these_files_does_not_say(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(datagram_loss, "_SOFTNET", tmp_path / "missing")
    assert count_dropped_datagrams() is None
