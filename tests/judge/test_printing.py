"""Which call printed a line, and how it becomes one of the node's logger."""

from __future__ import annotations

import pytest

from tests.checks.builders import trace
from tutor.judge.causes.printing import diagnose_own_logger, find_print, log_instead_of_print
from tutor.judge.rewriting.node import node_file
from tutor.judge.step_parsing import apply_step
from tutor.judge.trace import Trace


def printing(*lines: str) -> Trace:
    body = "".join(f"        {line}\n" for line in lines)
    return trace(sources={"node.py": f"import sys\n\nclass N(Node):\n    def tell(self, total, last):\n{body}"})


def follow_step(run: Trace, line: str) -> list[str]:
    """The lines of `tell` after following the step for this printed line."""
    call = find_print(run, line)
    assert call is not None
    after = apply_step(log_instead_of_print(run, call), run.sources)["node.py"]
    return [each.strip() for each in after.splitlines()[4:]]


@pytest.mark.parametrize(
    "code",
    [
        "print(f'total: {total}, last: {last}')",
        "print('total:', total, 'last:', last)",
        "print('total: %d, last: %s' % (total, last))",
        "print('total: {}, last: {}'.format(total, last))",
        "print('total: ' + str(total) + ', last: ' + last)",
        "print(f'--- stats ---\\ntotal: {total}\\nlast: {last}\\n')",
        "sys.stdout.write(f'total: {total}\\n')",
    ],
)
def test_the_call_that_wrote_a_line_is_found(code: str) -> None:
    found = find_print(
        printing("print('other: ', last)", code, "print('total count:', total)"), "total: 7, last: Hello"
    )
    assert found is not None
    assert found.lineno == 6


def test_text_kept_in_a_variable_is_found() -> None:
    assert find_print(printing("text = f'total: {total}'", "print(text)"), "total: 7") is not None
    assert find_print(printing("text = f'count: {total}'", "print(text)"), "total: 7") is None
    assert find_print(printing("text = last", "print(text)"), "total: 7") is None
    assert find_print(printing("last = 'last: ' + last", "print(last)"), "last: 7") is not None


def test_calls_that_print_other_lines_are_not_taken() -> None:
    assert find_print(printing("print(total)", "print(f'last: {last}')", "file.write('total: ')"), "total: 7") is None


def test_a_printed_block_is_logged_as_a_whole() -> None:
    run = printing(
        "print('--- stats ---')", "print('total:', total)", "print()", "self.n = 1", "print(f'last: {last}')"
    )
    assert follow_step(run, "total: 7") == [
        "self.get_logger().info('--- stats ---')",
        "self.get_logger().info(f'total: {total}')",
        "print()",
        "self.n = 1",
        "print(f'last: {last}')",
    ]


def test_a_single_print_is_logged() -> None:
    run = printing("print(f'total: {total}')", "self.n = 1", "print(f'last: {last}')")
    assert follow_step(run, "last: Hello") == [
        "print(f'total: {total}')",
        "self.n = 1",
        "self.get_logger().info(f'last: {last}')",
    ]


def test_a_write_is_logged() -> None:
    run = printing("text = f'total: {total}\\n'", "sys.stdout.write(text)", "sys.stdout.flush()")
    assert follow_step(run, "total: 7")[1] == "self.get_logger().info(str(text))"


def test_a_logger_that_replaces_that_of_the_node_gets_another_name() -> None:
    found = diagnose_own_logger(
        node_file("class N(Node):\n    def f(self):\n        self._logger = logging.getLogger('n')\n")
    )
    assert found is not None
    assert found.hint == "line 3 becomes: self._python_logger = logging.getLogger('n')"


def test_a_logger_under_another_name_replaces_none() -> None:
    assert (
        diagnose_own_logger(node_file("self.log = logging.getLogger('n')\nself._logger = self.get_logger()\n")) is None
    )
