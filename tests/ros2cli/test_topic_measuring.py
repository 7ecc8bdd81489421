"""ros2 topic hz, bw and delay, on a real talker."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest

from tests.ros2cli.bench import TALKER, Bench, Ran
from tutor.bundled_ros.ros2.topic.statistics import Rate, format_size

STAMPED = """
from geometry_msgs.msg import PointStamped
node = rclpy.create_node("stamped")
publisher = node.create_publisher(PointStamped, "point", 10)
def publish():
    point = PointStamped()
    point.header.stamp = node.get_clock().now().to_msg()
    publisher.publish(point)
node.create_timer(0.05, publish)
spin(node)
"""
SPREAD = r"\tmin: (\d\.\d{3})s max: \d\.\d{3}s std dev: \d\.\d{5}s window: (\d+)"


@pytest.fixture(scope="module")
def talker_bench(module_bench: Bench) -> Iterator[Bench]:
    """A bench with a talker on its domain."""
    with module_bench.node(TALKER):
        yield module_bench


def test_hz_prints_the_rate(talker_bench: Bench) -> None:
    with talker_bench.running("topic", "hz", "/chatter") as hz:
        rate = re.fullmatch(r"average rate: (\d+\.\d{3})", hz.line())
        spread = re.fullmatch(SPREAD, hz.line())
        ran = hz.interrupt()
    assert rate
    assert spread
    assert 10 < float(rate[1]) < 25
    assert (ran.stdout, ran.stderr, ran.code) == ("", "", 2)


def test_hz_waits_for_a_topic(bench: Bench) -> None:
    with bench.running("topic", "hz", "/chatter") as hz:
        assert hz.line() == "WARNING: topic [/chatter] does not appear to be published yet"
        with bench.node(TALKER):
            assert hz.line().startswith("average rate: ")
        assert hz.interrupt().code == 2


def test_bw_prints_the_bandwidth(talker_bench: Bench) -> None:
    with talker_bench.running("topic", "bw", "/chatter") as bw:
        assert bw.line() == "Subscribed to [/chatter]"
        assert re.fullmatch(r"\d+ B/s from \d+ messages", bw.line())
        assert re.fullmatch(r"\tMessage size mean: (\d\d) B min: \d\d B max: \d\d B", bw.line())
        assert bw.interrupt().code == 2


def test_delay_prints_the_age_of_messages(bench: Bench) -> None:
    with bench.node(STAMPED), bench.running("topic", "delay", "/point") as delay:
        assert re.fullmatch(r"average delay: \d+\.\d{3}", delay.line())
        assert re.fullmatch(SPREAD, delay.line())
        assert delay.interrupt().code == 2


def test_delay_needs_a_header(talker_bench: Bench) -> None:
    assert talker_bench.ros2("topic", "delay", "/chatter") == Ran("", "msg does not have header\n", 1)


def test_rate_is_printed_a_quarter_second_after_the_second_message_then_every_second() -> None:
    rate, quarter = Rate(100), 250_000_000
    printed = [rate.add(1_000 + quarter * number) for number in range(11)]
    assert [number for number, text in enumerate(printed) if text is not None] == [2, 6, 10]
    assert printed[2] == "average rate: 4.000\n\tmin: 0.250s max: 0.250s std dev: 0.00000s window: 2"


def test_a_clock_jump_backwards_resets_the_rate() -> None:
    rate = Rate(3)
    for second in (10, 11, 12, 1, 2):
        rate.add(second * 1_000_000_000)
    assert len(rate.between_ns) == 1
    assert rate.add(0) == "time has reset, resetting counters"


@pytest.mark.parametrize(("count", "expected"), [(12.4, "12 B"), (1500, "1.50 KB"), (2_340_000, "2.34 MB")])
def test_sizes_are_printed_in_a_suitable_unit(count: float, expected: str) -> None:
    assert format_size(count, count) == expected
