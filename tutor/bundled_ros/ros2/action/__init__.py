"""`ros2 action`."""

from __future__ import annotations

VERBS = {
    "info": "Show who offers and who uses an action",
    "list": "List the actions",
    "send_goal": "Send a goal, and show its result",
    "type": "Show an action's type",
}
