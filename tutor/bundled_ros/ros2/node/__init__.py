"""`ros2 node`."""

from __future__ import annotations

VERBS = {
    "info": "Show what a node publishes, subscribes to, offers and calls",
    "list": "List the nodes",
}
