"""Draw the graph: nodes in boxes at the left and the right, topics between them, and arrows. Pure.

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
from tutor.tui.live.formatting import short_type
from tutor.tui.widgets.line_view import Piece, Row

_BOX_ROWS = 3
"""The height of a node's or a topic's box, in rows."""

_ARROW_CELLS = 4
"""The width of an arrow."""

_MIN_COLUMN_CELLS = 14
"""No column gets narrower than this."""

_NOBODY = "nobody publishes"
_NO_LISTENERS = "nobody listens"


@dataclass(frozen=True, slots=True)
class DrawnTopic:
    """What to draw of one topic. `listeners`: node names, each with whether any publisher is connected to it."""

    publishers: tuple[str, ...]
    name: str
    type: str
    listeners: tuple[tuple[str, bool], ...]


def _drawn_topic(topic: Topic) -> DrawnTopic:
    """Return what to draw of a topic. A listener is connected unless there are publishers and none of them matches."""
    pairs = list(connections(topic))
    nodes = dict.fromkeys(end.node for end in topic.subscriptions)
    listeners = tuple(
        (node, not topic.publishers or any(not p.problems for p in pairs if p.subscription.node == node))
        for node in nodes
    )
    publishers = tuple(dict.fromkeys(end.node for end in topic.publishers))
    return DrawnTopic(publishers, topic.name, " ✗ ".join(map(short_type, topic.types)), listeners)


def draw_graph(topics: Sequence[Topic], width: int) -> list[Row]:
    """Draw the topics; those that only one node publishes share one box of that node."""
    drawn = sorted(map(_drawn_topic, topics), key=lambda topic: (topic.publishers, topic.name))
    widths = _column_widths(drawn, width)
    rows: list[Row] = []
    for publishers, group in itertools.groupby(drawn, key=lambda topic: topic.publishers):
        rows += _block(publishers, list(group), widths)
    return rows


def _column_widths(drawn: Sequence[DrawnTopic], width: int) -> tuple[int, int, int]:
    """Return the widths of the three columns, borders included; the widest shrinks first if there is no room."""
    lefts = [cell_len(name) + 4 for topic in drawn for name in topic.publishers or (_NOBODY,)]
    middles = [max(cell_len(topic.name) + 4, cell_len(topic.type) + 7) for topic in drawn]
    rights = [cell_len(name) + 4 for topic in drawn for name, _ in topic.listeners] or [cell_len(_NO_LISTENERS)]
    columns = [max(widths, default=_MIN_COLUMN_CELLS) for widths in (lefts, middles, rights)]
    while sum(columns) + 2 * _ARROW_CELLS + 2 > width and max(columns) > _MIN_COLUMN_CELLS:
        columns[columns.index(max(columns))] -= 1
    return columns[0], columns[1], columns[2]


def _block(publishers: tuple[str, ...], group: Sequence[DrawnTopic], widths: tuple[int, int, int]) -> Iterator[Row]:
    """Draw topics with the same publishers: one box for a single node, or a stack of boxes per topic."""
    left, _, _ = widths
    if len(publishers) > 1:
        for topic in group:
            rights = list(_topic_rows(topic, widths))
            height = max(len(rights), _BOX_ROWS * len(publishers))
            yield from _join_columns(_publisher_stack(publishers, left, height), rights, height)
        return
    rights = [row for topic in group for row in _topic_rows(topic, widths)]
    outlets = list(itertools.accumulate((len(list(_topic_rows(topic, widths))) for topic in group), initial=0))[:-1]
    yield from _join_columns(
        _publisher_box(publishers, left, [at + 1 for at in outlets], len(rights)), rights, len(rights)
    )


def _join_columns(lefts: list[Row], rights: list[Row], height: int) -> Iterator[Row]:
    empty: Row = ()
    for one, other in itertools.islice(itertools.zip_longest(lefts, rights, fillvalue=empty), height):
        yield (*one, *other)


def _publisher_box(publishers: tuple[str, ...], width: int, outlets: Sequence[int], height: int) -> list[Row]:
    """Draw one node's box, from the top to its last outlet, with an arrow at each outlet."""
    name = publishers[0] if publishers else ""
    last = outlets[-1] + 1
    rows: list[Row] = []
    for y in range(height):
        out = y in outlets
        if not publishers:
            text = _fit(f" {_NOBODY}" if out else "", width)
            rows.append(((text, "warn"), (" " * _ARROW_CELLS, "")))
            continue
        if y == 0:
            box = "╭" + "─" * (width - 2) + "╮"
        elif y == last:
            box = "╰" + "─" * (width - 2) + "╯"
        elif y < last:
            box = f"│ {_fit(name if y == 1 else '', width - 4)} " + ("├" if out else "│")
        else:
            box = " " * width
        rows.append(((box, "name" if y == 1 else "node"), ("───▶" if out else " " * _ARROW_CELLS, "arrow")))
    return rows


def _publisher_stack(publishers: tuple[str, ...], width: int, height: int) -> list[Row]:
    """Draw boxes one below the other, whose arrows join at the topic's row."""
    rows: list[Row] = []
    last_joint = _BOX_ROWS * (len(publishers) - 1) + 1
    for y in range(height):
        index, line = divmod(y, _BOX_ROWS)
        if index >= len(publishers):
            rows.append(((" " * (width + _ARROW_CELLS), ""),))
            continue
        box = (
            "╭" + "─" * (width - 2) + "╮",
            f"│ {_fit(publishers[index], width - 4)} ├",
            "╰" + "─" * (width - 2) + "╯",
        )[line]
        joint = (
            "─┬─▶"
            if y == 1
            else "─╯  "
            if y == last_joint
            else "─┤  "
            if line == 1
            else " │  "
            if 1 < y < last_joint
            else "    "
        )
        rows.append(((box, "name" if line == 1 else "node"), (joint, "arrow")))
    return rows


def _topic_rows(topic: DrawnTopic, widths: tuple[int, int, int]) -> Iterator[Row]:
    """Draw a topic and its listeners."""
    _, middle, right = widths
    last_joint = _BOX_ROWS * (len(topic.listeners) - 1) + 1
    for y in range(max(_BOX_ROWS, _BOX_ROWS * len(topic.listeners))):
        index, line = divmod(y, _BOX_ROWS)
        topic_box = " " * middle
        if y < _BOX_ROWS:
            kind = f" {_fit(topic.type, middle - 7).rstrip()} "
            topic_box = (
                "┏" + "━" * (middle - 2) + "┓",
                f"┃ {_fit(topic.name, middle - 4)} ┃",
                "┗━" + kind + "━" * (middle - 3 - cell_len(kind)) + "┛",
            )[y]
        head: Piece = (topic_box, "topic")
        if not topic.listeners:
            yield (head, (f"  {_NO_LISTENERS}" if y == 1 else "", "quiet"))
            continue
        node, connected = topic.listeners[index]
        box = (
            "╭" + "─" * (right - 2) + "╮",
            f"│ {_fit(node, right - 4)} │",
            "╰" + "─" * (right - 2) + "╯",
        )[line]
        yield (head, *_listener_arrow(y, line, last_joint, connected), (box, "name" if line == 1 else "node"))


def _listener_arrow(y: int, line: int, last_joint: int, connected: bool) -> Iterator[Piece]:
    """Yield row `y` of the arrows from a topic to its listeners; `line` is the row within a listener's box."""
    tip = "▶" if connected else "✗"
    kind = "arrow" if connected else "bad"
    if line != 1:
        yield ("  │ " if 1 < y < last_joint else "    ", "arrow")
    elif y == 1:
        yield ("──", "arrow" if connected or last_joint > 1 else "bad")
        yield ("┬" if last_joint > 1 else "─", "arrow" if connected or last_joint > 1 else "bad")
        yield (tip, kind)
    else:
        yield ("  ╰" if y == last_joint else "  ├", "arrow")
        yield (tip, kind)


def _fit(text: str, width: int) -> str:
    """Fit a text into this many cells: padded, or with its middle left out."""
    if cell_len(text) <= width:
        return text + " " * (width - cell_len(text))
    head = max(1, (width - 1) // 3)
    return f"{text[:head]}…{text[len(text) - (width - 1 - head) :]}"
