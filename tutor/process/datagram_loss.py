"""Counts the datagrams that the kernel has dropped. What it did not drop has arrived, and need not be sent again.

Nodes under observation use UDP on the loopback interface only. A datagram is lost there if the receiver's socket buffer
or the queue of a CPU is full, and the kernel counts that (`/proc/net/snmp`, `/proc/net/softnet_stat`).
"""

from __future__ import annotations

from pathlib import Path

_SNMP, _SOFTNET = Path("/proc/net/snmp"), Path("/proc/net/softnet_stat")
_COUNTERS = (("Udp:", ("InErrors", "SndbufErrors")), ("Ip:", ("InDiscards", "OutDiscards", "ReasmFails")))


def count_dropped_datagrams() -> int | None:
    """Return how many datagrams of any process this machine has dropped so far; None if the kernel does not say."""
    try:
        rows = [line.split() for line in _SNMP.read_text().splitlines()]
        values = {
            (names[0], name): int(value)
            for names, numbers in zip(rows[::2], rows[1::2], strict=True)
            for name, value in zip(names[1:], numbers[1:], strict=True)
        }
        queued = sum(int(line.split()[1], 16) for line in _SOFTNET.read_text().splitlines())
        return queued + sum(values[protocol, name] for protocol, names in _COUNTERS for name in names)
    except (OSError, ValueError, KeyError, IndexError):
        return None
