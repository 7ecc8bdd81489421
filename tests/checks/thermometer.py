"""I1.1: what could be observed of a thermometer."""

from __future__ import annotations

from functools import partial

from checks.i1_1_sensor_publisher import CHECK, TEMPERATURE
from tests.checks import builders
from tests.checks.builders import graph, samples

TOPIC, TYPE = TEMPERATURE.name, TEMPERATURE.type
PUBLISHING = graph(publishers={TOPIC: TYPE})
MESSAGES = samples(TOPIC, 2.0, data=23.5)

assert_failed = partial(builders.assert_failed, check=CHECK)
