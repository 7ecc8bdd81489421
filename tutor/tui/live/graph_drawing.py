"""The graph as a drawing: nodes in boxes at the left and the right, topics between them, and arrows. Pure.

╭─────────╮   ┏━━━━━━━━━━━━━━━━━━━┓   ╭────────────────╮
│ /talker ├──▶┃ /chatter          ┃─┬▶│ /listener      │
╰─────────╯   ┗━ std_msgs/String ━┛ │ ╰────────────────╯
                                    │ ╭────────────────╮
                                    └✗│ /message_stats │
                                      ╰────────────────╯
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from rich.cells import cell_len

from tutor.ros_model import Topic, connections
from tutor.tui.live.wording import short_type
from tutor.tui.widgets.line_view import Piece, Row

_BOX = 3
"""This many rows a node or a topic takes."""

_ARROW = 4
_NARROWEST = 14


@dataclass(frozen=True, slots=True)
class DrawnTopic:
    """One topic, drawn. `connected`: whether messages get from a publisher to each of `listeners`."""

    publishers: tuple[str, ...]
    name: str
    type: str
    listeners: tuple[tuple[str, bool], ...]


def _drawn_topic(topic: Topic) -> DrawnTopic:
    """What is to be drawn of a topic; a listener that no publisher matches is not connected."""
    pairs = list(connections(topic))
    nodes = dict.fromkeys(end.node for end in topic.subscriptions)
    listeners = tuple(
        (node, not topic.publishers or any(not p.problems for p in pairs if p.subscription.node == node))
        for node in nodes
    )
    publishers = tuple(dict.fromkeys(end.node for end in topic.publishers))
    return DrawnTopic(publishers, topic.name, " ✗ ".join(map(short_type, topic.types)), listeners)


def draw_graph(topics: Sequence[Topic], width: int) -> list[Row]:
    """All topics; those that one node publishes alone hang on one box of it."""
    every = sorted(map(_drawn_topic, topics), key=lambda each: (each.publishers, each.name))
    widths = _widths(every, width)
    rows: list[Row] = []
    for publishers, group in itertools.groupby(every, key=lambda each: each.publishers):
        rows += _block(publishers, list(group), widths)
    return rows


def _widths(every: Sequence[DrawnTopic], width: int) -> tuple[int, int, int]:
    """What the three columns take, borders and all; the widest gives way where there is no room."""
    lefts = [cell_len(name) + 4 for each in every for name in each.publishers or (_NOBODY,)]
    middles = [max(cell_len(each.name) + 4, cell_len(each.type) + 7) for each in every]
    rights = [cell_len(name) + 4 for each in every for name, _ in each.listeners] or [cell_len(_NO_EARS)]
    columns = [max(some, default=_NARROWEST) for some in (lefts, middles, rights)]
    while sum(columns) + 2 * _ARROW + 2 > width and max(columns) > _NARROWEST:
        columns[columns.index(max(columns))] -= 1
    return columns[0], columns[1], columns[2]


_NOBODY = "nobody publishes"
_NO_EARS = "nobody listens"


def _block(publishers: tuple[str, ...], group: Sequence[DrawnTopic], widths: tuple[int, int, int]) -> Iterator[Row]:
    """Topics with the same publishers: one box for one node, or a stack of boxes for each topic."""
    left, _, _ = widths
    if len(publishers) > 1:
        for each in group:
            rights = list(_right(each, widths))
            height = max(len(rights), _BOX * len(publishers))
            yield from _beside(_stack(publishers, left, height), rights, height)
        return
    rights = [row for each in group for row in _right(each, widths)]
    outlets = list(itertools.accumulate((len(list(_right(each, widths))) for each in group), initial=0))[:-1]
    yield from _beside(_box(publishers, left, [at + 1 for at in outlets], len(rights)), rights, len(rights))


def _beside(lefts: list[Row], rights: list[Row], height: int) -> Iterator[Row]:
    empty: Row = ()
    for one, other in itertools.islice(itertools.zip_longest(lefts, rights, fillvalue=empty), height):
        yield (*one, *other)


def _box(publishers: tuple[str, ...], width: int, outlets: Sequence[int], height: int) -> list[Row]:
    """One node's box down to its last outlet, with an arrow at each."""
    name = publishers[0] if publishers else ""
    last = outlets[-1] + 1
    rows: list[Row] = []
    for y in range(height):
        out = y in outlets
        if not publishers:
            text = _fit(f" {_NOBODY}" if out else "", width)
            rows.append(((text, "warn"), (" " * _ARROW, "")))
            continue
        if y == 0:
            box = "╭" + "─" * (width - 2) + "╮"
        elif y == last:
            box = "╰" + "─" * (width - 2) + "╯"
        elif y < last:
            box = f"│ {_fit(name if y == 1 else '', width - 4)} " + ("├" if out else "│")
        else:
            box = " " * width
        rows.append(((box, "name" if y == 1 else "node"), ("───▶" if out else " " * _ARROW, "arrow")))
    return rows


def _stack(publishers: tuple[str, ...], width: int, height: int) -> list[Row]:
    """Boxes one below the other, whose arrows meet at the topic's row."""
    rows: list[Row] = []
    final = _BOX * (len(publishers) - 1) + 1
    for y in range(height):
        place, line = divmod(y, _BOX)
        if place >= len(publishers):
            rows.append(((" " * (width + _ARROW), ""),))
            continue
        box = (
            "╭" + "─" * (width - 2) + "╮",
            f"│ {_fit(publishers[place], width - 4)} ├",
            "╰" + "─" * (width - 2) + "╯",
        )[line]
        joint = (
            "─┬─▶" if y == 1 else "─╯  " if y == final else "─┤  " if line == 1 else " │  " if 1 < y < final else "    "
        )
        rows.append(((box, "name" if line == 1 else "node"), (joint, "arrow")))
    return rows


def _right(each: DrawnTopic, widths: tuple[int, int, int]) -> Iterator[Row]:
    """A topic and who listens to it."""
    _, middle, right = widths
    final = _BOX * (len(each.listeners) - 1) + 1
    for y in range(max(_BOX, _BOX * len(each.listeners))):
        place, line = divmod(y, _BOX)
        topic = " " * middle
        if y < _BOX:
            kind = f" {_fit(each.type, middle - 7).rstrip()} "
            topic = (
                "┏" + "━" * (middle - 2) + "┓",
                f"┃ {_fit(each.name, middle - 4)} ┃",
                "┗━" + kind + "━" * (middle - 3 - cell_len(kind)) + "┛",
            )[y]
        head: Piece = (topic, "topic")
        if not each.listeners:
            yield (head, (f"  {_NO_EARS}" if y == 1 else "", "quiet"))
            continue
        node, connected = each.listeners[place]
        box = (
            "╭" + "─" * (right - 2) + "╮",
            f"│ {_fit(node, right - 4)} │",
            "╰" + "─" * (right - 2) + "╯",
        )[line]
        yield (head, *_split(y, line, final, connected), (box, "name" if line == 1 else "node"))


def _split(y: int, line: int, final: int, connected: bool) -> Iterator[Piece]:
    """The piece of an arrow from a topic to one of its listeners that is in row `y`."""
    tip = "▶" if connected else "✗"
    kind = "arrow" if connected else "bad"
    if line != 1:
        yield ("  │ " if 1 < y < final else "    ", "arrow")
    elif y == 1:
        yield ("──", "arrow" if connected or final > 1 else "bad")
        yield ("┬" if final > 1 else "─", "arrow" if connected or final > 1 else "bad")
        yield (tip, kind)
    else:
        yield ("  ╰" if y == final else "  ├", "arrow")
        yield (tip, kind)


def _fit(text: str, width: int) -> str:
    """A text in this many cells, its middle left out where it is too long."""
    if cell_len(text) <= width:
        return text + " " * (width - cell_len(text))
    head = max(1, (width - 1) // 3)
    return f"{text[:head]}…{text[len(text) - (width - 1 - head) :]}"
