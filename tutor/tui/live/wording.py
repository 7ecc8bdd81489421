"""Numbers and names as the live page shows them. Pure."""

from __future__ import annotations

from tutor.live.updates import PublishStatus, TopicUpdate
from tutor.ros_model import Parameter


def short_type(name: str) -> str:
    """A type without `msg` or `srv` in its middle, as it is written in interface files."""
    parts = name.split("/")
    return f"{parts[0]}/{parts[-1]}" if len(parts) == 3 else name


def rate(hz: float) -> str:
    """A rate with three or four digits."""
    if hz >= 1000:
        return f"{hz:,.0f} Hz"
    return f"{hz:.1f} Hz" if hz >= 10 else f"{hz:.2f} Hz"


def period(seconds: float) -> str:
    """A period with three digits, in the unit that suits it."""
    if seconds >= 100:
        return f"{seconds:.0f} s"
    return f"{seconds:.3g} s" if seconds >= 0.9995 else f"{seconds * 1000:.3g} ms"


def periods(shortest_s: float, longest_s: float) -> str:
    """From the shortest to the longest, the unit once where they share it."""
    first, last = period(shortest_s), period(longest_s)
    return f"{first.split()[0] if first.split()[1] == last.split()[1] else first} to {last}"


def is_silent(update: TopicUpdate, since_update_s: float = 0.0) -> bool:
    """Whether a topic has stopped: silent for much longer than its period."""
    if update.silent_s is None:
        return False
    usual = update.timing.mean_s if update.timing else 1.0
    return update.silent_s + since_update_s > max(1.5, 4 * usual)


def numbers(update: TopicUpdate, since_update_s: float = 0.0) -> str:
    """Count, rate and jitter in one line; `since_update_s` is how long ago that update came, in seconds."""
    parts = [f"{update.count:,} message{'' if update.count == 1 else 's'}"]
    timing = update.timing
    if timing and is_silent(update, since_update_s):
        parts.append(f"silent for {period((update.silent_s or 0.0) + since_update_s)}")
    elif timing:
        parts.append(rate(timing.rate_hz))
        if timing.periods > 1:
            parts.append(f"jitter {period(timing.deviation_s)} ({periods(timing.shortest_s, timing.longest_s)})")
    if update.lost:
        parts.append(f"! {update.lost:,} lost")
    return " · ".join(parts)


def allowed(parameter: Parameter) -> str:
    """What a parameter may be set to."""
    if parameter.read_only:
        return "read-only"
    if parameter.minimum is None or parameter.maximum is None:
        return ""
    return f"{parameter.minimum:g} to {parameter.maximum:g}"


def publishing(held: PublishStatus) -> str:
    """What the learner publishes from here, and whether anybody listens."""
    if held.problem:
        return f"✗ not published on {held.topic}: {held.problem}"
    ears = "nobody listens" if not held.listeners else f"{held.listeners} listen{'s' if held.listeners == 1 else ''}"
    if not held.rate_hz:
        return f"✓ published once on {held.topic}: {ears}"
    sent = f"{held.sent:,} sent, {ears}"
    if held.over:
        return f"■ published on {held.topic}: {sent}"
    return f"▶ you publish on {held.topic} at {held.rate_hz:g} Hz: {sent} · M stops it"
