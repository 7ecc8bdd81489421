"""Slips that raise nothing: how the learner's source reveals them, and the step."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.checks.builders import trace
from tutor.judge.causes import late_binding, parameter_callback_slips, parameter_slips, period_slips, slips
from tutor.judge.causes.printing import use_node_logger
from tutor.judge.causes.uncalled import diagnose_awaited_service, diagnose_uncalled_setup
from tutor.judge.causes.unserved import diagnose_unserved, diagnose_unserved_node
from tutor.judge.rewriting.node import find_in_files, node_file
from tutor.judge.trace import Level, Trace
from tutor.ros_model import Graph, ServiceEndpoint


def node(text: str) -> Trace:
    return replace(trace(), sources={"node.py": text})


def trace_of(text: str) -> Trace:
    return replace(trace(), sources={"node.py": text})


@pytest.mark.parametrize(
    ("text", "step"),
    [
        ("self.on = str(p.value) == 'true'", "line 1 becomes: self.on = p.value"),
        ("\nif p.value == 'True':\n  pass", "line 2 becomes: if p.value:"),
        ("self.on = p.value != 'false'", "becomes: self.on = p.value"),
        ("self.on = 'false' == p.value", "becomes: self.on = not p.value"),
    ],
)
def test_a_boolean_compared_with_text(text: str, step: str) -> None:
    assert step in (slips.fix_bool_compared_with_text(node(text)) or "")


@pytest.mark.parametrize(
    "text", ["x = str(p.value).lower() == 'true'", "if p.name == 'true': pass", "x = p.value == 'a'"]
)
def test_valid_comparisons_are_not_reported(text: str) -> None:
    assert slips.fix_bool_compared_with_text(node(text)) is None


@pytest.mark.parametrize(
    ("text", "step"),
    [
        ("t = 10^9", "line 1 becomes: t = 10**9"),
        ("t = ns // 10 ^ 9 >= limit", "line 1 becomes: t = ns // 10**9 >= limit"),
        ("x = a ^ b\nt = 3 * 10^6", "line 2 becomes: t = 3 * 10**6"),
        ("n = 2^8 - 1", "line 1 becomes: n = 2**8 - 1"),
    ],
)
def test_a_power_written_as_xor(text: str, step: str) -> None:
    found = slips.diagnose_xor(node_file(text))
    assert found is not None
    assert found.hint == step


@pytest.mark.parametrize("text", ["x = a ^ 1", "x = a ^ b", "x ^= 10", "t = 10**9", "x = 7 ^ 3"])
def test_another_xor_is_no_slip(text: str) -> None:
    assert slips.diagnose_xor(node_file(text)) is None


@pytest.mark.parametrize(
    "text",
    [
        "p = Parameter('use_sim_time', Parameter.Type.BOOL, True)",
        "p = {'a': True, 'use_sim_time': True}",
        "p = {'name': 'use_sim_time', 'value': True}",
        "n.declare_parameter('use_sim_time', value=True)",
    ],
)
def test_simulated_time_is_switched_off(text: str) -> None:
    found = slips.diagnose_simulated_time(node_file(text))
    assert found is not None
    head, _, tail = text.rpartition("True")
    assert found.hint == f"line 1 becomes: {head}False{tail}"


@pytest.mark.parametrize("text", ["p = Parameter('use_sim_time', value=False)", "n.get_parameter('use_sim_time')"])
def test_real_time_is_not_reported(text: str) -> None:
    assert slips.diagnose_simulated_time(node_file(text)) is None


@pytest.mark.parametrize(
    ("text", "step"),
    [
        ("os.environ['ROS_DOMAIN_ID'] = '42'\n", "remove line 1: os.environ['ROS_DOMAIN_ID'] = '42'"),
        ("rclpy.init(args=args, domain_id=42)", "line 1 becomes: rclpy.init(args=args)"),
    ],
)
def test_a_domain_of_its_own_is_named(text: str, step: str) -> None:
    found = slips.diagnose_other_domain(node_file(text))
    assert found is not None
    assert found.hint == step


@pytest.mark.parametrize("text", ["print(os.environ['ROS_DOMAIN_ID'])", "rclpy.init(args=args)"])
def test_the_domain_of_the_environment_is_not_reported(text: str) -> None:
    assert slips.diagnose_other_domain(node_file(text)) is None


def test_simulated_time_may_be_switched_on_by_a_constant() -> None:
    found = slips.diagnose_simulated_time(node_file("SIM = True\nn.set('use_sim_time', SIM)"))
    assert found is not None
    assert found.hint == "line 2 becomes: n.set('use_sim_time', False)"


@pytest.mark.parametrize(
    ("call", "lowest", "hides"),
    [
        ("self.get_logger().set_level(LoggingSeverity.WARN)", Level.FATAL, True),
        ("rclpy.logging.set_logger_level('n', rclpy.logging.LoggingSeverity.ERROR)", Level.ERROR, True),
        ("self.get_logger().set_level(LoggingSeverity.WARN)", Level.INFO, False),
        ("self.get_logger().set_level(LoggingSeverity.DEBUG)", Level.FATAL, False),
    ],
)
def test_a_raised_log_level_is_named_unless_lower_messages_came(call: str, lowest: Level, hides: bool) -> None:
    found = slips.diagnose_raised_level(node_file(f"x = 1\n{call}\n"), lowest)
    assert (found.hint if found else None) == (f"remove line 2: {call}" if hides else None)


CLASS = "class N(Node):\n  def __init__(self):\n    super().__init__('n')\n"


@pytest.mark.parametrize("name", ["_services", "_timers", "_subscriptions"])
def test_an_overwritten_list_of_the_node_gets_another_name(name: str) -> None:
    text = f"{CLASS}    self.{name}: dict = {{}}\n    self.{name}['a'] = 1\n"
    found = diagnose_unserved_node(node_file(text))
    assert found is not None
    new = name.replace("_", "my_", 1)
    assert set(found.hint.splitlines()) == {
        f"line 4 becomes: self.{new}: dict = {{}}",
        f"line 5 becomes: self.{new}['a'] = 1",
    }


@pytest.mark.parametrize(
    "text",
    [f"{CLASS}    self.services_ = []", "class A:\n  def f(self):\n    self._timers = 1", f"{CLASS}    timers = []"],
)
def test_other_attributes_and_classes_are_not_reported(text: str) -> None:
    assert diagnose_unserved_node(node_file(text)) is None


MAIN = "def main():\n  helper = rclpy.create_node('h')\n  own = N()\n  rclpy.spin({})\n"


def test_another_node_spun_is_named() -> None:
    found = diagnose_unserved_node(node_file(CLASS + MAIN.format("helper")))
    assert found is not None
    assert found.hint == "line 7 becomes: rclpy.spin(own)"
    assert diagnose_unserved_node(node_file(CLASS + MAIN.format("own"))) is None


FOR_EACH = "def main():\n  for node in nodes:\n    ex = SingleThreadedExecutor()\n    ex.add_node(node)\n  ex.spin()\n"


def test_an_executor_for_each_node_becomes_one_for_all() -> None:
    found = diagnose_unserved_node(node_file(FOR_EACH))
    assert found is not None
    assert "line 5 spins only the last" in found.text
    assert set(found.hint.splitlines()) == {
        "write above line 2, with the same indentation: ex = SingleThreadedExecutor()",
        "remove line 3: ex = SingleThreadedExecutor()",
    }


@pytest.mark.parametrize(("old", "new"), [("  ex.spin", "    ex.spin"), ("ex.spin", "other.spin"), ("ex.add", "a.add")])
def test_executors_that_are_spun_each_or_have_no_node_of_the_loop_are_not_reported(old: str, new: str) -> None:
    found = diagnose_unserved_node(node_file(FOR_EACH.replace(old, new)))
    assert found is None or found.name == "second spin"


OUTER = """\
class Robot(Node):
    def __init__(self):
        super().__init__('robot')
        self.arm = Arm()


def main():
    robot = Robot()
    rclpy.spin(robot)
"""
ARM = "class Arm(Node):\n    def __init__(self):\n        self.create_timer(1.0, self.move)\n"


@pytest.mark.parametrize(
    ("spin", "step"),
    [
        ("rclpy.spin(robot)", "in node.py, line 9 becomes:\n    executor = MultiThreadedExecutor()"),
        ("executor.add_node(robot)", "in node.py, write below line 9, with the same indentation: executor.add_node("),
        ("executor.add_node(robot)\n    executor.add_node(robot.arm)", None),
    ],
)
def test_a_node_inside_of_another_one_is_spun_as_well(spin: str, step: str | None) -> None:
    sources = {"node.py": OUTER.replace("rclpy.spin(robot)", spin), "arm.py": ARM}
    found = diagnose_unserved(replace(trace(), sources=sources))
    if step is None:
        assert found is None
    else:
        assert found is not None
        assert found.name == "another node spun"
        assert found.hint.startswith(step)
        assert "executor.add_node(robot.arm)" in found.hint


PAIR = "class {}(Node):\n  def __init__(self):\n    super().__init__('n')\n    self.create_timer(1.0, self.go)\n".format


@pytest.mark.parametrize(
    ("last", "named"),
    [
        ("  rclpy.spin(two)\n", "not those of one"),
        ("  rclpy.spin(one)\n", "not those of two"),
        ("  executor.add_node(one)\n  rclpy.spin(two)\n", None),
        ("  rclpy.spin(one)\n  rclpy.spin(two)\n", "is never reached"),
    ],
)
def test_one_of_two_nodes_is_never_spun(last: str, named: str | None) -> None:
    text = f"import rclpy\n{PAIR('A')}{PAIR('B')}def main():\n  one = A()\n  two = B()\n{last}"
    found = diagnose_unserved_node(node_file(text))
    assert (found is None) == (named is None)
    if found is not None:
        assert str(named) in found.text
        assert "executor.add_node(one)" in found.hint
        assert "executor.add_node(two)" in found.hint
    helper = text.replace("    self.create_timer(1.0, self.go)\n", "", 1)  # the first node has nothing to serve
    assert diagnose_unserved_node(node_file(helper)) is None or last.count("spin") == 2


@pytest.mark.parametrize(
    ("text", "step"),
    [
        ("rclpy.init(args=[])", "line 1 becomes: rclpy.init(args=None)"),
        ("def main(args=[]):\n  rclpy.init(args=args)", "line 1 becomes: def main(args=None):"),
        (
            "n = Node('n', use_global_arguments=False)",
            "line 1 becomes: n = Node('n', use_global_arguments=True)",
        ),
        ("rclpy.init(args=args)", None),
        ("def main(args=None):\n  rclpy.init(args=args)", None),
        ("def main(n, args=['a'], *, x=[]):\n  rclpy.init(args=args)", None),
        ("rclpy.init()", None),
    ],
)
def test_arguments_that_do_not_reach_the_node_are_named(text: str, step: str | None) -> None:
    found = parameter_slips.diagnose_dropped_arguments(node_file(text))
    assert (found.hint if found else None) == step


REFUSES_AFTERWARDS = """\
class Talker(Node):
    def __init__(self):
        super().__init__('talker')
        self.add_post_set_parameters_callback(self.check)

    def check(self, params):
        for p in params:
            if p.name == 'publish_rate' and p.value <= 0:
                return SetParametersResult(successful=False, reason='no')
        return SetParametersResult(successful=True)
"""


def test_a_post_set_callback_cannot_refuse() -> None:
    found = parameter_callback_slips.diagnose_broken_callback(trace_of(REFUSES_AFTERWARDS))
    assert found is not None
    assert found.hint == "line 4 becomes: self.add_on_set_parameters_callback(self.check)"
    right = REFUSES_AFTERWARDS.replace("post_set", "on_set")
    assert parameter_callback_slips.diagnose_broken_callback(trace_of(right)) is None


def test_a_type_is_not_compared_with_a_number() -> None:
    text = "def f(p):\n  if p.type_ == ParameterType.PARAMETER_BOOL:\n    pass\nn.add_on_set_parameters_callback(f)"
    found = parameter_callback_slips.diagnose_broken_callback(trace_of(text))
    assert found is not None
    assert found.hint == "line 2 becomes: if p.type_.value == ParameterType.PARAMETER_BOOL:"
    right = text.replace("ParameterType.PARAMETER_BOOL", "Parameter.Type.BOOL")
    assert parameter_callback_slips.diagnose_broken_callback(trace_of(right)) is None


@pytest.mark.parametrize(
    ("text", "step"),
    [
        ("self.n = self.get_parameter('name')", "line 1 becomes: self.n = self.get_parameter('name').value"),
        ("self.n = self.get_parameter('name').value", None),
        ("self.n = self.get_parameter('other')", None),
        ("self.n = self.get_parameter('name')\nx = self.n.value", None),
    ],
)
def test_a_parameter_object_is_not_its_value(text: str, step: str | None) -> None:
    found = parameter_slips.diagnose_parameter_object(node_file(text), "name")
    assert (found.hint if found else None) == step


@pytest.mark.parametrize(
    ("text", "step"),
    [
        ("self.create_timer(500, self.tick)", "line 1 becomes: self.create_timer(0.5, self.tick)"),
        ("PERIOD = 100\nself.create_timer(PERIOD, self.tick)", "line 1 becomes: PERIOD = 0.1"),
        ("self.create_timer(5, self.tick)", None),
    ],
)
def test_a_period_in_milliseconds(text: str, step: str | None) -> None:
    found = period_slips.diagnose_milliseconds(node_file(text))
    assert (found.hint if found else None) == step


TIMERS = (
    CLASS
    + """\
    self.t = self.create_timer(0.5, self.tick)
    self.set_rate(2)
  def set_rate(self, rate):
    self.u = self.create_timer(1 / rate, self.tick)
"""
)


@pytest.mark.parametrize("period", ["0.5", "1.0 / HZ"])
def test_a_second_timer_with_a_fixed_period_is_removed(period: str) -> None:
    found = period_slips.diagnose_second_timer(node_file(TIMERS.replace("0.5", period) + "HZ = 2.0\n"))
    assert found is not None
    assert found.hint == f"remove line 4: self.t = self.create_timer({period}, self.tick)"


@pytest.mark.parametrize(("old", "new"), [("rate, self.tick", "rate, self.tock"), ("    self.set_rate(2)\n", "")])
def test_a_timer_for_another_purpose_or_made_later_is_no_second_one(old: str, new: str) -> None:
    assert period_slips.diagnose_second_timer(node_file(TIMERS.replace(old, new))) is None


@pytest.mark.parametrize(
    ("loop", "step"),
    [
        (
            "    for room in ROOMS:\n      self.create_timer(1 / rate, self.tick)\n",
            "write below line 5, with the same indentation: break",
        ),
        ("    for room in ROOMS:\n      self.add(room)\n    self.create_timer(1 / rate, self.tick)\n", None),
    ],
)
def test_a_loop_that_makes_timers_is_left_after_the_first_one(loop: str, step: str | None) -> None:
    found = period_slips.diagnose_timer_loop(node_file(CLASS + loop))
    assert (found.hint if found else None) == step


@pytest.mark.parametrize(
    ("spins", "step"),
    [
        (
            "rclpy.spin(a)\nrclpy.spin(b)\n",
            "remove line 4: rclpy.spin(b)\nline 3 becomes:\n    executor = MultiThreadedExecutor()\n"
            "    executor.add_node(a)\n    executor.add_node(b)\n    executor.spin()\n"
            "at the top of the file: from rclpy.executors import MultiThreadedExecutor",
        ),
        (
            "x.add_node(a)\ny.add_node(b)\nx.spin()\ny.spin()\n",
            "remove line 6: y.spin()\nline 4 becomes: x.add_node(b)",
        ),
        (
            "for n in (x, y):\n  n.greet()\n  rclpy.spin(n)\n",
            "lines 3 to 5 become:\n    executor = MultiThreadedExecutor()\n    for n in (x, y):\n        n.greet()\n"
            "        executor.add_node(n)\n    executor.spin()\n"
            "at the top of the file: from rclpy.executors import MultiThreadedExecutor",
        ),
        (
            "for n in (x, y):\n  e = SingleThreadedExecutor()\n  e.add_node(n)\n  e.spin()\n",
            "lines 3 to 6 become:\n    executor = MultiThreadedExecutor()\n    for n in (x, y):\n"
            "        executor.add_node(n)\n    executor.spin()\n"
            "at the top of the file: from rclpy.executors import MultiThreadedExecutor",
        ),
        ("for n in (x, y):\n  n.spin()\n", None),
        ("if second:\n  rclpy.spin(b)\nelse:\n  rclpy.spin(a)\n", None),
        ("rclpy.spin(a)\n", None),
    ],
)
def test_a_spin_after_another_one_is_never_reached(spins: str, step: str | None) -> None:
    found = diagnose_unserved_node(node_file(f"import rclpy\nx, y = A(), B()\n{spins}"))
    assert (found.hint if found else None) == step


@pytest.mark.parametrize(
    ("spin", "step"),
    [
        ("rclpy.spin_once(n, timeout_sec=0.3)", "line 4 becomes: e.spin_once(timeout_sec=0.3)"),
        ("rclpy.spin_until_future_complete(n, f)", "line 4 becomes: e.spin_until_future_complete(f)"),
        ("rclpy.spin_once(other)", None),
        ("e.spin_once()", None),
    ],
)
def test_a_node_is_taken_out_of_its_executor(spin: str, step: str | None) -> None:
    found = diagnose_unserved_node(
        node_file(f"e = SingleThreadedExecutor()\nn = A()\ne.add_node(n)\n{spin}\ne.spin()\n")
    )
    assert (found.hint if found else None) == step


@pytest.mark.parametrize(
    ("text", "refuses"),
    [
        ("if len(sys.argv) > 1:\n  print('usage:', sys.argv[0])\n  sys.exit(1)\n", True),
        ("def main():\n  if len(sys.argv) != 1:\n    return\n  run()\n", True),
        ("if len(sys.argv) < 2:\n  sys.exit(1)\nrate = float(sys.argv[1])\n", False),
        ("if len(sys.argv) > 1:\n  print('no')\n", False),
    ],
)
def test_a_program_that_refuses_arguments(text: str, refuses: bool) -> None:
    found = slips.diagnose_argument_guard(node_file(text))
    assert (found is not None and found.hint.startswith("remove line")) == refuses


LOGGER = "{}class N(Node):\n  def f(self):\n    {}\n    {}.info('x')\n"


@pytest.mark.parametrize(
    ("text", "step"),
    [
        (
            LOGGER.format("", "self.log = rclpy.logging.get_logger('a')", "self.log"),
            "line 3 becomes: self.log = self.get_logger()",
        ),
        (
            LOGGER.format("log = get_logger('a')\n", "x = 1", "log"),
            "line 5 becomes: self.get_logger().info('x')",
        ),
        (LOGGER.format("", "x = 1", "self.get_logger()"), None),
    ],
)
def test_a_logger_of_no_node_is_replaced(text: str, step: str | None) -> None:
    assert use_node_logger(node_file(text)) == step


def test_a_callback_made_in_a_loop_sees_the_values_of_the_last_iteration() -> None:
    text = "for n, op in OPS:\n  self.create_service(T, n, lambda q, r: self.do(op, q, r))"
    found = late_binding.diagnose_late_binding(node(text))
    assert found is not None
    assert "lambda q, r, op=op: self.do(op, q, r)" in found.hint
    assert late_binding.diagnose_late_binding(node(text.replace("q, r:", "q, r, op=op:"))) is None


@pytest.mark.parametrize(("number", "wrong"), [("100000000", True), ("1e9", False), ("1000000000", False)])
def test_a_period_in_nanoseconds(number: str, wrong: bool) -> None:
    found = period_slips.diagnose_nanoseconds(node_file(f"self.t.timer_period_ns = {number} // rate"))
    assert (found.hint if found else None) == (
        "line 1 becomes: self.t.timer_period_ns = 1_000_000_000 // rate" if wrong else None
    )


def test_of_two_equal_timers_the_first_one_goes() -> None:
    twins = "self.t = self.create_timer(0.1, self.tick)\nself.t = self.create_timer(0.1, self.tick, callback_group=g)"
    found = period_slips.diagnose_twin_timers(node_file(twins))
    assert found is not None
    assert found.hint == "remove line 1: self.t = self.create_timer(0.1, self.tick)"
    assert period_slips.diagnose_twin_timers(node_file(twins.replace("tick, c", "tock, c"))) is None


def test_an_overridden_method_that_does_nothing_is_no_callback() -> None:
    text = (
        "class A:\n  def f(self):\n    return 1\nclass B:\n  def f(self):\n    raise NotImplementedError\nx = y(self.f)"
    )
    file = node_file(text)
    found = file.function(file.calls("y")[0].args[0])
    assert found is not None
    assert found.lineno == 2


NEVER_NONE = """from rclpy.node import Node

class Stats(Node):
    def __init__(self):
        super().__init__('stats')
        self.start = {}
        self.last = None

    def callback(self, message):
        if self.start is None:
            self.start = self.get_clock().now()
        if self.last is None:
            self.last = 1
"""


def test_an_attribute_that_is_never_none() -> None:
    found = slips.diagnose_never_none(node_file(NEVER_NONE.format("0.0")))
    assert found is not None
    assert "begins as 0.0" in found.text
    assert found.hint == "line 6 becomes: self.start = None"
    assert slips.diagnose_never_none(node_file(NEVER_NONE.format("None"))) is None
    assert slips.diagnose_never_none(node_file(NEVER_NONE.format("self.stored()"))) is None


@pytest.mark.parametrize("given", ["remove_ros_args(sys.argv)", "sys.argv[2:]", "sys.argv[:1]"])
def test_ros_arguments_that_were_taken_out(given: str) -> None:
    source = (
        "import rclpy\nimport sys\nfrom rclpy.utilities import remove_ros_args\n"
        "def main():\n    argv = {}\n    rclpy.init(args=argv)\n    rclpy.spin(rclpy.create_node('n'))\n"
    )
    found = parameter_slips.diagnose_dropped_arguments(node_file(source.format(given)))
    assert found is not None
    assert found.hint == "line 6 becomes: rclpy.init()"
    for whole in ("sys.argv", "sys.argv[1:]"):
        assert parameter_slips.diagnose_dropped_arguments(node_file(source.format(whole))) is None


@pytest.mark.parametrize("text", ["main", "__init__", "__name__"])
def test_a_main_guard_that_is_never_true(text: str) -> None:
    source = f"def main():\n    pass\n\nif __name__ == '{text}':\n    main()\n"
    found = slips.diagnose_main_guard(node_file(source))
    assert found is not None
    assert found.hint == "line 4 becomes: if __name__ == '__main__':"
    assert slips.diagnose_main_guard(node_file(source.replace(f"'{text}'", "'__main__'"))) is None


def test_two_names_for_one_object() -> None:
    source = "class Stats:\n    def __init__(self):\n        self.first = self.last = {'text': ''}\n"
    found = slips.diagnose_shared_object(node_file(source))
    assert found is not None
    assert found.hint == "line 3 becomes:\n    self.first = {'text': ''}\n    self.last = {'text': ''}"
    assert slips.diagnose_shared_object(node_file(source.replace("{'text': ''}", "None"))) is None


@pytest.mark.parametrize(
    "line",
    [
        "descriptor = ParameterDescriptor(read_only={})",
        "descriptor.read_only = {}",
        "def declare(name, default, read_only={}): pass",
    ],
)
def test_a_read_only_parameter(line: str) -> None:
    found = parameter_slips.diagnose_read_only(node_file(line.format("True")))
    assert found is not None
    assert found.hint == f"line 1 becomes: {line.format('False')}"
    assert parameter_slips.diagnose_read_only(node_file(line.format("False"))) is None


JOINED = """def report(log, total):
    rate = total / 2.0
    log(f"total {total}, "
        "rate {rate:.2f}")
    log("first {}".format(total))
"""


def test_a_string_without_its_f() -> None:
    found = slips.diagnose_missing_f(node_file(JOINED), ["total 10, rate {rate:.2f}"])
    assert found is not None
    assert found.hint == 'line 4 becomes: f"rate {rate:.2f}")'
    assert slips.diagnose_missing_f(node_file(JOINED), ["total 10, rate 5.00"]) is None


CLASS_ATTRIBUTE = """from rclpy.node import Node

class Talker(Node):
    prefix = 'Hello'
    def __init__(self):
        super().__init__('talker')
        self.prefix = self.get_parameter('message_prefix').value
        self.add_on_set_parameters_callback(self.changed)

    def changed(self, params):
        for p in params:
            Talker.prefix = p.value
"""


def test_a_class_attribute_that_the_nodes_own_one_hides() -> None:
    found = parameter_callback_slips.diagnose_broken_callback(trace_of(CLASS_ATTRIBUTE))
    assert found is not None
    assert found.hint == "line 12 becomes: self.prefix = p.value"
    used = CLASS_ATTRIBUTE.replace("        self.prefix = self.get", "        Talker.prefix = self.get")
    assert parameter_callback_slips.diagnose_broken_callback(trace_of(used)) is None


SETS_UNDECLARED = """from rclpy.node import Node
from rclpy.parameter import Parameter

class Talker(Node):
    def __init__(self):
        super().__init__('talker', allow_undeclared_parameters=True)
        rate = Parameter('publish_rate', Parameter.Type.DOUBLE, 1.0)
        self.set_parameters([rate])
"""


def test_parameters_that_are_set_instead_of_declared() -> None:
    found = parameter_slips.diagnose_override(node_file(SETS_UNDECLARED), "publish_rate")
    assert found is not None
    assert found.hint == "line 8 becomes: self.declare_parameter('publish_rate', 1.0)"


def test_arguments_that_the_node_gives_itself() -> None:
    source = (
        "class Talker(Node):\n    def __init__(self):\n"
        "        super().__init__('talker', cli_args=['--ros-args', '-p', 'publish_rate:=1.0'])\n"
    )
    found = parameter_slips.diagnose_override(node_file(source), "publish_rate")
    assert found is not None
    assert found.hint == "line 3 becomes: super().__init__('talker')"
    assert parameter_slips.diagnose_override(node_file(source), "enabled") is None


@pytest.mark.parametrize(
    ("options", "starts", "step"),
    [
        (", autostart=False", "", "line 3 becomes: self.timer = self.create_timer(0.1, self.tick, autostart=True)"),
        (", autostart=False", "self.timer.reset()", None),
        (", autostart=True", "", None),
        ("", "", None),
    ],
)
def test_a_timer_that_nothing_starts(options: str, starts: str, step: str | None) -> None:
    file = node_file(
        "class A(Node):\n    def __init__(self):\n"
        f"        self.timer = self.create_timer(0.1, self.tick{options})\n        {starts}\n"
    )
    found = period_slips.diagnose_no_autostart(file)
    assert (found.hint if found else None) == step


@pytest.mark.parametrize(
    ("assigned", "step"),
    [
        ("self.timer.period = 1.0 / hz", "line 4 becomes: self.timer.timer_period_ns = int(1e9 * (1.0 / hz))"),
        ("self.timer.timer_period_sec = 0.5", "line 4 becomes: self.timer.timer_period_ns = int(1e9 * 0.5)"),
        ("self.timer.timer_period_ns = 5", None),
        ("self.period = 1.0 / hz", None),
    ],
)
def test_a_period_assigned_to_an_attribute_that_timers_do_not_have(assigned: str, step: str | None) -> None:
    file = node_file(
        "class A(Node):\n    def __init__(self):\n"
        f"        self.timer = self.create_timer(1.0, self.tick)\n        {assigned}\n"
    )
    found = period_slips.diagnose_period_attribute(file)
    assert (found.hint if found else None) == step


@pytest.mark.parametrize(
    ("call", "step"),
    [
        ("setattr(self, 'config.' + p.name, p.value)", "line 3 becomes: setattr(self.config, p.name, p.value)"),
        ("setattr(self, f'config.{p.name}', p.value)", "line 3 becomes: setattr(self.config, p.name, p.value)"),
        ("setattr(self, 'config.rate', p.value)", "line 3 becomes: setattr(self.config, 'rate', p.value)"),
        ("setattr(self, 'my_' + p.name, p.value)", None),
        ("setattr(self, p.name, p.value)", None),
    ],
)
def test_setattr_does_not_follow_dots(call: str, step: str | None) -> None:
    text = f"class A:\n    def f(self, p):\n        {call}\n\n    def __init__(self):\n        self.config = Config()\n"
    found = parameter_callback_slips.diagnose_broken_callback(trace_of(text))
    assert (found.hint if found else None) == step


@pytest.mark.parametrize(
    ("body", "step"),
    [
        ("if self.n > 20:\n            self.timer.cancel()", "remove lines 6 to 7"),
        ("self.destroy_timer(self.timer)", "remove line 6: self.destroy_timer(self.timer)"),
        ("self.other.cancel()", None),
        ("self.n += 1", None),
    ],
)
def test_a_timer_that_its_own_callback_ends(body: str, step: str | None) -> None:
    file = node_file(
        "class A(Node):\n    def __init__(self):\n        self.timer = self.create_timer(0.1, self.tick)\n\n"
        f"    def tick(self):\n        {body}\n        self.log()\n"
    )
    found = period_slips.diagnose_self_cancelling(file)
    assert (found.hint if found else None) == step
    assert period_slips.diagnose_self_cancelling(file, file.calls("log")[0]) is None


UNCALLED = (
    "import rclpy\n"
    + CLASS
    + """\
    self.count = 0
  def init(self):
    self.create_service(AddTwoInts, 'add', self.add)
"""
)


@pytest.mark.parametrize(
    ("text", "step"),
    [
        (UNCALLED, "write below line 5, with the same indentation: self.init()"),
        (UNCALLED + "rclpy.init()\n", "write below line 5, with the same indentation: self.init()"),
        (UNCALLED + "node = N()\nnode.init()\n", None),
        (UNCALLED + "getattr(N(), 'init')()\n", None),
        (UNCALLED.replace("init(self)", "init(self, name)"), None),
        (
            "class N(Node):\n  def open(self):\n    self.create_service(A, 'add', f)\nn = N()\nrclpy.spin(n)\n",
            "write below line 4, with the same indentation: n.open()",
        ),
        (
            "def open(node):\n  node.create_service(A, 'add', f)\ndef main():\n  n = N()\n  rclpy.spin(n)\n",
            "write above line 5, with the same indentation: open(n)",
        ),
    ],
)
def test_a_function_that_makes_the_services_must_be_called(text: str, step: str | None) -> None:
    found = diagnose_uncalled_setup(node_file(text), "create_service")
    assert (found.hint if found else None) == step


TICK = """\
import time
class N(Node):
  def __init__(self):
    self.create_timer(0.1, self.tick)
  def tick(self):
    {}
    self.pub.publish(String())
"""


@pytest.mark.parametrize(
    ("code", "step"),
    [
        ("if time.monotonic() - self.last < self.period:\n      return", "remove lines 6 to 7"),
        ("if self.count < 5:\n      return", None),
        ("if time.monotonic() - self.last < self.period:\n      self.hurry()", None),
    ],
)
def test_a_guard_that_drops_early_ticks_is_removed(code: str, step: str | None) -> None:
    found = period_slips.diagnose_throttle(node_file(TICK.format(code)))
    assert (found.hint if found else None) == step


@pytest.mark.parametrize(
    ("code", "step"),
    [
        ("time.sleep(0.5)", "remove line 6: time.sleep(0.5)"),
        ("time.sleep(0.01)", None),
        ("for _ in range(50):\n      time.sleep(0.01)", "line 7 becomes: pass"),
    ],
)
def test_a_sleep_that_is_long_or_repeated_slows_the_timer_down(code: str, step: str | None) -> None:
    found = period_slips.diagnose_sleep(node_file(TICK.format(code)), 5.0)
    assert (found.hint if found else None) == step


HELPER = """\
import time


class Sensor:
    CONVERSION_S = 0.75

    def {1}(self):
        time.sleep({0})
        return 20.0
"""


@pytest.mark.parametrize(
    ("function", "sleep", "removed"),
    [
        ("read", "self.CONVERSION_S", True),
        ("read", "0.5", True),
        ("read", "self.left()", True),
        ("read", "0.005", False),
        ("sleep", "self.left()", False),
        ("_run_loop", "0.5", False),
    ],
)
def test_a_helper_that_sleeps_slows_the_node(function: str, sleep: str, removed: bool) -> None:
    sources = {"node.py": "rclpy.spin(Talker(Sensor()))\n", "sensor.py": HELPER.format(sleep, function)}
    seen = replace(trace(), file="node.py", sources=sources)
    found = find_in_files(seen, lambda file: period_slips.diagnose_sleep_in_helper(file, 5.0))
    step = f"in sensor.py, remove line 8: time.sleep({sleep})" if removed else None
    assert (found.hint if found else None) == step


def test_a_sleep_for_the_rest_of_the_period_is_the_loops_own() -> None:
    loop = "def main():\n    while rclpy.ok():\n        publisher.publish(Float64())\n        time.sleep({})\n"
    assert period_slips.diagnose_sleep(node_file(loop.format("left")), 5.0) is None
    assert period_slips.diagnose_sleep(node_file(loop.format("0.5")), 5.0) is not None


@pytest.mark.parametrize(
    "loop", ["while not arm.wait_for_service(timeout_sec=1.0):", "while not arm.service_is_ready():"]
)
def test_a_wait_for_a_service_that_nobody_offers(loop: str) -> None:
    text = f"arm = node.create_client(Trigger, 'arm')\n{loop}\n    print('no arm yet')\n"
    arm = ServiceEndpoint("/arm", "std_srvs/srv/Trigger", "/n", "reliable")
    seen = replace(node(text), graph=Graph(("/n",), clients=(arm,)))
    found = diagnose_awaited_service(seen)
    assert found is not None
    assert found.text == "line 2 waits for /arm, which nobody offers, before it goes on"
    assert found.hint.startswith("remove lines 2 to 3")
    assert diagnose_awaited_service(replace(seen, graph=replace(seen.graph, servers=(arm,)))) is None
