"""Numbers and names as the live page shows them. Pure."""

from __future__ import annotations

from tutor.live.updates import PublishStatus, TopicUpdate
from tutor.ros_model import Parameter, Timing

BURST_S = 0.01
"""Messages that all came within this time say nothing of a rate."""


def short_type(name: str) -> str:
    """Return a type without `msg` or `srv` in its middle, as interface files write it."""
    parts = name.split("/")
    return f"{parts[0]}/{parts[-1]}" if len(parts) == 3 else name


def rate(timing: Timing) -> str:
    """Return a rate with three or four digits, or that there was a single burst."""
    if is_burst(timing):
        return "a burst"
    hz = timing.rate_hz
    if hz >= 1000:
        return f"{hz:,.0f} Hz"
    return f"{hz:.1f} Hz" if hz >= 10 else f"{hz:.2f} Hz"


def is_burst(timing: Timing) -> bool:
    """Return whether all messages so far came at once."""
    return timing.periods * timing.mean_s < BURST_S


def period(seconds: float) -> str:
    """Return a period with three digits, in s or ms."""
    if seconds >= 100:
        return f"{seconds:.0f} s"
    return f"{seconds:.3g} s" if seconds >= 0.9995 else f"{seconds * 1000:.3g} ms"


def periods(shortest_s: float, longest_s: float) -> str:
    """Return a range of periods, the unit only once if both share it."""
    first, last = period(shortest_s), period(longest_s)
    return f"{first.split()[0] if first.split()[1] == last.split()[1] else first} to {last}"


def is_silent(update: TopicUpdate, since_update_s: float = 0.0) -> bool:
    """Return whether a topic has gone silent: no message for much longer than its period."""
    if update.silent_s is None:
        return False
    usual = update.timing.mean_s if update.timing else 1.0
    return update.silent_s + since_update_s > max(1.5, 4 * usual)


def numbers(update: TopicUpdate, since_update_s: float = 0.0) -> str:
    """Return count, rate and jitter on one line; `since_update_s` is the age of the update in seconds."""
    parts = [f"{update.count:,} message{'' if update.count == 1 else 's'}"]
    timing = update.timing
    if timing and is_silent(update, since_update_s):
        parts.append(f"silent for {period((update.silent_s or 0.0) + since_update_s)}")
    elif timing:
        parts.append(rate(timing))
        if timing.periods > 1 and not is_burst(timing):
            parts.append(f"jitter {period(timing.deviation_s)} ({periods(timing.shortest_s, timing.longest_s)})")
    if update.lost:
        parts.append(f"! {update.lost:,} lost")
    return " · ".join(parts)


def allowed(parameter: Parameter) -> str:
    """Return which values a parameter may be set to."""
    if parameter.read_only:
        return "read-only"
    if parameter.minimum is None or parameter.maximum is None:
        return ""
    return f"{parameter.minimum:g} to {parameter.maximum:g}"


def publishing(status: PublishStatus) -> str:
    """Return what the learner publishes from this page, and how many subscriptions receive it."""
    if status.problem:
        return f"✗ not published on {status.topic}: {status.problem}"
    audience = (
        "nobody listens" if not status.listeners else f"{status.listeners} listen{'s' if status.listeners == 1 else ''}"
    )
    if not status.rate_hz:
        return f"✓ published once on {status.topic}: {audience}"
    sent = f"{status.sent:,} sent, {audience}"
    if status.over:
        return f"■ published on {status.topic}: {sent}"
    return f"▶ you publish on {status.topic} at {status.rate_hz:g} Hz: {sent} · M stops it"
