"""Which mistake is told where an event is not logged as it should be; and for code that is right, none."""

from __future__ import annotations

from math import nan
from typing import Any

import pytest

from tests.mistakes.cases import assert_told, told
from tutor.exercise.told_events import Event, Told
from tutor.judge.symptom import Symptom
from tutor.judge.trace import Level, LogRecord

CALLBACK = "class N(Node):\n  def on_door(self, door):\n    log = self.get_logger()\n"
BEFORE = (LogRecord(Level.INFO, "n", "door open", 0.0, 0.0, "on_door"),)
HELPER = (
    "class N(Node):\n  def warn(self, text):\n    self.get_logger().warning({})\n"
    "  def on_door(self, door):\n    self.warn('a')\n    self.warn('b')\n"
)
DEBUG = (LogRecord(Level.DEBUG, "n", "door", 0.0, 0.0),)


OWN_LOGGERS = (
    "class N(Node):\n  def warn(self, logger, text):\n    logger.warning(text, throttle_duration_sec=2.0)\n"
    "  def on_door(self, door):\n    self.warn(self.a, 'a')\n    self.warn(self.b, 'b')\n"
)
THROTTLED = f"PERIOD_S = 5.0\n{CALLBACK}    log.info('door open', throttle_duration_sec={{}})\n"


def event(value: float, at: float = 0.0) -> Told:
    return Told(Event("a weight", ({"data": value},), "error"), (at,), ())


@pytest.mark.parametrize(
    ("source", "about", "mistake", "words"),
    [
        (
            f"{CALLBACK}    log.info('door open', once=True)\n",
            {"earlier": BEFORE},
            "once-is-for-the-whole-run",
            "line 4",
        ),
        (f"{CALLBACK}    log.info('door open', once=False)\n", {"earlier": BEFORE}, "wrong-level", ""),
        (f"{CALLBACK}    log.info('door open', once=True)\n", {"earlier": ()}, "wrong-level", ""),
        (f"{CALLBACK}    log.info('a lift', once=True)\n", {"earlier": BEFORE}, "wrong-level", ""),
        (
            f"{CALLBACK}    log.info(f'door {{door:.0%}}', once=True)\n",
            {"earlier": BEFORE},
            "once-is-for-the-whole-run",
            "line 4",
        ),
        (
            f"{CALLBACK}    log.info('a lift', once=True)\n    log.info(f'door {{door}}', throttle_duration_sec=5.0)\n",
            {"earlier": BEFORE},
            "throttled-though-each-one-counts",
            "line 5",
        ),
        (
            HELPER.format("text, throttle_duration_sec=2.0"),
            {},
            "throttle-shared-by-a-helper",
            "line 3 logs for 2 callers",
        ),
        (HELPER.format("text"), {}, "wrong-level", ""),
        (
            HELPER.format("text, throttle_duration_sec=2.0"),
            {"wanted": Level.WARN},
            "throttle-shared-by-a-helper",
            "2 callers",
        ),
        (HELPER.format("text, throttle_duration_sec=2.0"), {"wanted": Level.DEBUG}, "wrong-level", ""),
        (OWN_LOGGERS, {"wanted": Level.WARN}, "wrong-level", ""),
        (
            THROTTLED.format("PERIOD_S"),
            {"earlier": BEFORE, "event": event(7.0, at=4.0)},
            "throttled-though-each-one-counts",
            "line 5",
        ),
        (THROTTLED.format("PERIOD_S"), {"earlier": BEFORE, "event": event(7.0, at=6.0)}, "wrong-level", ""),
        (THROTTLED.format("2"), {"earlier": BEFORE, "event": event(7.0, at=4.0)}, "wrong-level", ""),
        (
            THROTTLED.format("self.period"),
            {"earlier": BEFORE, "event": event(7.0, at=6.0)},
            "throttled-though-each-one-counts",
            "line 5",
        ),
        (HELPER.format("'low', throttle_duration_sec=2.0"), {}, "wrong-level", ""),
        ("x = 1\nself.get_logger().set_level(20)\n", {"wanted": Level.DEBUG}, "level-set-in-the-code", "line 2"),
        ("if charge < 0.0 or charge > 1.0:\n  pass\n", {"event": event(nan)}, "nan-passes-every-comparison", "NaN"),
        (
            "if charge < 0.0:\n  pass\nelif charge > 1.0:\n  pass\n",
            {"event": event(nan)},
            "nan-passes-every-comparison",
            "",
        ),
        (
            f"{CALLBACK}    if door < 0 or door > 1:\n      pass\n  def other(self, x):\n    return math.isnan(x)\n",
            {"event": event(nan)},
            "nan-passes-every-comparison",
            "",
        ),
        ("if math.isnan(x) or x < 0.0 or x > 1.0:\n  pass\n", {"event": event(nan)}, "wrong-level", ""),
        ("if charge < 0.0 or charge > 1.0:\n  pass\n", {"event": event(7.0)}, "wrong-level", ""),
        ("print(charge)\n", {"event": event(nan)}, "wrong-level", ""),
        ("if not 0.0 <= charge <= 1.0:\n  pass\n", {"event": event(nan)}, "wrong-level", ""),
        ("if math.isnan(charge):\n  pass\n", {"event": event(nan)}, "wrong-level", ""),
    ],
)
def test_why_an_event_is_not_logged_at_its_level(source: str, about: dict[str, Any], mistake: str, words: str) -> None:
    assert_told(told(Symptom.WRONG_LEVEL, source, **about), mistake, words)


@pytest.mark.parametrize(
    ("source", "about", "mistake"),
    [
        (f"{CALLBACK}    log.get_child('d').warn('x', throttle_duration_sec=2.0)\n", {}, "throttle-without-memory"),
        (
            f"{CALLBACK}    mine = log.get_child('d')\n    mine.warn('x', throttle_duration_sec=2.0)\n",
            {},
            "throttle-without-memory",
        ),
        (f"{CALLBACK}    get_logger('d').warn('x', throttle_duration_sec=2.0)\n", {}, "throttle-without-memory"),
        (f"{CALLBACK}    log.warn('x', throttle_duration_sec=2.0)\n", {}, "logged-too-often"),
        (f"{CALLBACK}    self.child.warn('x', throttle_duration_sec=2.0)\n", {}, "logged-too-often"),
        ("x = 1\nself.get_logger().set_level(10)\n", {"logged": DEBUG}, "level-set-in-the-code"),
        ("x = 1\nself.get_logger().set_level(10)\n", {"logged": BEFORE}, "logged-too-often"),
    ],
)
def test_why_an_event_is_logged_too_often(source: str, about: dict[str, Any], mistake: str) -> None:
    about = {"logged": BEFORE, **about}
    assert_told(told(Symptom.LOGGED_TOO_OFTEN, source, **about), mistake)
