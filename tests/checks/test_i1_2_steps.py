"""I1.2: causes and next steps, in terms of the learner's own file."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import pytest

from checks.i1_2 import gap_steps, steps
from checks.i1_2.judges import judge_slow_summary
from tests.checks.builders import assert_failed, trace
from tests.checks.test_i1_2 import FakeStats, Log, jump, steady
from tests.repairs import apply_step
from tutor.judge.trace import Trace
from tutor.judge.verdict import Cause

NODE = """\
class Stats(Node):
    def __init__(self):
        super().__init__('message_stats')
        self.create_subscription(String, 'chatter', self.listen, 10)
        self.total_count = 0
        self.last_number = None

    def listen(self, msg):
        self.total_count += 1
        number = int(msg.data.split(':')[1])
        if self.last_number is not None and number > self.last_number + 1:
            self.get_logger().warning(f'{number - self.last_number - 1} messages are missing')
        self.last_number = number
"""


def started(*pairs: tuple[str, str], code: str = NODE) -> Trace:
    """A run of the node with each of these texts replaced."""
    for old, new in pairs:
        assert old in code
        code = code.replace(old, new)
    return trace(sources={"node.py": code})


def follow_step(run: Trace, step: str) -> str:
    """The file after following the step to the letter."""
    return apply_step(step, run.sources)["node.py"]


def test_a_correct_node_gets_no_cause() -> None:
    assert gap_steps.diagnose_alarm(started()) is None
    assert gap_steps.diagnose_no_messages(started()) is None
    assert gap_steps.diagnose_alarm(started(code="def f(:")) is None


@pytest.mark.parametrize(
    ("reads", "what"),
    [
        ("int(msg.data[-1:])", "reads 7 out of “Hello World: 107”"),
        ("int(msg.data[-2])", "reads 0 out of “Hello World: 107”"),
        ("int(msg.data[-2:])", "reads 7 out of “Hello World: 107”"),
        ("int(msg.data[-3:])", "reads no number out of “Hello World: 4”"),
        ("int(msg.data.split()[1])", "reads no number out of “Hello World: 107”"),
        ("int(msg.data)", "reads no number out of “Hello World: 107”"),
        ("int(msg.data.strip().replace('Hello', ''))", "reads no number out of"),
        ("int(msg.data.split(' ')[-1][0])", "reads 1 out of “Hello World: 107”"),
    ],
)
def test_a_number_parsed_from_the_wrong_place(reads: str, what: str) -> None:
    for diagnose in (gap_steps.diagnose_alarm, gap_steps.diagnose_no_messages):
        cause = diagnose(started(("int(msg.data.split(':')[1])", reads)))
        assert cause is not None
        assert (cause.name, cause.text) == ("number misread", f"line 10: {reads} {cause.text.partition(reads)[2][1:]}")
        assert what in cause.text
        assert cause.hint == "line 10 becomes: number = int(msg.data.rpartition(':')[2])"


@pytest.mark.parametrize(
    "reads",
    [
        "int(msg.data.split(':')[-1].strip())",
        "int(msg.data.rpartition(' ')[2])",
        "int(msg.data[13:])",
        "int(msg.data.removeprefix('Hello World: '))",
        "int(re.findall('[0-9]+', msg.data)[0])",
        "self.number_of(msg)",
    ],
)
def test_a_number_parsed_correctly_or_in_an_unknown_way_is_not_blamed(reads: str) -> None:
    assert gap_steps.diagnose_alarm(started(("int(msg.data.split(':')[1])", reads))) is None


def test_number_parsing_is_traced_through_variables_and_helpers() -> None:
    apart = ("number = int(msg.data.split(':')[1])", "parts = msg.data.split()\n        number = int(parts[1])")
    cause = gap_steps.diagnose_no_messages(started(apart))
    assert cause is not None
    assert cause.hint == "line 11 becomes: number = int(msg.data.rpartition(':')[2])"
    helper = NODE.replace("number = int(", "self.check(msg.data)\n\n    def check(self, data):\n        number = int(")
    cause = gap_steps.diagnose_alarm(started(("msg.data.split(':')[1]", "data[-1]"), code=helper))
    assert cause is not None
    assert cause.hint == "line 13 becomes: number = int(data.rpartition(':')[2])"


SEPARATE_CLASS = """\
class Order:
    GAP, RESTART = range(2)

    def __init__(self):
        self.expected, self.highest = 0, -1

    def feed(self, number):
        if number < self.highest:
            self.highest = number
            self.expected = number + 1
            return self.RESTART
        self.highest = number
        verdict = None if number == self.expected else self.GAP
        self.expected += 1
        return verdict


class Stats(Node):
    def __init__(self):
        super().__init__('message_stats')
        self.order = Order()
        self.create_subscription(String, 'chatter', self.on_message, 10)

    def on_message(self, msg):
        verdict = self.order.feed(int(msg.data.split(':')[1]))
        if verdict == Order.GAP:
            self.get_logger().warning(f'a gap before {msg.data}')
        elif verdict == Order.RESTART:
            self.get_logger().info('restarted')
"""


def test_an_expected_number_that_only_counts_on() -> None:
    cause = gap_steps.diagnose_alarm(started(code=SEPARATE_CLASS))
    assert cause is not None
    assert cause.text == "line 14: self.expected += 1 keeps counting from before the gap, and never catches up"
    assert cause.hint == "line 14 becomes: self.expected = number + 1"
    right = SEPARATE_CLASS.replace("self.expected += 1", "self.expected = number + 1")
    assert gap_steps.diagnose_alarm(started(code=right)) is None


COMPARES = "self.last_number is not None and number > self.last_number + 1"


@pytest.mark.parametrize("test", ["number != self.total_count", "number > self.total_count - 1"])
def test_a_number_compared_with_the_count(test: str) -> None:
    run = started((COMPARES, test))
    cause = gap_steps.diagnose_alarm(run)
    assert cause is not None
    assert cause.name == "number compared with the count"
    fixed = follow_step(run, cause.hint)
    assert "if self.number_before is not None and number > self.number_before + 1:" in fixed
    assert fixed.endswith("self.number_before = number\n")
    assert "self.number_before = None\n        self.create_subscription(" in fixed


@pytest.mark.parametrize(
    ("pairs", "text", "step"),
    [
        (
            [("        self.last_number = number", "        else:\n            self.last_number = number")],
            "line 14: self.last_number = number is not done for each message",
            "write below line 14, with the indentation of line 11: self.last_number = number",
        ),
        (
            [("missing')\n", "missing')\n            return\n")],
            "line 13: return leaves listen before line 14",
            "write above line 13, with the same indentation: self.last_number = number",
        ),
        (  # messages without a number may be left out
            [
                (
                    "        number = int(msg.data.split(':')[1])",
                    "        try:\n            number = int(msg.data.split(':')[1])\n        except ValueError:\n"
                    "            return",
                ),
                ("missing')\n", "missing')\n            return\n"),
            ],
            "line 16: return leaves listen before line 17",
            "write above line 16, with the same indentation: self.last_number = number",
        ),
        (
            [("        self.last_number = number\n", "")],
            "self.last_number is never set",
            "write below line 12, with the indentation of line 11: self.last_number = number",
        ),
        (
            [
                (COMPARES, "self.last_number is not None and number > self.last_number"),
                ("self.last_number = number", "self.last_number += 1"),
            ],
            "line 13: self.last_number += 1 keeps counting",
            "line 13 becomes: self.last_number = number + 1",
        ),
        (
            [("self.last_number = number", "self.last_number += 1")],
            "line 13: self.last_number += 1 keeps counting",
            "line 13 becomes: self.last_number = number",
        ),
        (
            [("        self.last_number = number", "        else:\n            self.last_number += 1")],
            "line 14: self.last_number += 1 keeps counting",
            "write below line 14, with the indentation of line 11: self.last_number = number",
        ),
    ],
)
def test_a_last_number_that_is_not_updated(pairs: list[tuple[str, str]], text: str, step: str) -> None:
    cause = gap_steps.diagnose_alarm(started(*pairs))
    assert cause is not None
    assert cause.name == "false alarm"
    assert text in cause.text
    assert cause.hint == step


def test_a_last_number_overwritten_before_the_comparison() -> None:
    early = "        number = int(msg.data.split(':')[1])\n"
    run = started(("        self.last_number = number\n", ""), (early, f"{early}        self.last_number = number\n"))
    cause = gap_steps.diagnose_no_messages(run)
    assert cause is not None
    assert "line 11: self.last_number = number comes before line 12" in cause.text
    assert COMPARES.replace("last_number", "number_before") in follow_step(run, cause.hint)


def test_a_comparison_that_only_detects_lower_numbers() -> None:
    run = started(("number > self.last_number + 1", "number < self.last_number"))
    cause = gap_steps.diagnose_no_messages(run)
    assert cause is not None
    assert "line 11: number < self.last_number only detects lower numbers" in cause.text
    assert COMPARES.replace("last_number", "number_before") in follow_step(run, cause.hint)


def test_a_false_alarm_is_removed() -> None:
    run = started((COMPARES, "number % 4 == 0"))
    fixed = follow_step(run, steps.compare_numbers(run, ["3 messages are missing"]) or "")
    assert "if number % 4 == 0:\n            pass\n" in fixed
    assert fixed.count("warning(") == 1


def test_the_line_that_forgets_the_first_message_is_named() -> None:
    class ForgetsTheFirst(FakeStats):
        def summary(self) -> Iterator[Log]:
            yield from super().summary()
            self.first = ""

    source = NODE + "        self.first = None\n"
    seen = steady(ForgetsTheFirst())
    for text, step in ((source, "remove line 14: self.first = None"), ("", "only while it is None, and never again")):
        run = replace(seen, trace=replace(seen.trace, sources={"node.py": text}))
        assert_failed(judge_slow_summary(run, jump(FakeStats())), "first message overwritten", step)


SUMS_UP = (
    NODE.replace("        self.last_number = number\n", "")
    + """\
        now = time.time()
        if self.start is None:
            self.start = now
        if self.total_count % 10 == 0:
            rate = 60 * self.total_count / (now - self.start)
            self.get_logger().info(f'{self.total_count} messages, {rate:.2f} msg/s')
"""
)


@pytest.mark.parametrize(
    ("pairs", "lines"),
    [
        ([], ["            rate = (self.total_count - 1) / (time.time() - self.start)"]),
        (
            [
                ("        if self.start is None:\n            self.start = now\n", ""),
                ("now - self.start", "now - BEGAN"),
            ],
            [
                "        self.start_time = None",
                "        if self.start_time is None:",
                "            rate = (self.total_count - 1) / (time.monotonic() - self.start_time)",
            ],
        ),
        (
            [("{rate:.2f} msg/s'", "' + '%.2f msg/s' % rate")],
            ["            rate = (self.total_count - 1) / (time.time() - self.start)"],
        ),
    ],
)
def test_the_rate_is_computed_where_the_summary_reads_it(pairs: list[tuple[str, str]], lines: list[str]) -> None:
    run = started(*pairs, code=SUMS_UP)
    fixed = follow_step(run, steps.measure_rate(run, ["10 messages, 296.00 msg/s"], ["296.00"]) or "").splitlines()
    assert [line for line in lines if line not in fixed] == []
    assert "        self.total_count += 1" in fixed


def test_a_matched_event_looks_at_the_publishers_of_now() -> None:
    event = "\n    def matched(self, info):\n        if info.total_count == 1:\n            self.go_on()\n"
    assert steps.go_on_after_restart(started(code=NODE + event)) == "line 16 becomes: if info.current_count > 0:"
    assert "total_count == 1" not in str(steps.go_on_after_restart(started()))


def test_a_variable_of_another_class_is_not_the_listeners() -> None:
    other = f"class Link:\n    def __init__(self):\n        self.total_count = 0\n\n\n{NODE}"
    run = started(("self.listen, 10)\n        self.total_count = 0\n", "self.listen, 10)\n"), code=other)
    rewritten = follow_step(run, str(steps.count_messages(run)))
    assert rewritten.count("        self.total_count = 0\n") == 2


def test_an_object_that_is_none_at_first_holds_no_count() -> None:
    pairs = [("self.total_count = 0", "self.stats = None"), ("self.total_count += 1", "self.stats.total += 1")]
    rewritten = follow_step(run := started(*pairs), str(steps.count_messages(run)))
    assert "self.total_count += 1" in rewritten
    assert "self.stats.total" not in rewritten


def test_a_restart_is_announced_where_the_statistics_are_reset() -> None:
    run = started(code=NODE + "        if number < self.last_number:\n            self.total_count = 0\n")
    fixed = follow_step(run, steps.announce_restart(run) or "")
    assert "if number < self.last_number:\n            self.get_logger().warning('the publisher was restarted" in fixed


ALARM = "            self.get_logger"


@pytest.mark.parametrize(
    ("name", "pair", "step"),
    [
        ("exit at once", (ALARM, f"            raise SystemExit(0)\n{ALARM}"), "remove line 12: raise SystemExit(0)"),
        ("exit at once", (ALARM, f"            os._exit(0)\n{ALARM}"), "remove line 12: os._exit(0)"),
        (
            "no subscription",
            ("self.total_count += 1", "self.destroy_subscription(self.sub)"),
            "remove line 9",
        ),
        (
            "no subscription",
            ("self.create_subscription(String, 'chatter', self.listen, 10)", "pass"),
            "self.listen, 10)",
        ),
        ("no subscription", ("msg.data", "msg"), "as it was"),
    ],
)
def test_steps_for_a_node_that_exits_or_is_not_subscribed(name: str, pair: tuple[str, str], step: str) -> None:
    assert step in steps.keep_node_up(started(pair), Cause(name, "why", "as it was")).hint
