"""Next steps as edits: their effect on a file, their wording, and that none is suggested that breaks it."""

from __future__ import annotations

import ast
import textwrap

import pytest

from tutor.judge import edits
from tutor.judge.edits import Edit
from tutor.judge.step_parsing import apply_step

TEXT = textwrap.dedent("""\
    from __future__ import annotations
    import rclpy
    from rclpy.node import Node


    class Counter(Node):
        def __init__(self):
            super().__init__("counter")
            self.count = 0

        def on_message(self, msg):
            self.count += 1
            self.get_logger().info(
                f"{self.count} messages")
            if self.count == 3:
                return
            self.rate = (self.count
                / 2)
    """)
LINES = TEXT.splitlines()


def _find_function(name: str) -> ast.FunctionDef:
    found = (each for each in ast.walk(ast.parse(TEXT)) if isinstance(each, ast.FunctionDef) and each.name == name)
    return next(found)


CASES = {
    "line": (edits.replace_lines(12, "self.count += 2"), "line 12 becomes: self.count += 2"),
    "lines": (
        edits.replace_lines(15, "if self.count == 3:\n    self.count = 0", 16),
        "lines 15 to 16 become:\n    if self.count == 3:\n        self.count = 0",
    ),
    "above": (
        edits.insert_above(16, "self.count = 0"),
        "write above line 16, with the same indentation: self.count = 0",
    ),
    "below": (edits.insert_below(12, "print()"), "write below line 12, with the same indentation: print()"),
    "inside": (edits.insert_into_block(15, "print()"), "write below line 15, four spaces deeper: print()"),
    "at the end": (
        edits.append_to_function(_find_function("on_message"), "print()"),
        "write below line 18, with the indentation of line 17: print()",
    ),
    "expression": (
        edits.replace_node(
            TEXT, next(each for each in ast.walk(ast.parse(TEXT)) if isinstance(each, ast.JoinedStr)), "'a'"
        ),
        "line 14 becomes: 'a')",
    ),
    "removed": (edits.remove_lines(TEXT, 12), "remove line 12: self.count += 1"),
    "removed alone in its block": (edits.remove_lines(TEXT, 16), "line 16 becomes: pass"),
    "import below __future__": (
        edits.add_import(TEXT, "import time")[0],
        "write below line 1, with the same indentation: import time",
    ),
}


@pytest.mark.parametrize(("edit", "words"), CASES.values(), ids=CASES)
def test_following_the_words_of_an_edit_gives_the_same_file(edit: Edit, words: str) -> None:
    assert edits.describe_edits(TEXT, edit) == words
    assert apply_step(words, {"counter.py": TEXT})["counter.py"] == edits.apply(TEXT, [edit])


def test_several_edits_use_the_line_numbers_of_the_original_file() -> None:
    several = [
        edits.replace_lines(9, "self.seen = 0"),
        edits.insert_below(12, "self.seen += 1"),
        *edits.add_import(TEXT, "import time"),
    ]
    words = edits.describe_edits(TEXT, several, file="counter.py")
    assert words is not None
    assert words.startswith("in counter.py, line 9 becomes: self.seen = 0\nwrite below line 12")
    assert apply_step(words, {"counter.py": TEXT, "other.py": ""})["counter.py"] == edits.apply(TEXT, several)
    ast.parse(edits.apply(TEXT, several))


def test_nothing_is_imported_twice() -> None:
    assert edits.add_import(TEXT, "import rclpy") == []
    assert edits.add_import("x = 1\n", "import time") == [Edit(1, 0, "import time")]


def test_the_only_line_of_a_function_is_replaced_by_pass() -> None:
    assert (
        edits.describe_edits("def f():\n    x()\n", edits.remove_lines("def f():\n    x()\n", 2))
        == "line 2 becomes: pass"
    )


@pytest.mark.parametrize(
    "edit",
    {
        "no Python": edits.replace_lines(12, "self.count +="),
        "a name that nothing sets": edits.replace_lines(12, "self.count += time.time()"),
        "an attribute that nothing sets": edits.replace_lines(12, "self.count += self.total"),
        "half of a statement": edits.replace_lines(13, "print()"),
        "no change": edits.replace_lines(12, "self.count  +=  1"),
    }.values(),
)
def test_a_step_that_breaks_the_file_or_changes_nothing_is_not_suggested(edit: Edit) -> None:
    assert edits.describe_edits(TEXT, edit) is None


def test_names_that_the_step_defines_may_be_used() -> None:
    step = edits.describe_edits(
        TEXT,
        edits.replace_lines(12, "self.count += time.time()"),
        edits.add_import(TEXT, "import time"),
        file="counter.py",
    )
    assert step is not None
    assert (
        edits.describe_edits(
            TEXT, edits.insert_below(9, "self.total = 0"), edits.replace_lines(12, "self.count += self.total")
        )
        is not None
    )
    assert edits.describe_edits(TEXT, edits.replace_lines(12, "self.get_logger().info('a')")) is not None


def test_a_name_that_was_already_undefined_does_not_suppress_the_step() -> None:
    text = "def f():\n    return unknown + self.other\n"
    assert edits.describe_edits(text, edits.replace_lines(2, "return unknown + self.other + 1")) is not None
