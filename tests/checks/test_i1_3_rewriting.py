"""I1.3: the last resort: a whole program in the learner's names, where no smaller step is left."""

from __future__ import annotations

import ast

import pytest

from checks.i1_3 import rewriting, services
from checks.i1_3.code import Code
from checks.i1_3.facts import SIGNS, ServiceCalls
from checks.i1_3.judges import judge_services
from tests.checks.made import trace
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


def seen(text: str) -> Trace:
    return trace(sources={"node.py": text})


def followed(text: str, step: str | None) -> str:
    assert step is not None
    return apply_step(step, {"node.py": text})["node.py"]


def test_a_server_as_a_whole_keeps_the_learners_names() -> None:
    after = followed(SERVER, rewriting.rewrite_server(seen(SERVER)))
    ast.parse(after)
    assert after.startswith('#!/usr/bin/env python3\n"""A calculator."""\nimport rclpy\n')
    assert "class Calc(Node):\n    def __init__(self):\n        super().__init__('calc')\n" in after
    assert "def add(self, req, res):\n        res.sum = req.a + req.b\n        return res\n" in after
    assert "Thread" not in after
    assert rewriting.rewrite_server(seen(after)) is None


@pytest.mark.parametrize("text", ["def main(:\n", "import rclpy\nrclpy.spin(None)\n", "pass\n"])
def test_it_needs_no_file_that_python_can_read(text: str) -> None:
    after = followed(text, rewriting.rewrite_server(seen(text)))
    assert after.count("self.create_service(") == 4
    assert after.count("rclpy.init()") == 1
    after = followed(text, rewriting.rewrite_client(Code(text, "node.py")))
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


def test_what_was_written_already_is_not_written_again() -> None:
    after = followed(LOOP, services.compute_results(seen(LOOP), list(SIGNS)))
    assert "def calculate(self, name, request, response):" in after
    assert services.compute_results(seen(after), list(SIGNS)) is None


def test_no_step_of_a_server_is_in_words_only() -> None:
    text = "import rclpy\n\nrclpy.init()\n"
    verdict = judge_services(ServiceCalls(seen(text), ()))
    after = followed(text, verdict.hint)
    assert after.count("create_service(") == 4


@pytest.mark.parametrize(
    "text",
    [
        "class Client(Node):\n    pass\n\n\ndef main(args=None):\n    node = Client()\n    node.ask()\n\n\nmain()\n",
        "NAMES = ['add']\n\n\nclass Client(Node):\n    names = NAMES\n\n\nrclpy.init()\nnode = Client()\n",
        "async def run():\n    await Client().ask()\n\n\nif __name__ == '__main__':\n    asyncio.run(run())\n",
    ],
)
def test_a_client_as_a_whole_calls_all_four(text: str) -> None:
    after = followed(text, rewriting.rewrite_client(Code(text, "node.py")))
    assert "for name in ('add', 'subtract', 'multiply', 'divide'):" in after
    assert "rclpy.spin_until_future_complete(node, future)" in after
    assert after.count("rclpy.init()") == 1
    assert "asyncio.run(" not in after
