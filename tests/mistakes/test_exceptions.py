"""The tables of known exceptions: each way recognises its examples, and a broken table says what is wrong with it."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from tutor.errors import TableError
from tutor.judge.symptom import Symptom
from tutor.judge.trace import OutputLine, Trace
from tutor.judge.tracebacks import Frame, Traceback
from tutor.mistakes import CATALOGUE, Case, Catalogue
from tutor.mistakes.diagnosis import Diagnosis, why
from tutor.mistakes.exceptions import KnownException, add, from_example, load, parse
from tutor.mistakes.exceptions.known import Example, Way

ROOT = Path(__file__).parents[2]
TABLES = {path.name: load(path) for path in sorted((ROOT / "tutor/mistakes/exceptions").glob("*.toml"))}
EXAMPLES = [
    pytest.param(known, way, example, id=f"{known.id}: {example.raised[:50]} | {example.line[:30]}")
    for table in TABLES.values()
    for known in table
    for way in known.ways
    for example in way.examples
]


@pytest.mark.parametrize(("known", "way", "example"), EXAMPLES)
def test_each_example_is_recognised_by_its_own_way_first(known: KnownException, way: Way, example: Example) -> None:
    seen = from_example(example)("")
    told = why(seen, [CATALOGUE])
    assert told.mistake == known.id
    alone = Catalogue()
    add(alone, replace(known, ways=(way,)))
    assert why(seen, [alone]) == told, "another way of the same mistake comes first"
    assert not {"{says}", "{do}"} & {told.cause, told.step}
    assert not any(words in told.cause for words in ("incompatible function", "call argument", "ROS 1 message"))


def test_every_mistake_has_an_example() -> None:
    assert len(EXAMPLES) >= 150
    assert not [known.id for table in TABLES.values() for known in table if not known.ways[0].examples]


SEARCHES = r"""
import re, sys
from pathlib import Path
from tutor.mistakes.exceptions import load
from tutor.mistakes.exceptions.known import WORD

submissions = sorted((Path(path).read_text(errors="replace") for path in sys.argv[1:]), key=len)[-12:]
indented = [f"{' ' * (8 + 4 * (i % 5))}name = self.name(request.a, 'name') if {i} else name" for i in range(120)]
callback = "class Server(Node):\n    def name(self, request, response):\n" + "\n".join(indented) + "\n"
calls = ["class N(Node):\n" + "        x = f(a, b)\n\n" * 200, "f(a, " * 50 + "\n" + "    g(b)\n" * 100]
texts = [*submissions, callback, *calls]
tables = [load(path) for path in Path("tutor/mistakes/exceptions").glob("*.toml")]
ways = [way for table in tables for known in table for way in known.ways]
for pattern in sorted({pattern for way in ways for pattern in (way.source, way.without)}):
    for text in texts:
        names = re.findall(r"^class (\w+)", text, re.MULTILINE) or ["x"]
        for name in (names[-1], "name"):
            print(pattern, flush=True)
            re.search(WORD.sub(name, pattern), text, re.MULTILINE)
print("all searched")
"""


@pytest.mark.process
def test_no_pattern_takes_long_in_a_long_file() -> None:
    """A nested repetition that is ambiguous takes for ever where it does not match; nothing can interrupt it."""
    files = [str(path) for path in (ROOT / "tests/submissions").glob("*/*/*/*.py")]
    # A search runs in C, so that only the end of its process stops it.
    command = ["timeout", "60", sys.executable, "-c", SEARCHES, *files]
    searched = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False).stdout
    assert searched.splitlines()[-1] == "all searched"


ENTRY = """[[mistake]]
id = "broken-bell"
page = "A bell is broken."
says = "no"
do = "do"
[[mistake.when]]
type = "ValueError"
"""


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[[mistake]", "exceptions.toml"),
        ("[mistake]", "[[mistake]]"),
        ("[[other]]", "other"),
        ("[[mistake]]\npage = 'x'", "mistake 1: id is missing"),
        (ENTRY + "[[mistake]]\nid = 'x'", "mistake 2: page is missing"),
        (ENTRY.partition("[[mistake.when]]")[0], "mistake 1: when is missing"),
        (ENTRY.replace('do = "do"\n', ""), "(broken-bell), when 1: do is missing"),
        (ENTRY + "txet = 'x'", "txet"),
        (ENTRY + "text = 5", "text must be a string"),
        (ENTRY + "text = '('", "when 1, text"),
        (ENTRY.replace('"do"', '"do {this}"'), "unknown placeholder this"),
        (ENTRY + "source = '{that}'", "unknown placeholder that"),
        (ENTRY + "replace = 'x'", "replace must be"),
        (ENTRY + "replace = ['(', 'x']", "when 1, replace"),
        (ENTRY + "look_up = 'none'", "[words.none]"),
        (ENTRY + "edits = []", "unknown key edits"),
        (ENTRY + "example = [{ step = 'x' }]", "an example has raised"),
    ],
)
def test_a_broken_table_says_what_is_wrong(text: str, words: str) -> None:
    with pytest.raises(TableError) as error:
        parse(text)
    assert words in str(error.value)


def test_a_missing_table(tmp_path: Path) -> None:
    with pytest.raises(TableError, match=r"none\.toml"):
        load(tmp_path / "none.toml")


def told_by(table: str, example: Example) -> Diagnosis | None:
    """What this table alone says about an example."""
    catalogue = Catalogue()
    for known in parse(table):
        add(catalogue, known)
    try:
        return why(from_example(example)(""), [catalogue])
    except LookupError:
        return None


def test_every_pattern_must_match() -> None:
    table = ENTRY + "text = '(?P<what>b.d)'\nline = 'self'\nsource = '{what} = '\nwithout = 'good'\nat = 'rclpy/'"
    right = Example("my.ValueError: a bad one", "self.x()", "self.x()\nbad = 1", at="/lib/rclpy/node.py, spin")
    assert told_by(table, right) is not None
    for wrong in (
        replace(right, raised="TypeError: a bad one"),
        replace(right, raised="ValueError: a good one"),
        replace(right, line="other()"),
        replace(right, source="bod = 1"),
        replace(right, source="bad = 1\ngood = 2"),
        replace(right, at="/lib/other/node.py, spin"),
    ):
        assert told_by(table, wrong) is None


def test_the_cause_names_the_exception_and_the_line() -> None:
    found = told_by(ENTRY, Example("my.ValueError: 5", "int(x)"))
    assert found is not None
    assert found.cause == "broken bell: ValueError: 5 (node.py, line 1: int(x)): no"
    assert (found.step, found.file, found.line) == ("do", "node.py", 1)


def test_what_a_binding_adds_to_a_message_is_not_told() -> None:
    raised = "x.RCLError: no topic, at /project/src/publisher.cpp:145, at /project/src/rcl/publisher.c:117"
    found = told_by(ENTRY.replace("ValueError", "RCLError"), Example(raised, "f()"))
    assert found is not None
    assert "RCLError: no topic (node.py" in found.cause


def test_a_way_that_needs_a_line_does_not_match_without_one() -> None:
    assert told_by(ENTRY.replace('"do"', '"fix line {number}"'), Example("ValueError: 5")) is None


def test_an_unchanged_line_is_not_a_step() -> None:
    table = ENTRY.replace('"do"', '"write {becomes}"') + "replace = ['int', 'int']"
    assert told_by(table, Example("ValueError: 5", "int(x)")) is None


def test_the_root_of_a_chain_is_told_also_by_a_later_entry() -> None:
    """The first entry knows the last exception of the chain, a later one its origin."""
    lines = [
        "Traceback (most recent call last):",
        '  File "/ws/node.py", line 1, in f',
        "    await asyncio.sleep(1)",
        "RuntimeError: no running event loop",
        "",
        "During handling of the above exception, another exception occurred:",
        "",
        "Traceback (most recent call last):",
        '  File "/ws/node.py", line 2, in main',
        "    rclpy.shutdown()",
        "rclpy._rclpy_pybind11.RCLError: failed to shutdown: rcl_shutdown already called on the given context",
    ]
    output = tuple(OutputLine("stderr", line, 0.0) for line in lines)
    seen = Symptom.ENDED.seen(Trace("node.py", "/ws", sources={"node.py": "a\nb\n"}, output=output))
    found = why(seen, [CATALOGUE])
    assert found.mistake == "asyncio-in-a-callback"
    assert "; then RCLError" in found.cause


def test_the_traceback_that_the_criterion_has_chosen_comes_first() -> None:
    chosen = Traceback("EOFError", "EOF when reading a line", (Frame("/ws/node.py", 1, "f", "input()"),))
    seen = Symptom.ENDS_BADLY.seen(Trace("node.py", "/ws", sources={"node.py": "input()"}), raised=chosen)
    assert why(seen, [CATALOGUE]).mistake == "input-without-a-keyboard"


def test_an_unknown_exception_is_told_as_python_tells_it() -> None:
    seen = from_example(Example("AttributeError: 'int' object has no attribute 'y'", "x.y = 5"))("")
    found = why(seen, [CATALOGUE])
    assert found.mistake == "unhandled-exception"
    assert "'int' object has no attribute 'y' (node.py, line 1: x.y = 5)" in found.cause
    assert "x.y" not in found.step


def test_two_mistakes_of_one_name() -> None:
    catalogue = Catalogue()
    (known,) = parse(ENTRY)
    add(catalogue, known)
    with pytest.raises(ValueError, match="two mistakes"):
        add(catalogue, known)


def test_an_example_is_read_as_a_process_would_have_shown_it() -> None:
    case = Case(from_example(Example("ValueError: 5", "int(x)", "x = 1\nint(x)"))(""))
    (seen,) = case.exceptions
    assert (seen.name, seen.file) == ("ValueError", "node.py")
    assert seen.line is not None
    assert seen.line.line == 2
