"""Steps for known exceptions that are made from the file's syntax tree: each leaves a file that Python can parse."""

from __future__ import annotations

import ast

import pytest

from tutor.judge.exceptions import RaisedException, explain, load_shipped
from tutor.judge.step_parsing import apply_step
from tutor.judge.tracebacks import Frame, Traceback

FOLDER = "/home/me/ws"
CHECKED = """\
from rclpy.node import Node


class N(Node):
    def __init__(self):
        super().__init__('n')
        self.add_on_set_parameters_callback(self.on_set)

    def on_set(self, params):
        {body}

    def check(self, value):
        {raises}
"""
RAISES = "raise ValueError(f'no {value}')"


def repair(text: str, raised: str, number: int, function: str = "f") -> str:
    """The file after following the step for an exception raised at line `number` of it."""
    name, _, message = raised.partition(": ")
    frame = Frame(f"{FOLDER}/node.py", number, function, text.splitlines()[number - 1].strip())
    found = Traceback(name, message, (frame,))
    cause = explain(RaisedException(found, FOLDER, frame, "node.py", text), load_shipped(), cause="x")
    assert cause is not None
    after = apply_step(cause.hint, {"node.py": text})["node.py"]
    ast.parse(after)
    return after


LOG = "TypeError: RcutilsLogger.info() takes 2 positional arguments but 4 were given"
SPLIT = "ImportError: cannot import name 'ExternalShutdownException' from 'rclpy' (/x)"
SEVERITY = "ValueError: Logger severity cannot be changed between calls."
NO_TYPE = "AttributeError: type object 'str' has no attribute '_TYPE_SUPPORT'"


@pytest.mark.parametrize(
    ("text", "raised", "number", "after"),
    [
        ("log.info('%d of %d', a, b)\n", LOG, 1, "log.info('%d of %d' % (a, b))\n"),
        ("log.info('%.1f', rate)\n", LOG, 1, "log.info('%.1f' % rate)\n"),
        ("log.info('%d', a + b)\n", LOG, 1, "log.info('%d' % (a + b,))\n"),
        ("log.info('{} of {}', a, b)\n", LOG, 1, "log.info('{} of {}'.format(a, b))\n"),
        ("log.info('rate', a, b)\n", LOG, 1, "log.info(' '.join(map(str, ('rate', a, b))))\n"),
        ("if a: log.info(\n    '%d of %d',\n    a,\n    b,\n)\n", LOG, 1, "if a: log.info('%d of %d' % (a, b))\n"),
        ("log.info('%d', a, once=True)\nlog.warn('%d', b)\n", LOG, 1, None),
        (
            "def say(level, text):\n    getattr(log, level)(text)\n\nsay('warning', 'a')\nsay('info', 'b')\n",
            SEVERITY,
            2,
            "def say(level, text):\n    if level == 'warning':\n        log.warning(text)\n    else:\n"
            "        log.info(text)\n\nsay('warning', 'a')\nsay('info', 'b')\n",
        ),
        (
            "def say(text, level=LoggingSeverity.INFO):\n    log.log(text, level)\n\nsay('a', LoggingSeverity.WARN)\n",
            SEVERITY,
            2,
            "def say(text, level=LoggingSeverity.INFO):\n"
            "    if level == LoggingSeverity.WARN:\n        log.warn(text)\n"
            "    else:\n        log.info(text)\n\nsay('a', LoggingSeverity.WARN)\n",
        ),
        (
            "(log.info if fine else log.error)(f'{a}', once=True)\n",
            SEVERITY,
            1,
            "if fine:\n    log.info(f'{a}', once=True)\nelse:\n    log.error(f'{a}', once=True)\n",
        ),
        (
            "def f():\n    write = log.info if fine else log.error\n    write(a)\n",
            SEVERITY,
            3,
            "def f():\n    write = log.info if fine else log.error\n    if fine:\n        log.info(a)\n    else:\n"
            "        log.error(a)\n",
        ),
        (
            "from rclpy import (\n    init,\n    ExternalShutdownException as Ended,\n)\n",
            SPLIT,
            1,
            "from rclpy import init\nfrom rclpy.executors import ExternalShutdownException as Ended\n",
        ),
        (
            "from rcl_interfaces.msg import SetParameterResult, Log\nx = SetParameterResult()\n",
            "ImportError: cannot import name 'SetParameterResult' from 'rcl_interfaces.msg' (/x)",
            1,
            "from rcl_interfaces.msg import Log\nfrom rcl_interfaces.msg import SetParametersResult\n"
            "x = SetParametersResult()\n",
        ),
        (
            "n.create_publisher('a', String, 10)\nn.create_client('add', AddTwoInts)\n",
            NO_TYPE,
            1,
            "n.create_publisher(String, 'a', 10)\nn.create_client(AddTwoInts, 'add')\n",
        ),
        ("print(1))\n", "SyntaxError: unmatched ')'", 1, "print(1)\n"),
        ("x = [1, 2\n\nprint(x)\n", "SyntaxError: '[' was never closed", 1, "x = [1, 2]\n\nprint(x)\n"),
        (
            "print(\n    max(1, 2\n    )\nx = 1\n",
            "SyntaxError: '(' was never closed",
            1,
            "print(\n    max(1, 2)\n    )\nx = 1\n",
        ),
        (
            "x = [\n    'a'\n    1,\n]\n",
            "SyntaxError: invalid syntax. Perhaps you forgot a comma?",
            2,
            "x = [\n    'a',\n    1,\n]\n",
        ),
        ("max(1 2)\n", "SyntaxError: invalid syntax. Perhaps you forgot a comma?", 1, "max(1, 2)\n"),
        (
            "def f():\nx = 1\nreturn x\n\nf()\n",
            "IndentationError: expected an indented block after function definition on line 1",
            2,
            "def f():\n    x = 1\n    return x\n\nf()\n",
        ),
        (
            "def f():\n\n\ndef g():\n    return 1\n",
            "IndentationError: expected an indented block after function definition on line 1",
            4,
            None,
        ),
        ("x = 1\n    y = 2\nz = 3\n", "IndentationError: unexpected indent", 2, "x = 1\ny = 2\nz = 3\n"),
        (
            "p = n.create_publisher(String, 'a', 10)\ns = n.create_publisher(Log, 'a', 10)\ns.publish(x)\n",
            "RCLError: create_publisher() called for existing topic name rt/a with incompatible type x",
            2,
            "p = n.create_publisher(String, 'a', 10)\n",
        ),
        ("f = open('a')\n", "UnicodeDecodeError: 'ascii' codec", 1, "f = open('a', encoding='utf-8')\n"),
        (
            "p.add_argument('rate', type=float)\np.add_argument('--n', required=True)\na = p.parse_args()\n",
            "SystemExit: node.py: error: the following arguments are required: rate",
            3,
            "p.add_argument('--rate', type=float, default='1')\np.add_argument('--n', default='1')\n"
            "a = p.parse_known_args()[0]\n",
        ),
        (
            "asyncio.get_event_loop().create_task(self.work())\n",
            "RuntimeError: no running event loop",
            1,
            "self.executor.create_task(self.work())\n",
        ),
    ],
)
def test_the_file_after_the_step(text: str, raised: str, number: int, after: str | None) -> None:
    repaired = repair(text, raised, number)
    assert after is None or repaired == after


def test_a_parameter_callback_that_raises_refuses_the_change_with_the_reason() -> None:
    body = "self.check(params[0].value)\n        return 1"
    text = CHECKED.format(body="raise ValueError('no')", raises="pass")
    after = repair(text, "ValueError: no", 10, "on_set")
    assert "        return SetParametersResult(successful=False, reason='no')\n" in after
    assert after.startswith("from rcl_interfaces.msg import SetParametersResult\n")
    after = repair(CHECKED.format(body=body, raises=RAISES), "ValueError: no 0", 14, "check")
    assert "        try:\n            self.check(params[0].value)\n        except Exception as error:\n" in after
    assert "            return SetParametersResult(successful=False, reason=str(error))\n        return 1\n" in after
    assert RAISES in after


def test_any_other_callback_that_raises_logs_the_error_and_returns() -> None:
    text = CHECKED.replace("add_on_set_parameters_callback(", "create_timer(1.0, ").format(body="pass", raises=RAISES)
    after = repair(text, "ValueError: no 0", 13, "check")
    assert "        self.get_logger().error(f'no {value}')\n        return\n" in after
