"""The table of known exceptions: each entry matches its examples, and a broken table reports what is wrong with it."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from tests.checks.builders import exited, trace
from tests.judge.crashes import crash
from tutor.errors import TableError
from tutor.judge.causes import diagnose_process
from tutor.judge.exceptions import Example, KnownException, RaisedException, explain, load, load_shipped, parse
from tutor.judge.tracebacks import Frame, Traceback

FOLDER = "/home/me/ws"
OWN = "unhandled exception"


def raised_in(example: Example) -> RaisedException:
    """The exception that a process would have shown for this example."""
    name, _, message = example.raised.partition(": ")
    frames = []
    if example.line:
        lines = [each.strip() for each in example.source.splitlines()]
        number = lines.index(example.line) + 1 if example.line in lines else 1
        frames.append(Frame(f"{FOLDER}/node.py", number, example.function, example.line))
    if example.at:
        path, _, function = example.at.partition(", ")
        frames.append(Frame(path, 75, function, ""))
    found = Traceback(name, message, tuple(frames))
    return RaisedException(found, FOLDER, found.own(FOLDER), "node.py", example.source or example.line)


CHECK_TABLES = [load(path) for path in sorted((Path(__file__).parents[2] / "checks").glob("*/exceptions.toml"))]
EXAMPLES = [
    pytest.param(table, known, example, id=f"{example.raised[:50]} | {example.line[:30]}")
    for own in ((), *CHECK_TABLES)
    for table in ((*own, *load_shipped()),)
    for known in own or load_shipped()
    for example in known.examples
]


def test_checks_have_their_own_tables() -> None:
    assert CHECK_TABLES


@pytest.mark.parametrize(("table", "known", "example"), EXAMPLES)
def test_each_example_gets_its_step_from_its_own_entry(
    table: tuple[KnownException, ...], known: KnownException, example: Example
) -> None:
    found = explain(raised_in(example), table, cause=OWN)
    assert found is not None
    assert found.hint == example.step
    assert found.name == (known.cause or OWN)
    assert found == explain(raised_in(example), [known], cause=OWN)
    assert "{" in example.line or "{" not in found.hint


SEARCHES = r"""
import re, sys
from pathlib import Path
from tests.judge.test_exceptions import CHECK_TABLES
from tutor.judge.exceptions import load_shipped
from tutor.judge.known_exception import WORD

submissions = sorted((Path(path).read_text(errors="replace") for path in sys.argv[1:]), key=len)[-12:]
texts = [*submissions, "class N(Node):\n" + "        x = f(a, b)\n\n" * 200, "f(a, " * 50 + "\n" + "    g(b)\n" * 100]
tables = (*CHECK_TABLES, load_shipped())
for pattern in sorted({pattern for table in tables for each in table for pattern in (each.source, each.without)}):
    for text in texts:
        names = re.findall(r"^class (\w+)", text, re.MULTILINE) or ["x"]
        print(pattern, flush=True)
        re.search(WORD.sub(names[-1], pattern), text, re.MULTILINE)
print("all searched")
"""


def test_no_pattern_takes_long_in_a_long_file() -> None:
    """A nested repetition that is ambiguous takes for ever where it does not match; nothing can interrupt it."""
    folder = Path(__file__).parents[1] / "submissions"
    files = [str(path) for path in folder.glob("*/*/*/*.py")]
    # A search runs in C, so that only the end of its process stops it.
    command = ["timeout", "60", sys.executable, "-c", SEARCHES, *files]
    searched = subprocess.run(command, cwd=folder.parents[1], capture_output=True, text=True, check=False).stdout
    assert searched.splitlines()[-1] == "all searched"


ENTRY = """[[known]]
type = "ValueError"
says = "no"
step = "do"
"""


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[[known]", "exceptions.toml"),
        ("[known]", "[[known]]"),
        ("[[other]]", "other"),
        ("[[known]]\ntype = 'E'\nsays = 'x'", "entry 1: step is missing"),
        (ENTRY + "[[known]]\nstep = 'x'", "entry 2: type is missing"),
        (ENTRY + "txet = 'x'", "txet"),
        (ENTRY + "text = 5", "text must be a string"),
        (ENTRY + "text = '('", "entry 1, text"),
        (ENTRY.replace("do", "do {this}"), "unknown placeholder this"),
        (ENTRY + "source = '{that}'", "unknown placeholder that"),
        (ENTRY + "replace = 'x'", "replace must be"),
        (ENTRY + "replace = ['(', 'x']", "entry 1, replace"),
        (ENTRY + "look_up = 'none'", "[words.none]"),
        (ENTRY + "edits = 'x'", "edits must be a list"),
        (ENTRY + "edits = [{ up = '1' }]", "above and code"),
        (ENTRY + "edits = [{ top = 1 }]", "must be strings"),
        (ENTRY + "edits = [{ rewritten = 'none' }]", "rewritten must be one of"),
        (ENTRY + "edits = [{ every = ['('] }]", "replace must be"),
        (ENTRY + "edits = [{ top = 'import {that}' }]", "unknown placeholder that"),
        (ENTRY + "example = [{ raised = 'ValueError' }]", "step"),
    ],
)
def test_a_broken_table_says_what_is_wrong(text: str, words: str) -> None:
    with pytest.raises(TableError) as error:
        parse(text)
    assert words in str(error.value)


def test_a_missing_table(tmp_path: Path) -> None:
    with pytest.raises(TableError, match=r"none\.toml"):
        load(tmp_path / "none.toml")


def step_of(text: str, example: Example) -> str:
    """The step that this table gives for the example, or ''."""
    found = explain(raised_in(example), parse(text), cause=OWN)
    return found.hint if found else ""


def test_every_pattern_must_match() -> None:
    table = ENTRY + "text = '(?P<what>b.d)'\nline = 'self'\nsource = '{what} = '\nwithout = 'good'\nat = 'rclpy/'"
    right = Example("my.ValueError: a bad one", "", line="self.x()", source="\nbad = 1", at="/lib/rclpy/node.py, spin")
    assert step_of(table, right) == "do"
    for wrong in (
        replace(right, raised="TypeError: a bad one"),
        replace(right, raised="ValueError: a good one"),
        replace(right, line="other()"),
        replace(right, source="bod = 1"),
        replace(right, source="bad = 1\ngood = 2"),
        replace(right, at="/lib/other/node.py, spin"),
    ):
        assert step_of(table, wrong) == ""


def test_the_cause_names_the_line_and_its_consequence() -> None:
    example = Example("ValueError: 5", "", line="int(x)")
    found = explain(raised_in(example), parse(ENTRY), cause=OWN, after="; then it ended")
    assert str(found) == f"{OWN}: ValueError: 5 (node.py, line 1: int(x)); then it ended: no"


def test_the_entries_of_a_check_take_precedence() -> None:
    crashed = trace(err=crash("raise ValueError('rate')"), exit=exited(1))
    (own,) = parse(ENTRY)
    found = diagnose_process(replace(crashed, exceptions=(own,)))
    assert found is not None
    assert found.hint == "do"
    assert diagnose_process(crashed) != found


def test_an_entry_that_needs_a_line_does_not_match_without_one() -> None:
    assert step_of(ENTRY.replace("do", "fix line {number}"), Example("ValueError: 5", "")) == ""


def test_the_table_has_its_expected_size() -> None:
    assert len(load_shipped(validate=True)) >= 100
    assert len(EXAMPLES) >= 80


def test_an_unchanged_line_is_not_a_step() -> None:
    table = ENTRY.replace("do", "line {number} becomes: {becomes}") + "replace = ['int', 'int']"
    assert step_of(table, Example("ValueError: 5", "", line="int(x)")) == ""


def test_the_step_for_an_unknown_exception_quotes_python_and_not_the_line() -> None:
    found = diagnose_process(trace(err=crash("def f(): raise_it\nx = 1\nx.y = 5"), exit=exited(1)))
    assert found is not None
    assert "in line 3 of node.py, change what Python complains of there: AttributeError: 'int'" in found.hint
    assert "x.y = 5" not in found.hint
    assert "x.y = 5" in found.text


@pytest.mark.parametrize("entry", load_shipped(), ids=lambda entry: entry.says[:40])
def test_no_semicolon_follows_a_line_of_code(entry: KnownException) -> None:
    assert "{becomes};" not in entry.step


SOURCE = """import rclpy
from rclpy.node import Node


class N(Node):
    def __init__(self):
        super().__init__('n')
        with open('a') as file:
            self.first = (1,
                2)
        self.tick()

    def tick(self):
        self.count += 1
"""


@pytest.mark.parametrize(
    ("edits", "step"),
    {
        "a line": ("[{ line = '11', becomes = 'pass' }]", "line 11 becomes: pass"),
        "above a statement of two lines": (
            "[{ above = '10', code = 'x = 1' }]",
            "write above line 9, with the same indentation: x = 1",
        ),
        "below it": ("[{ below = '9', code = 'x = 1' }]", "write below line 10, with the indentation of line 9: x = 1"),
        "removed": ("[{ removed = '9' }]", "lines 9 to 10 become: pass"),
        "moved": (
            "[{ moved = '10', above = '7' }]",
            "write above line 7, with the same indentation:\n    self.first = (1,\n        2)\n"
            "lines 9 to 10 become: pass",
        ),
        "at the end": (
            "[{ function = '__init__', end = 'self.count = 0' }]",
            "write below line 11, with the same indentation: self.count = 0",
        ),
        "unwrapped": (
            "[{ unwrapped = '8', becomes = 'file = 1' }]",
            "lines 8 to 10 become:\n    file = 1\n    self.first = (1,\n        2)",
        ),
        "async": ("[{ async = '14' }]", "line 13 becomes: async def tick(self):"),
        "every": ("[{ every = ['self.tick', 'self.tock'] }]", "do"),  # there is no tock
        "imported": ("[{ top = 'import time' }]", "at the top of the file: import time"),
        "the first way that is sound": (
            "[[{ line = '14', becomes = '(' }], [{ line = '14', becomes = 'x' }], [{ line = '14', becomes = 'pass' }]]",
            "line 14 becomes: pass",
        ),
        "no such line": ("[{ removed = '99' }]", "do"),
        "no such function": ("[{ function = 'other', end = 'x = 1' }]", "do"),
    }.values(),
)
def test_a_step_is_given_as_edits_if_they_leave_the_file_valid(edits: str, step: str) -> None:
    example = Example("ValueError: 5", "", line="self.count += 1", source=SOURCE)
    assert step_of(f"{ENTRY}edits = {edits}", example) == step


# Searches stdin for each pattern of the tables given, with every placeholder filled in.
SEARCH = """
import re, sys
from pathlib import Path
from tutor.judge.exceptions import load, load_shipped
text = sys.stdin.read()
for known in (*load_shipped(), *(entry for path in sys.argv[1:] for entry in load(Path(path)))):
    for pattern in filter(None, (known.source, known.without)):
        re.search(re.sub(r"\\{[a-z_]+\\}", "name", pattern), text, re.MULTILINE)
"""


def test_no_pattern_takes_forever_on_a_long_callback() -> None:
    lines = [f"{' ' * (8 + 4 * (i % 5))}name = self.name(request.a, 'name') if {i} else name" for i in range(120)]
    head = ["class Server(Node):", "    def name(self, request, response):"]
    text = "\n".join([*head, *lines, "        return name, response", ""])
    tables = map(str, sorted((Path(__file__).parents[2] / "checks").glob("*/exceptions.toml")))
    # In a process of its own: nothing interrupts a search.
    subprocess.run([sys.executable, "-c", SEARCH, *tables], input=text, text=True, timeout=60, check=True)
