"""B1.6 At the Right Level: a battery monitor that logs each event at its level, once, throttled, or not at all."""

from __future__ import annotations

import random
import re
from collections.abc import Mapping
from math import nan
from typing import Any

from tutor.exercise import EndsCleanly, Event, Feed, LogsAt, Program, StaysQuiet, Throttles, Topic, check

BATTERY = Topic("/battery", "sensor_msgs/msg/BatteryState", "percentage")
CHARGING, DISCHARGING, NOT_CHARGING, FULL = 1, 2, 3, 4

FIRST, READING, ORDINARY, CHANGE = "the first reading", "a reading", "an ordinary reading", "a change of status"
LOW, HOT, LOW_TOO = "the battery is low", "the battery is hot", "the battery is hot, and now low as well"
OUTAGE, RECOVERY = "an outage", "readings that are good again"

PERIOD_S = 2.0
FLOOD = 104  # of low readings: 5.2 s, more than twice the period
HARDLY = 30  # of them are only just low: for 1.5 s

Reading = dict[str, Any]


def reading(status: int, charge: float | None = None, celsius: float | None = None) -> Reading:
    """A reading with a random charge and temperature, unless they are given."""
    return {
        "power_supply_status": status,
        "percentage": random.randint(40, 95) / 100 if charge is None else charge,
        "temperature": random.randint(200, 320) / 10 if celsius is None else celsius,
    }


def low_charge() -> float:
    """A charge below 20 %."""
    return random.randint(3, 18) / 100


def hardly_low() -> float:
    """A charge that is only just below 20 %: whoever waits for less is late."""
    return random.randint(17, 19) / 100


def hardly_hot() -> float:
    """A temperature that is only just above 45 °C."""
    return random.randint(452, 459) / 10


def ordinary(status: int) -> Event:
    """Readings that are nothing to speak of, some of them only just."""
    nearly = [reading(status, random.randint(21, 24) / 100), reading(status, 1.0), reading(status, celsius=45.0)]
    return one_of(ORDINARY, *random.sample(nearly, len(nearly)), reading(status))


def one_of(kind: str, *messages: Reading, at: str = "") -> Event:
    """An event of these readings."""
    return Event(kind, messages, at)


def good(status: int) -> Event:
    """Readings that are good again: someone may wait for the third before saying so."""
    return one_of(RECOVERY, *(reading(status) for _ in range(3)))


def shift() -> tuple[Event, ...]:
    """What happens while someone is on call: one thing after another."""
    begins, other, last = random.sample((CHARGING, DISCHARGING, NOT_CHARGING, FULL), 3)
    return (
        one_of(FIRST, reading(begins), at="info"),
        one_of(HOT, *(reading(begins, celsius=hardly_hot()) for _ in range(3)), at="warn"),
        one_of(LOW_TOO, *(reading(begins, low_charge(), hardly_hot()) for _ in range(3)), at="warn"),
        good(begins),
        ordinary(begins),
        *(one_of(CHANGE, reading(status), at="info") for status in (other, begins, last)),
        ordinary(last),
        one_of(OUTAGE, *(reading(last, charge=-random.randint(1, 10) / 10) for _ in range(3)), at="error"),
        good(last),
        one_of(OUTAGE, *(reading(last, charge=nan) for _ in range(random.randint(3, 5))), at="error"),
        good(last),
        one_of(OUTAGE, *(reading(last, charge=charge) for charge in (71.0, 64.0, nan, 1.5)), at="error"),
        good(last),
        one_of(LOW, *(reading(last, charge=low_charge()) for _ in range(3)), at="warn"),
        one_of(HOT, *(reading(last, low_charge(), random.uniform(52, 70)) for _ in range(10)), at="warn"),
    )


def shows_charge(text: str, message: Mapping[str, Any]) -> bool:
    """Whether a text has the charge, as a fraction or in percent; it may be rounded to a whole percent."""
    numbers = [float(number) for number in re.findall(r"(?:(?<!\w)-)?\d+(?:\.\d+)?", text)]
    charge = message["percentage"]
    return any(abs(number - charge) < 0.0101 or abs(number - 100 * charge) < 1.01 for number in numbers)


def discharging() -> list[float]:
    """The charges of the flood: only just low for longer than the first warning may take, then whatever is low."""
    return [hardly_low() if number < HARDLY else low_charge() for number in range(FLOOD)]


SHIFT = Feed(BATTERY, shift())
FLOODED = Feed(
    BATTERY,
    (
        one_of(ORDINARY, reading(DISCHARGING)),
        one_of(LOW, *(reading(DISCHARGING, charge=charge) for charge in discharging()), at="warn"),
    ),
)


def good_readings() -> tuple[Reading, ...]:
    """Good readings, the last two of them the same."""
    last = reading(FULL)
    return reading(CHARGING), reading(CHARGING), reading(FULL, low_charge()), last, last


DEBUGGED = Feed(BATTERY, tuple(one_of(READING, each, at="debug") for each in good_readings()), log_level="debug")

low = Throttles("low", FLOODED, LOW, period_s=PERIOD_S)

CHECK = check(
    "b1.6",
    Program("battery_monitor.py"),
    LogsAt("first", SHIFT, FIRST, at_most=2),  # perhaps also its status, which is new as well
    StaysQuiet("quiet", SHIFT, ORDINARY, calm=(RECOVERY, FIRST, CHANGE)),
    LogsAt("changes", SHIFT, CHANGE),
    LogsAt("readings", DEBUGGED, READING, at_most=0, shows=shows_charge),
    low,
    LogsAt("hot", SHIFT, HOT, also=LOW_TOO, after=low),
    LogsAt("broken", SHIFT, OUTAGE),
    EndsCleanly("shutdown", bonus=True),
    expected_s=8.0,
    expected_reason="a low battery: 5.2 s of readings, in which a throttled warning comes three times",
)
