"""General edits of a node, of whole functions or single lines, in the learner's own names."""

from __future__ import annotations

import pytest

from tutor.judge.causes import parameter_callback_slips, parameter_slips, period_slips
from tutor.judge.edits import Edit
from tutor.judge.rewriting import parameter_callbacks, parameters, publishing
from tutor.judge.rewriting.node import NodeFile, node_file
from tutor.judge.step_parsing import apply_step

RATE, PREFIX, ENABLED = "publish_rate", "message_prefix", "enabled"
NODE = """\
from rcl_interfaces.msg import SetParametersResult
from rclpy.node import Node
from std_msgs.msg import String


class ParameterizedPublisher(Node):
    def __init__(self):
        super().__init__('parameterized_publisher')
        self.declare_parameter('message_prefix', 'Hello')
        self.declare_parameter('publish_rate', 1.0)
        self.prefix = self.get_parameter('message_prefix').value
        self.rate = self.get_parameter('publish_rate').value
        self.count = 0
        self.publisher = self.create_publisher(String, 'chatter', 10)
        self.timer = self.create_timer(1.0 / self.rate, self.tick)
        self.add_on_set_parameters_callback(self.changed)

    def changed(self, params):
        return SetParametersResult(successful=True)

    def tick(self):
        self.publisher.publish(String(data=self.prefix))
        self.count += 1
"""
REGISTERED = "        self.add_on_set_parameters_callback(self.changed)\n"
MODULE = """\
import rclpy
from std_msgs.msg import String

rclpy.init()
node = rclpy.create_node('p')
node.declare_parameter('publish_rate', 1.0)
pub = node.create_publisher(String, 'chatter', 10)


def tick():
    pub.publish(String(data='Hello'))


timer = node.create_timer(1.0, tick)
rclpy.spin(node)
"""


def changed(*pairs: tuple[str, str], text: str = NODE) -> NodeFile:
    """The node with each of these texts replaced."""
    for old, new in pairs:
        assert old in text
        text = text.replace(old, new)
    return node_file(text)


def apply_edits(file: NodeFile, edits: list[Edit]) -> str:
    """The file after following the step for these edits to the letter."""
    step = file.step(edits)
    assert step is not None
    return apply_step(step, {"node.py": file.text})["node.py"]


def test_the_callback_refuses_bad_rates_and_applies_the_others() -> None:
    after = apply_edits(changed(), parameter_callbacks.follow_parameters(changed(), RATE, PREFIX, ENABLED))
    assert (
        """\
    def changed(self, params):
        for p in params:
            if p.name == 'publish_rate' and p.value <= 0.0:
                return SetParametersResult(successful=False, reason='publish_rate must be > 0')
        for p in params:
            if p.name == 'message_prefix':
                self.prefix = p.value
            elif p.name == 'publish_rate':
                self.rate = p.value
                self.timer.cancel()
                self.timer = self.create_timer(1.0 / p.value, self.tick)
        return SetParametersResult(successful=True)
"""
        in after
    )


@pytest.mark.parametrize(
    ("file", "words"),
    [
        (changed((REGISTERED, "")), ["self.add_on_set_parameters_callback(self.check_parameters)", "def check_param"]),
        (changed(("add_on_set", "add_post_set")), ["def check_parameters(self, params):", "add_on_set_parameters"]),
        (
            changed(("self.timer = ", "")),
            ["        self.timer = self.create_timer(1.0 / self.rate, self.tick)", "self.timer.cancel()"],
        ),
        (
            changed(
                ("import SetParametersResult", "import SetParametersResult as Result"), ("return Set", "return Set")
            ),
            ["return Result(successful=True)"],
        ),
        (
            changed(("from rcl_interfaces.msg import SetParametersResult\n", "")),
            ["from rcl_interfaces.msg import SetParametersResult\n"],
        ),
        (changed(("self.changed)", "lambda params: None)")), ["callback(self.check_parameters)"]),
        (
            changed(
                (REGISTERED, ""),
                ("        self.declare_parameter('m", f"{REGISTERED}        self.declare_parameter('m"),
            ),
            ["and getattr(self, 'timer', None):"],
        ),
        (changed(("(self, params)", "(self)")), ["def changed(self, params):"]),
        (
            node_file(MODULE),
            [
                "timer = node.timer = node.create_timer(1.0, tick)",
                "node.timer = node.create_timer(1.0 / p.value, tick)",
                "\nnode.add_on_set_parameters_callback(check_parameters)",
            ],
        ),
    ],
)
def test_the_step_includes_everything_that_the_callback_needs(file: NodeFile, words: list[str]) -> None:
    after = apply_edits(file, parameter_callbacks.follow_parameters(file, RATE, PREFIX, ENABLED))
    for word in words:
        assert word in after, after


def test_a_timer_whose_attribute_is_set_to_none_is_stored_there() -> None:
    file = changed(
        ("self.timer = self.create_timer(1.0 / self.rate, self.tick)", "self.create_timer(1.0, self.tick)"),
        (REGISTERED, f"        self.timer = None\n{REGISTERED}"),
    )
    after = apply_edits(file, parameter_callbacks.follow_parameters(file, RATE))
    assert "self.timer = self.create_timer(1.0, self.tick)\n" + REGISTERED in after


def test_is_followed() -> None:
    assert not parameter_callbacks.is_followed(changed(), PREFIX)
    assert parameter_callbacks.is_followed(
        changed(("data=self.prefix", "data=self.get_parameter('message_prefix').value")), PREFIX
    )
    asking = "for p in params:\n            if p.name == 'message_prefix':\n                self.prefix = p.value\n"
    asked = changed(("        return Set", f"        {asking}        return Set"))
    assert parameter_callbacks.is_followed(asked, PREFIX)


def test_a_stored_period_is_computed_from_the_new_rate() -> None:
    file = changed(("self.rate = self", "self.period = 1.0 / self"), ("1.0 / self.rate,", "self.period,"))
    assert "self.period = 1.0 / p.value\n" in apply_edits(file, parameter_callbacks.follow_parameters(file, RATE))


def test_an_old_timer_that_is_left_running_is_cancelled() -> None:
    making = "self.timer = self.create_timer(1.0 / params[0].value, self.tick)"
    file = changed(("        return Set", f"        {making}\n        return Set"))
    right = changed(("        return Set", f"        self.timer.cancel()\n        {making}\n        return Set"))
    assert apply_edits(file, parameter_callbacks.cancel_old_timer(file)) == right.text
    assert parameter_callbacks.cancel_old_timer(right) == parameter_callbacks.cancel_old_timer(changed()) == []


def test_bad_rates_are_refused_before_anything_else() -> None:
    after = apply_edits(changed(), parameter_callbacks.refuse_bad_rates(changed(), RATE))
    assert "    def changed(self, params):\n        for p in params:\n            if p.name == 'publish_rate'" in after


@pytest.mark.parametrize(
    ("file", "name", "default", "line"),
    [
        (changed(("1.0)", "1)")), RATE, 1.0, "        self.declare_parameter('publish_rate', 1.0)"),
        (
            changed(),
            ENABLED,
            True,
            "__init__('parameterized_publisher')\n        self.declare_parameter('enabled', True)",
        ),
        (node_file("DEFAULTS = [('publish_rate', 2)]\n"), RATE, 1.0, "[('publish_rate', 1.0)]"),
        (node_file("DEFAULTS = {'publish_rate': 2}\n"), RATE, 1.0, "{'publish_rate': 1.0}"),
        (
            node_file("DEFAULTS = [{'name': 'publish_rate', 'default': 2}]\n"),
            RATE,
            1.0,
            "[{'name': 'publish_rate', 'default': 1.0}]",
        ),
        (node_file("@dataclass\nclass A:\n    publish_rate: float = 2\n"), RATE, 1.0, "publish_rate: float = 1.0"),
        (node_file("DEFAULTS = dict(publish_rate=2)\n"), RATE, 1.0, "dict(publish_rate=1.0)"),
        (node_file(MODULE), ENABLED, True, "create_node('p')\nnode.declare_parameter('enabled', True)"),
    ],
)
def test_a_parameter_is_declared_with_its_default(file: NodeFile, name: str, default: object, line: str) -> None:
    assert line in apply_edits(file, parameters.declare_parameter(file, name, default))


def test_a_parameter_declared_in_every_callback_is_declared_once() -> None:
    file = changed(
        ("        self.declare_parameter('message_prefix', 'Hello')\n", ""),
        ("        self.count += 1", "        self.prefix = self.declare_parameter('message_prefix', 'Hello').value"),
    )
    after = apply_edits(file, parameters.declare_once(file, 22))
    assert "__init__('parameterized_publisher')\n        self.declare_parameter('message_prefix', 'Hello')\n" in after
    assert after.endswith("        self.prefix = self.get_parameter('message_prefix').value\n")
    assert parameters.declare_once(changed(), 9) == []


def test_a_parameter_of_another_name_is_renamed_wherever_it_is_named() -> None:
    file = changed(("'message_prefix'", "'prefix'"))
    assert apply_edits(file, parameters.rename_parameter(file, PREFIX, [PREFIX, RATE, ENABLED])) == NODE


@pytest.mark.parametrize("code", ["msg = String()\n        msg.data = 'x'\n        self.publisher.publish(msg)", ""])
def test_the_message_is_replaced(code: str) -> None:
    file = changed(("self.publisher.publish(String(data=self.prefix))", code)) if code else changed()
    assert publishing.prefixed_text(file, PREFIX) in apply_edits(
        file, publishing.send_data(file, publishing.prefixed_text(file, PREFIX))
    )


def test_a_message_of_another_class_is_left_alone() -> None:
    lines = ("status = Bool()", "status.data = True", "msg = String()", "msg.data = 'x'", "self.publisher.publish(msg)")
    code = "\n        ".join(lines)
    file = changed(("self.publisher.publish(String(data=self.prefix))", code))
    after = apply_edits(file, publishing.send_data(file, "'y'", message_class="String"))
    assert after == file.text.replace("msg.data = 'x'", "msg.data = 'y'")


def test_the_timer_callback_is_rewritten_as_a_whole() -> None:
    code = publishing.prefixed_text(changed(), PREFIX)
    assert apply_edits(changed(), publishing.whole_timer_callback(changed(), code, enabled=ENABLED)).endswith(
        """\
    def tick(self):
        if not self.get_parameter('enabled').value:
            return
        message = String()
        message.data = f'{self.get_parameter("message_prefix").value} {self.count}'
        self.publisher.publish(message)
        self.count += 1
"""
    )


def test_an_empty_node_gets_a_publisher_a_timer_and_a_callback() -> None:
    file = node_file("class P(Node):\n    def __init__(self):\n        super().__init__('p')\n")
    after = apply_edits(file, publishing.whole_publishing(file, "/chatter", "std_msgs/msg/String", "'Hello'", RATE))
    for line in (
        "from std_msgs.msg import String",
        "self.publisher = self.create_publisher(String, '/chatter', 10)",
        "self.timer = self.create_timer(1.0, self.timer_callback)",
        "self.publisher.publish(message)",
    ):
        assert line in after


def test_a_second_timer_is_removed() -> None:
    file = changed(("        self.add_on", "        self.create_timer(1.0, self.tick)\n        self.add_on"))
    assert apply_edits(file, publishing.keep_one_timer(file)) == NODE


@pytest.mark.parametrize(
    ("file", "cause", "line"),
    [
        (changed(("1.0 / self.rate", "1 // self.rate")), "period made a whole number", "create_timer(1 / self.rate,"),
        (changed(("1.0 / self.rate", "int(1 / self.rate)")), "period made a whole number", "timer(1 / self.rate,"),
        (changed(("1.0 / self.rate", "1000 / self.rate")), "wrong timer period", "create_timer(1.0 / self.rate,"),
    ],
)
def test_slips_in_a_period(file: NodeFile, cause: str, line: str) -> None:
    found = period_slips.diagnose_integer_period(file) or period_slips.diagnose_period_unit(file)
    assert found is not None
    assert found.name == cause
    assert line in apply_step(found.hint, {"node.py": file.text})["node.py"]
    assert period_slips.diagnose_integer_period(changed()) is period_slips.diagnose_period_unit(changed()) is None


COUNT = "        self.count = 0\n"
DECLARED = """\
        self.declare_parameter('message_prefix', 'Hello')
        self.declare_parameter('publish_rate', 1.0)
"""
DECLARED_AT_ONCE = "        self.declare_parameters('', PARAMETERS, ignore_override=True)\n"
DECLARED_IN_LOOP = """\
        for name, default in (('message_prefix', 'Hello'), ('publish_rate', 1.0)):
            self.declare_parameter(name, default, ignore_override=True)
"""


@pytest.mark.parametrize(
    ("file", "right"),
    [
        (changed(("        self.count += 1\n", "        self.count += 1\n        self.prefix = 'Hello'\n")), NODE),
        (
            changed(("'Hello')", "'Hello', ignore_override=True)")),
            NODE.replace("'Hello')", "'Hello', ignore_override=False)"),
        ),
        (
            changed((DECLARED, DECLARED_AT_ONCE)),
            NODE.replace(DECLARED, DECLARED_AT_ONCE.replace("True", "False")),
        ),
        (
            changed((DECLARED, DECLARED_IN_LOOP)),
            NODE.replace(DECLARED, DECLARED_IN_LOOP.replace("True", "False")),
        ),
        (
            changed(
                (
                    "        self.count += 1\n",
                    "        self.count += 1\n        self.set_parameters([A('message_prefix')])\n",
                )
            ),
            NODE,
        ),
        (
            changed((COUNT, f"{COUNT}        self.set_parameters([*DEFAULTS])\n")),
            NODE.replace(
                COUNT, f"{COUNT}        self.set_parameters([self.get_parameter(each.name) for each in [*DEFAULTS]])\n"
            ),
        ),
    ],
)
def test_a_value_that_the_node_overwrites(file: NodeFile, right: str) -> None:
    found = parameter_slips.diagnose_override(file, PREFIX)
    assert found is not None
    assert found.name == "value overwritten by the node"
    assert apply_step(found.hint, {"node.py": file.text})["node.py"] == right
    assert parameter_slips.diagnose_override(changed(), PREFIX) is None
    corrected = changed(
        (
            "        self.count = 0\n",
            "        if self.rate <= 0:\n            self.rate = 1.0\n        self.count = 0\n",
        )
    )
    assert parameter_slips.diagnose_override(corrected, RATE) is None
    other_set = changed((COUNT, f"{COUNT}        self.set_parameters([Parameter('publish_rate', value=1.0)])\n"))
    assert parameter_slips.diagnose_override(other_set, PREFIX) is None
    fallback = changed(
        (COUNT, f"        if self.rate <= 0:\n            self.set_parameters([A('publish_rate')])\n{COUNT}")
    )
    assert parameter_slips.diagnose_override(fallback, RATE) is None


OVERRIDES = """\
OPTIONS = {'automatically_declare_parameters_from_overrides': True,
           'parameter_overrides': [
               Parameter('message_prefix', Parameter.Type.STRING, 'Hello'),
               Parameter('publish_rate', value=1.0),
           ],
           'start_parameter_services': True}


class Talker(Node):
    def __init__(self):
        super().__init__('talker', **OPTIONS)
        self.rate = self.get_parameter('publish_rate').value
"""


def test_overrides_among_the_options_of_a_node() -> None:
    found = parameter_slips.diagnose_override(NodeFile(OVERRIDES), RATE)
    assert found is not None
    assert found.name == "value overwritten by the node"
    assert found.hint == (
        "write below line 11, with the same indentation:\n"
        "    self.declare_parameter('message_prefix', 'Hello')\n"
        "    self.declare_parameter('publish_rate', 1.0)\n"
        "lines 1 to 6 become: OPTIONS = {'start_parameter_services': True}"
    )
    assert parameter_slips.diagnose_override(NodeFile(OVERRIDES), ENABLED) is None
    other = OVERRIDES.replace("'parameter_overrides'", "'defaults'")
    assert parameter_slips.diagnose_override(NodeFile(other), RATE) is None
    declared = OVERRIDES + "        self.declare_parameter('message_prefix', 'Hello')\n"
    found = parameter_slips.diagnose_override(NodeFile(declared), PREFIX)
    assert found is not None
    assert found.hint == "lines 1 to 6 become: OPTIONS = {'start_parameter_services': True}"


def test_the_message_of_a_parameters_value_is_not_the_value() -> None:
    read = "        rate = float(self.get_parameter('publish_rate').get_parameter_value())\n"
    found = parameter_slips.diagnose_override(NodeFile(NODE + read), RATE)
    assert found is not None
    assert found.name == "parameter value not read"
    assert found.hint == "line 24 becomes: rate = float(self.get_parameter('publish_rate').value)"
    field = read.replace("value())", "value().double_value)")
    assert parameter_slips.diagnose_override(NodeFile(NODE + field), RATE) is None


def test_a_parameter_that_the_node_sets_through_a_variable_is_left_alone() -> None:
    again = "        value = Parameter('message_prefix', value='Hello')\n        self.set_parameters([value])\n"
    found = parameter_slips.diagnose_override(NodeFile(NODE + again), PREFIX)
    assert found is not None
    assert found.hint == "remove line 25: self.set_parameters([value])"
    assert parameter_slips.diagnose_override(NodeFile(NODE + again), ENABLED) is None


@pytest.mark.parametrize(
    ("file", "cause", "line"),
    [
        (changed((REGISTERED, "")), "callback not registered", REGISTERED),
        (changed(("(self.changed)", "(self.changed([]))")), "callback not registered", REGISTERED),
        (
            changed(("    def tick", "    def changed(self, params):\n        pass\n\n    def tick")),
            "callback defined twice",
            REGISTERED,
        ),
    ],
)
def test_a_callback_that_is_never_called(file: NodeFile, cause: str, line: str) -> None:
    found = parameter_callback_slips.diagnose_uncalled_callback(file)
    assert found is not None
    assert found.name == cause
    assert line in apply_step(found.hint, {"node.py": file.text})["node.py"]
    assert parameter_callback_slips.diagnose_uncalled_callback(changed()) is None


def test_an_on_set_callback_that_reads_the_old_value() -> None:
    reading = "for p in params:\n            self.prefix = self.get_parameter('message_prefix').value\n        return"
    file = changed(("        return Set", f"        {reading} Set"))
    found = parameter_callback_slips.diagnose_old_value_read(file, PREFIX)
    assert found is not None
    assert "self.prefix = p.value" in found.hint


def test_an_unparsable_file_yields_no_step() -> None:
    for text in ("", "def f(:\n"):
        file = node_file(text)
        assert (
            file.step(parameter_callbacks.follow_parameters(file, RATE), parameters.declare_parameter(file, RATE, 1.0))
            is None
        )
        assert (
            file.step(publishing.send_data(file, "1.0"), publishing.whole_publishing(file, "/a", "a/msg/B", "1", "1"))
            is None
        )


def test_of_several_timers_the_one_that_publishes_is_the_first() -> None:
    source = """from rclpy.node import Node
from std_msgs.msg import Float64

class Sensor(Node):
    def __init__(self):
        super().__init__('sensor')
        self.publisher = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.sampling = self.create_timer(0.1, self.sample)
        self.reporting = self.create_timer(0.5, self.report)

    def sample(self):
        self.latest = 20.0

    def report(self):
        self.publisher.publish(Float64(data=self.latest))
"""
    file = node_file(source)
    assert file.timer_callback is not None
    assert file.timer_callback.name == "report"
    assert "line 9 becomes: self.reporting = self.create_timer(2.0, " in str(
        file.step(publishing.set_period(file, "2.0"))
    )


def test_an_async_callback_and_what_it_awaits_become_plain_functions() -> None:
    text = NODE.replace("    def changed", "    async def changed").replace(
        "        return Set", "        await self.apply(params)\n        return Set"
    )
    text += "\n    async def apply(self, params):\n        pass\n"
    file = node_file(text)
    step = file.step(parameter_callbacks.without_async(file))
    assert step is not None
    assert apply_step(step, {"": text})[""] == text.replace("async ", "").replace("await ", "")
    assert parameter_callbacks.is_coroutine(file)
    assert not parameter_callbacks.is_coroutine(node_file(NODE))


@pytest.mark.parametrize("called", ["node.register()", "main_node().register()"])
def test_a_callback_that_main_lets_the_node_register_is_called(called: str) -> None:
    text = NODE.replace(REGISTERED, "").replace(
        "    def changed", f"    def register(self):\n{REGISTERED}\n    def changed"
    )
    found = parameter_callback_slips.diagnose_uncalled_callback(node_file(text))
    assert found is not None
    assert found.name == "callback not registered"
    main = f"\n\ndef main():\n    node = ParameterizedPublisher()\n    {called}\n"
    assert parameter_callback_slips.diagnose_uncalled_callback(node_file(text + main)) is None


def test_the_types_of_subclasses_get_topics_of_their_own() -> None:
    text = (
        "class Base(Node):\n    topic = '/chatter'\n    kind = String\n\n    def __init__(self):\n"
        "        self.pub = self.create_publisher(self.kind, self.topic, 10)\n\n\n"
        "class Numbers(Base):\n    kind = Int32\n"
    )
    file = node_file(text)
    step = file.step(publishing.use_one_type(file, "/chatter", "std_msgs/msg/String"))
    assert step == "write below line 10, with the same indentation: topic = '/chatter_int32'"


@pytest.mark.parametrize(
    ("imports", "expected"),
    [
        ("import rclpy", "from std_msgs.msg import String\nimport rclpy"),
        ("from std_msgs.msg import Int64, String as Text", None),
        ("import std_msgs.msg", None),
        ("from example_interfaces.msg import String", "from std_msgs.msg import String"),
        (
            "from example_interfaces.msg import Int64, String",
            "from example_interfaces.msg import Int64\nfrom std_msgs.msg import String",
        ),
        (
            "import rclpy\nfrom std_msgs.msg import String\nfrom example_interfaces.msg import String",
            "import rclpy\nfrom std_msgs.msg import String\nfrom std_msgs.msg import String",
        ),
    ],
)
def test_a_name_of_another_module_is_imported_from_the_right_one(imports: str, expected: str | None) -> None:
    file = NodeFile(f"{imports}\n\nprint(String)\n")
    step = file.step(file.import_name("String", "std_msgs.msg")[1])
    if expected is None:
        assert step is None
    else:
        assert apply_step(step or "", {"node.py": file.text})["node.py"] == f"{expected}\n\nprint(String)\n"
