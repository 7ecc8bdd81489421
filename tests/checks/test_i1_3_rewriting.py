"""I1.3: the last resort, if no smaller step is left: a whole program in the learner's own names."""

from __future__ import annotations

import ast

import pytest

from checks.i1_3 import rewriting, services
from checks.i1_3.code import Code
from checks.i1_3.facts import OPERATOR_SIGNS, ServiceCalls
from checks.i1_3.judges import judge_services
from tests.checks.builders import trace
from tutor.judge.step_parsing import apply_step
from tutor.judge.trace import Trace

SERVER = '''\
#!/usr/bin/env python3
"""A calculator."""
import rclpy
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class Calc(Node):
    def __init__(self):
        super().__init__("calc")
        for name in ("add", "subtract", "multiply", "divide"):
            self.create_service(AddTwoInts, name, getattr(self, name))

    def add(self, req, res):
        pass


def main():
    rclpy.init()
    threads = [Thread(target=rclpy.spin, args=(Calc(),)) for _ in range(4)]
    threads[0].start()


main()
'''


def run_of(text: str) -> Trace:
    return trace(sources={"node.py": text})


def follow_step(text: str, step: str | None) -> str:
    assert step is not None
    return apply_step(step, {"node.py": text})["node.py"]


def test_a_rewritten_server_keeps_the_learners_names() -> None:
    after = follow_step(SERVER, rewriting.rewrite_server(run_of(SERVER)))
    ast.parse(after)
    assert after.startswith('#!/usr/bin/env python3\n"""A calculator."""\nimport rclpy\n')
    assert "class Calc(Node):\n    def __init__(self):\n        super().__init__('calc')\n" in after
    assert "def add(self, req, res):\n        res.sum = req.a + req.b\n        return res\n" in after
    assert "Thread" not in after
    assert rewriting.rewrite_server(run_of(after)) is None


@pytest.mark.parametrize("text", ["def main(:\n", "import rclpy\nrclpy.spin(None)\n", "pass\n"])
def test_rewriting_needs_no_parsable_file(text: str) -> None:
    after = follow_step(text, rewriting.rewrite_server(run_of(text)))
    assert after.count("self.create_service(") == 4
    assert after.count("rclpy.init()") == 1
    after = follow_step(text, rewriting.rewrite_client(Code(text, "node.py")))
    assert "rclpy.spin_until_future_complete(node, future)" in after
    assert rewriting.rewrite_client(Code(after, "node.py")) is None


LOOP = """\
class Calc(Node):
    def __init__(self):
        super().__init__("calc")
        for name in NAMES:
            self.create_service(AddTwoInts, name, self.answer)

    def answer(self, req, res):
        return res
"""


def test_code_that_was_already_added_is_not_added_again() -> None:
    after = follow_step(LOOP, services.compute_results(run_of(LOOP), list(OPERATOR_SIGNS)))
    assert "def calculate(self, name, request, response):" in after
    assert services.compute_results(run_of(after), list(OPERATOR_SIGNS)) is None


def test_a_common_callback_does_not_take_a_name_that_the_learner_uses() -> None:
    taken = LOOP.replace("class ", "def calculate():\n    pass\n\n\nclass ", 1)
    after = follow_step(taken, services.compute_results(run_of(taken), list(OPERATOR_SIGNS)))
    assert "def answer_request(self, name, request, response):" in after


def test_the_step_for_an_empty_server_can_be_applied() -> None:
    text = "import rclpy\n\nrclpy.init()\n"
    verdict = judge_services(ServiceCalls(run_of(text), ()))
    after = follow_step(text, verdict.step)
    assert after.count("create_service(") == 4


@pytest.mark.parametrize(
    "text",
    [
        "class Client(Node):\n    pass\n\n\ndef main(args=None):\n    node = Client()\n    node.ask()\n\n\nmain()\n",
        "NAMES = ['add']\n\n\nclass Client(Node):\n    names = NAMES\n\n\nrclpy.init()\nnode = Client()\n",
        "async def run():\n    await Client().ask()\n\n\nif __name__ == '__main__':\n    asyncio.run(run())\n",
    ],
)
def test_a_rewritten_client_calls_all_four_services(text: str) -> None:
    after = follow_step(text, rewriting.rewrite_client(Code(text, "node.py")))
    assert "for name in ('add', 'subtract', 'multiply', 'divide'):" in after
    assert "rclpy.spin_until_future_complete(node, future)" in after
    assert after.count("rclpy.init()") == 1
    assert "asyncio.run(" not in after
