"""What each lesson is about, on DDS: chosen on the live page as soon as it appears. Any other can be chosen as well."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Preset:
    """`topics` are followed, the first of them is shown; `service` is the one whose form is opened."""

    topics: tuple[str, ...] = ()
    service: str = ""


PRESETS = {
    "i1.1": Preset(("/sensor/temperature",)),
    "i1.2": Preset(("/chatter",)),
    "i1.3": Preset(service="/add"),
    "i2.1": Preset(("/chatter",)),
    "i2.2": Preset(("/chatter",)),
    "i2.3": Preset(service="/slow_add"),
}
