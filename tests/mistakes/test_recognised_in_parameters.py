"""Which mistake is told for parameters without effect, from the learner's code; and for code that is right, none."""

from __future__ import annotations

import pytest

from tests.checks.builders import refused
from tests.mistakes.cases import assert_told, told
from tutor.judge.symptom import Symptom

IGNORED, NOTHING = Symptom.CHANGE_IGNORED, "parameter-ignored"
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
COUNT = "        self.count = 0\n"
DECLARED = """\
        self.declare_parameter('message_prefix', 'Hello')
        self.declare_parameter('publish_rate', 1.0)
"""
IN_A_LOOP = """\
        for name, default in (('message_prefix', 'Hello'), ('publish_rate', 1.0)):
            self.declare_parameter(name, default, ignore_override=True)
"""
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
SETS_UNDECLARED = """\
class Talker(Node):
    def __init__(self):
        super().__init__('talker', allow_undeclared_parameters=True)
        rate = Parameter('publish_rate', Parameter.Type.DOUBLE, 1.0)
        self.set_parameters([rate])
"""
ARGUMENTS = """\
class Talker(Node):
    def __init__(self):
        super().__init__('talker', cli_args=['--ros-args', '-p', 'publish_rate:=1.0'])
"""


def changed(*pairs: tuple[str, str], text: str = NODE) -> str:
    """The node with each of these texts replaced."""
    for old, new in pairs:
        assert old in text
        text = text.replace(old, new)
    return text


AGAIN = "        value = Parameter('message_prefix', value='Hello')\n        self.set_parameters([value])\n"
READ = "        rate = float(self.get_parameter('publish_rate').get_parameter_value())\n"


@pytest.mark.parametrize(
    ("source", "parameter", "line"),
    [
        (changed(("        self.count += 1\n", "        self.prefix = 'Hello'\n")), "message_prefix", 23),
        (changed(("'Hello')", "'Hello', ignore_override=True)")), "message_prefix", 9),
        (
            changed((DECLARED, "        self.declare_parameters('', PARAMETERS, ignore_override=True)\n")),
            "message_prefix",
            9,
        ),
        (changed((DECLARED, IN_A_LOOP)), "message_prefix", 10),
        (changed((COUNT, f"{COUNT}        self.set_parameters([A('message_prefix')])\n")), "message_prefix", 14),
        (changed((COUNT, f"{COUNT}{AGAIN}")), "message_prefix", 15),
        (changed((COUNT, f"{COUNT}{AGAIN}")), "publish_rate", 0),
        (changed((COUNT, f"        if self.rate <= 0:\n            self.rate = 1.0\n{COUNT}")), "publish_rate", 0),
        (
            changed(
                (COUNT, f"        if self.rate <= 0:\n            self.set_parameters([A('publish_rate')])\n{COUNT}")
            ),
            "publish_rate",
            0,
        ),
        (NODE, "message_prefix", 0),
        (OVERRIDES, "publish_rate", 1),
        (OVERRIDES, "enabled", 0),
        (OVERRIDES.replace("'parameter_overrides'", "'defaults'"), "publish_rate", 0),
        (SETS_UNDECLARED, "publish_rate", 5),
        (ARGUMENTS, "publish_rate", 3),
        (ARGUMENTS, "enabled", 0),
    ],
)
def test_a_value_that_the_node_overwrites(source: str, parameter: str, line: int) -> None:
    found = told(IGNORED, source, parameter=parameter, at_start=True)
    assert (found.mistake, found.line) == ("value-overwritten-by-the-node" if line else NOTHING, line)


@pytest.mark.parametrize(
    ("source", "mistake", "words"),
    [
        ("self.n = self.get_parameter('name')", "parameter-object", "line 1"),
        ("self.n = self.get_parameter('name').value", NOTHING, ""),
        ("self.n = self.get_parameter('other')", NOTHING, ""),
        ("self.n = self.get_parameter('name')\nx = self.n.value", NOTHING, ""),
        (READ.strip().replace("publish_rate", "name"), "parameter-value-not-read", "line 1"),
        (READ.strip().replace("publish_rate", "name").replace("e())", "e().double_value)"), NOTHING, ""),
        ("rclpy.init(args=[])", "arguments-left-out", "line 1"),
        ("def main(args=[]):\n  rclpy.init(args=args)", "arguments-left-out", "line 2"),
        ("n = Node('n', use_global_arguments=False)", "arguments-left-out", "line 1"),
        ("argv = remove_ros_args(sys.argv)\nrclpy.init(args=argv)", "arguments-left-out", "line 2"),
        ("argv = sys.argv[2:]\nrclpy.init(args=argv)", "arguments-left-out", "line 2"),
        ("argv = sys.argv[:1]\nrclpy.init(args=argv)", "arguments-left-out", "line 2"),
        ("argv = sys.argv[1:]\nrclpy.init(args=argv)", NOTHING, ""),
        ("rclpy.init(args=sys.argv)", NOTHING, ""),
        ("def main(args=None):\n  rclpy.init(args=args)", NOTHING, ""),
        ("def main(n, args=['a'], *, x=[]):\n  rclpy.init(args=args)", NOTHING, ""),
        ("rclpy.init()", NOTHING, ""),
    ],
)
def test_a_value_that_does_not_arrive(source: str, mistake: str, words: str) -> None:
    assert_told(told(IGNORED, source, parameter="name", at_start=True), mistake, words)


OLD = "for p in params:\n            self.prefix = self.get_parameter('message_prefix').value\n        return"
REGISTER = f"    def register(self):\n{REGISTERED}\n    def changed"
MAIN = "\n\ndef main():\n    node = ParameterizedPublisher()\n    {}\n"
CLASS_ATTRIBUTE = """\
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
TYPES = "def f(p):\n  if p.type_ == ParameterType.PARAMETER_BOOL:\n    pass\nn.add_on_set_parameters_callback(f)"
DOTTED = "class A:\n    def f(self, p):\n        setattr(self, {}, p.value)\n"
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


@pytest.mark.parametrize(
    ("source", "mistake", "words"),
    [
        (changed((REGISTERED, "")), "callback-not-registered", "nothing registers changed"),
        (changed(("(self.changed)", "(self.changed([]))")), "callback-not-registered", "line 16 calls"),
        (
            changed(("    def tick", "    def changed(self, params):\n        pass\n\n    def tick")),
            "callback-defined-twice",
            "line 18",
        ),
        (changed((REGISTERED, ""), ("    def changed", REGISTER)), "callback-not-registered", "in register"),
        (changed((REGISTERED, ""), ("    def changed", REGISTER)) + MAIN.format("node.register()"), NOTHING, ""),
        (changed((REGISTERED, ""), ("    def changed", REGISTER)) + MAIN.format("made().register()"), NOTHING, ""),
        (changed(("        return Set", f"        {OLD} Set")), "old-value-used", "line 20"),
        (NODE, NOTHING, ""),
        (REFUSES_AFTERWARDS, "refused-too-late", "line 4"),
        (REFUSES_AFTERWARDS.replace("post_set", "on_set"), NOTHING, ""),
        (CLASS_ATTRIBUTE, "class-attribute-set", "line 10"),
        (CLASS_ATTRIBUTE.replace("        self.prefix", "        Talker.prefix"), NOTHING, ""),
        (TYPES, "types-never-equal", "line 2"),
        (TYPES.replace("ParameterType.PARAMETER_BOOL", "Parameter.Type.BOOL"), NOTHING, ""),
        (DOTTED.format("'config.' + p.name"), "wrong-attribute-set", "line 3"),
        (DOTTED.format("f'config.{p.name}'"), "wrong-attribute-set", "config"),
        (DOTTED.format("'config.rate'"), "wrong-attribute-set", "config"),
        (DOTTED.format("'my_' + p.name"), NOTHING, ""),
        (DOTTED.format("p.name"), NOTHING, ""),
        ("self.on = str(p.value) == 'true'", "compared-with-a-text", "'true'"),
        ("\nif p.value == 'True':\n  pass", "compared-with-a-text", "line 2"),
        ("self.on = p.value != 'false'", "compared-with-a-text", "line 1"),
        ("self.on = 'false' == p.value", "compared-with-a-text", "line 1"),
        ("x = str(p.value).lower() == 'true'", NOTHING, ""),
        ("if p.name == 'true': pass", NOTHING, ""),
        ("x = p.value == 'a'", NOTHING, ""),
    ],
)
def test_a_change_without_effect(source: str, mistake: str, words: str) -> None:
    assert_told(told(IGNORED, source, parameter="message_prefix"), mistake, words)


NONE = changed(("        return SetParametersResult(successful=True)", "        self.count = 0"))
READ_ONLY = "Trying to set a read-only parameter: rate."


@pytest.mark.parametrize(
    ("reason", "source", "mistake", "words"),
    [
        ("Callback returned an invalid type", NONE, "callback-returns-none", "changed (line 18) returns nothing"),
        ("Callback returned an invalid type", "", "callback-returns-none", ""),
        (
            "Callback returned an invalid type",
            changed(("    def changed", "    async def changed")),
            "callback-returns-no-result",
            "line 18",
        ),
        ("Wrong parameter type, expected 'Type.INTEGER' got 'Type.DOUBLE'", "", "integer-parameter", ""),
        ("Wrong parameter type, expected 'Type.STRING' got 'Type.DOUBLE'", "", "wrong-parameter-type", "string"),
        ("rate has not been declared", "", "parameter-refused-as-undeclared", ""),
        (READ_ONLY, "descriptor = ParameterDescriptor(read_only=True)", "read-only-parameter", "line 1"),
        (READ_ONLY, "descriptor.read_only = True", "read-only-parameter", "line 1"),
        (READ_ONLY, "def declare(name, default, read_only=True): pass", "read-only-parameter", "line 1"),
        (READ_ONLY, "descriptor = ParameterDescriptor(read_only=False)", "read-only-parameter", "rate is read-only"),
        ("Parameter rate out of range Min: 1.0, Max: 5.0, value: 10.0", "", "range-too-narrow", "from 1.0 to 5.0"),
        ("too fast", "", "good-value-refused", ""),
        ("", "", "good-value-refused", ""),
    ],
)
def test_why_a_good_value_is_refused(reason: str, source: str, mistake: str, words: str) -> None:
    found = told(Symptom.REFUSED, source, parameter="rate", value=10.0, answer=refused({"rate": 10.0}, reason))
    assert_told(found, mistake, words)
