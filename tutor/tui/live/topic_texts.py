"""What the topics tab says of a topic: its row, and the lines above its echo and its plot."""

from __future__ import annotations

import time

from rich.text import Text
from textual.content import Content

from tutor.ros_model import Topic
from tutor.tui.live import formatting
from tutor.tui.live.state import LiveState, TopicView


def plot_head(view: TopicView, band: tuple[float, float] | None) -> Content:
    """Return the line above the plot: the field, its last value, and the range that the lesson asks for, if any."""
    index = view.fields.index(view.path) + 1 if view.path in view.fields else 1
    last = view.points[-1][1] if view.points and view.snapshot is None else None
    value = "" if last is None else f" = {last:g}"
    more = f"  {index} of {len(view.fields)}" if len(view.fields) > 1 else ""
    asked: tuple[str, str] = ("", "")
    if band is not None:
        low, high = band
        asked = (f"  asked: {low:g} to {high:g}", "$good")
        if last is not None and not low <= last <= high:
            asked = (f"  ✗ asked: {low:g} to {high:g}", "bold $bad")
    return Content.assemble((view.path, "bold $primary"), value, asked, (more, "$quiet"))


def topic_head(state: LiveState, chosen: str, view: TopicView | None, now: float) -> Content:
    """Return the two lines above the echo of the chosen topic; `view` is None unless the topic is followed."""
    if not chosen:
        return Content("")
    name = Content.styled(chosen, "bold")
    if view is None:
        return Content.assemble(name, ("\nNot followed: press Enter to see what comes.", "$quiet"))
    update = view.snapshot.update if view.snapshot is not None else view.update
    if update is None:
        return Content.assemble(name, ("\n◐ subscribing", "$quiet"))
    facts = f"  {formatting.short_type(update.type)} · {update.qos}" if update.type else ""
    first = Content.assemble(name, (facts, "$quiet"))
    if update.problem:
        return Content.assemble(first, (f"\n✗ {update.problem}", "$bad"))
    if not update.count:
        topic = state.graph.topic(chosen) if state.graph else None
        no_publisher = topic is None or not topic.publishers
        reason = "nobody publishes yet: press M, or run a node that does" if no_publisher else "no message yet"
        return Content.assemble(first, (f"\n◐ {reason}", "$warn" if no_publisher else "$quiet"))
    since = 0.0 if view.snapshot is not None else max(0.0, now - view.updated_at)
    numbers = formatting.numbers(update, since)
    if view.snapshot is not None and view.update is not None:
        more = view.update.count - update.count
        return Content.assemble(first, (f"\n▮▮ paused (+{more:,}) ", "bold $warn"), numbers)
    mark, colour = ("■", "$quiet") if formatting.is_silent(update, since) else ("●", "$good")
    return Content.assemble(first, "\n", (f"{mark} ", colour), numbers)


def cells(state: LiveState, topic: Topic) -> tuple[Text, ...]:
    """Return a row of the table: mark, name, rate, count, publishers, subscriptions and types."""
    view = state.topics.get(topic.name)
    update = view.update if view else None
    silent = (
        update is not None
        and view is not None
        and formatting.is_silent(update, max(0.0, time.time() - view.updated_at))
    )
    timing = update.timing if update and not silent else None
    types = [formatting.short_type(name) for name in topic.types]
    if topic.is_standard:  # their types are long, and well known
        types = [name.rpartition("/")[2] for name in types]
    pub, sub = len(topic.publishers), len(topic.subscriptions)
    return (
        Text("●" if view else " "),
        Text(topic.name, style="bold" if state.is_lesson_topic(topic.name) else ""),
        Text(formatting.rate(timing) if timing else "silent" if silent else "", justify="right"),
        Text(f"{update.count:,}" if update else "", justify="right"),
        Text(str(pub), justify="right"),
        Text(str(sub), justify="right"),
        Text("✗ " + " and ".join(types) if len(types) > 1 else "".join(types)),
    )
