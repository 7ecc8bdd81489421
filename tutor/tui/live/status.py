"""What the live page says of the whole domain: its tabs, its status line, and what to do while it is empty. Pure."""

from __future__ import annotations

from itertools import islice

from textual.content import Content

from tutor.content.near_miss import near_misses
from tutor.ros_model import Graph
from tutor.tui.live.state import LiveState

TABS = {"topics": "Topics", "parameters": "Parameters", "services": "Services", "graph": "Graph"}

_MAX_NEAR_MISSES = 3
"""At most this many near misses of names are shown at once."""


def tab_labels(state: LiveState) -> dict[str, str]:
    """Return the labels of `TABS`, with the number of topics, parameters and services, and of broken connections."""
    graph = state.graph or Graph()
    counts = {
        "topics": sum(not topic.is_standard for topic in graph.topics),
        "parameters": len(state.listed_parameters(everything=False)),
        "services": sum(not service.is_standard for service in graph.services),
        "graph": 0,
    }
    labels = {name: f"{label} {counts[name]}" if counts[name] else label for name, label in TABS.items()}
    if broken := len(state.mismatches()):
        labels["graph"] = f"Graph ✗ {broken}"
    return labels


def status_line(state: LiveState, watching: bool, failure: str) -> str:
    """Return what is being watched. `failure`: why the watcher process has ended; empty if it was stopped."""
    if not watching:
        return "! not watching" if failure else "not watching"
    nodes = len(state.nodes)
    return f"● {nodes} node{'' if nodes == 1 else 's'} · domain {state.domain}" if state.ready else "◐ starting"


def empty_text(state: LiveState, watching: bool, failure: str, short: bool) -> Content:
    """Return why there is nothing to see and what to do about it; empty if any node runs."""
    if failure:
        return _advice("Nothing is watched", f"{failure}\nTurn to another page and back to watch again.")
    if not watching:
        return _advice("Nothing is watched yet", "")
    if state.graph is None and not state.ready:
        return _advice("Joining your ROS domain", "")
    if state.nodes:
        return Content("")
    return Content.assemble(
        (f"No node runs in domain {state.domain}", "bold $foreground"),
        ": press ",
        ("r", "bold $accent"),
        " to run yours." if short else " to run yours.\nTopics, parameters, services and the graph appear here.",
    )


def near_miss_text(state: LiveState) -> str:
    """Return a line for each name that is nearly one of the lesson's, such as /temprature; empty if there is none."""
    misses = islice(near_misses(state.graph or Graph(), state.lesson_view), _MAX_NEAR_MISSES)
    return "\n".join(f"≈ {miss}" for miss in misses)


def _advice(head: str, text: str) -> Content:
    return Content.assemble((head, "bold $foreground"), f"\n\n{text}" if text else "")
