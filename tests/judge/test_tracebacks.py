"""Parsing tracebacks in the output of a process."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.checks.builders import CRASH, FOLDER, lines, trace
from tests.judge.crashes import OWN, crash
from tutor.judge.trace import OutputLine
from tutor.judge.tracebacks import (
    Frame,
    called_by_executor,
    dumped_frames,
    find_tracebacks,
    last_traceback,
    lines_without_tracebacks,
    own_frame,
)

CALLS = """\
def tick():
    return 1 / 0

def main():
    tick()

main()
"""
HEADER = "Traceback (most recent call last):"


def test_an_exception_is_parsed_completely() -> None:
    (found,) = find_tracebacks(lines(crash(CALLS)))
    assert (found.type, found.message) == ("ZeroDivisionError", "division by zero")
    assert found.raised == "ZeroDivisionError: division by zero"
    assert [(frame.line, frame.function, frame.code) for frame in found.frames] == [
        (7, "<module>", "main()"),
        (5, "main", "tick()"),
        (2, "tick", "return 1 / 0"),
    ]
    assert not found.ignored


@pytest.mark.parametrize(
    ("source", "type_name", "message"),
    [
        ("raise KeyboardInterrupt", "KeyboardInterrupt", ""),
        ("assert 1 == 2", "AssertionError", ""),
        ("raise ValueError('')", "ValueError", ""),
        ("raise ValueError('a\\nb: c\\n  File \"x\", line 1, in y')", "ValueError", "a"),
        ("class Odd(Exception): pass\nraise Odd('o: o')", "Odd", "o: o"),
        ("def f():\n  class Odd(Exception): pass\n  raise Odd(1)\nf()", "f.<locals>.Odd", "1"),
        ("class É(Exception): pass\nraise É('ü')", "É", "ü"),
        (
            "import os.path.nothing",
            "ModuleNotFoundError",
            "No module named 'os.path.nothing'; 'os.path' is not a package",
        ),
        ("def f(n): return f(n + 1)\nf(0)", "RecursionError", "maximum recursion depth exceeded"),
        ("e = ValueError('x'); e.add_note('a note: long'); raise e", "ValueError", "x"),
    ],
)
def test_type_and_message_of_an_exception(source: str, type_name: str, message: str) -> None:
    found = find_tracebacks(lines(crash(source)))[0]
    assert (found.type.removeprefix("__main__."), found.message) == (type_name, message)


@pytest.mark.parametrize(
    ("source", "type_name", "line"),
    [
        ("x = 1\nif x\n  pass", "SyntaxError", 2),
        ("def f():\npass", "IndentationError", 2),
        ("if 1:\n\tx\n        y", "TabError", 3),
        ("print('abc", "SyntaxError", 1),
    ],
)
def test_a_syntax_error_of_the_main_file_has_no_header(source: str, type_name: str, line: int) -> None:
    text = crash(source)
    assert HEADER not in text
    (found,) = find_tracebacks(lines(text))
    assert found.type == type_name
    assert found.own(FOLDER) == found.frames[-1]
    assert (found.frames[-1].line, found.frames[-1].function) == (line, "")


def test_a_syntax_error_in_a_helper_module_is_at_the_helpers_line() -> None:
    text = f"""{HEADER}
  File "{OWN}", line 1, in <module>
    import helper
  File "{FOLDER}/helper.py", line 3
    def f(:
          ^
SyntaxError: invalid syntax"""
    (found,) = find_tracebacks(lines(text))
    assert str(found.own(FOLDER)) == "helper.py, line 3: def f(:"


@pytest.mark.parametrize(
    ("how", "types"),
    [
        ("raise RuntimeError('two') from error", ["ZeroDivisionError", "RuntimeError"]),
        ("raise RuntimeError('two')", ["ZeroDivisionError", "RuntimeError"]),
        ("raise RuntimeError('two') from None", ["RuntimeError"]),
    ],
)
def test_chained_exceptions_are_found_in_order(how: str, types: list[str]) -> None:
    text = crash(f"try:\n    1 / 0\nexcept ZeroDivisionError as error:\n    {how}\n")
    found = find_tracebacks(lines(text))
    assert [each.type for each in found] == types
    assert [[frame.line for frame in each.frames] for each in found][-1] == [4]
    assert last_traceback(trace(err=text)) == found[-1]


def test_an_exception_knows_what_it_followed() -> None:
    (first, second) = find_tracebacks(
        lines(crash("try:\n    1 / 0\nexcept ZeroDivisionError:\n    raise RuntimeError('two')\n"))
    )
    assert (first.follows, second.follows, second.origin) == (None, first, first)
    alone = find_tracebacks(lines(f"{CRASH}\n{CRASH}"))
    assert [each.follows for each in alone] == [None, None]


GROUP = """\
def work(kind):
    raise kind("no")

found = []
for kind in (ValueError, KeyError):
    try:
        work(kind)
    except Exception as error:
        found.append(error)
raise ExceptionGroup("many", [found[0], ExceptionGroup("more", [found[1]])])
"""


def test_an_exception_group_is_parsed_into_its_members() -> None:
    found = find_tracebacks(lines(f"before\n{crash(GROUP)}\nafter\n| a table |"))
    assert [each.raised for each in found] == [
        "ExceptionGroup: many (2 sub-exceptions)",
        "ValueError: no",
        "KeyError: 'no'",
    ]
    mine = found[-1].own(FOLDER)
    assert mine is not None
    assert (mine.line, mine.code) == (2, 'raise kind("no")')
    assert "| a table |" in lines_without_tracebacks(lines(f"{crash(GROUP)}\n| a table |"))
    assert not [line for line in lines_without_tracebacks(lines(crash(GROUP))) if "raise kind" in line]


def test_callbacks_called_by_an_executor() -> None:
    callback, main = Frame(f"{FOLDER}/node.py", 3, "tick", ""), Frame(f"{FOLDER}/node.py", 9, "main", "")
    spin = Frame("/lib/rclpy/executors.py", 5, "spin", "")
    assert called_by_executor((callback, spin, main), FOLDER)
    assert not called_by_executor((spin, main), FOLDER)
    assert not called_by_executor((callback, main), FOLDER)
    assert not called_by_executor((), FOLDER)


def test_an_exception_in_a_thread() -> None:
    (found,) = find_tracebacks(lines(f"Exception in thread Thread-1 (work):\n{CRASH}"))
    assert (found.type, found.ignored) == ("AttributeError", False)


IGNORED = (
    f"Exception ignored in: <function Node.__del__ at 0x7f0>\n{crash('raise ValueError(1)', '/lib/rclpy/node.py')}"
)


def test_an_ignored_exception_is_marked() -> None:
    found = find_tracebacks(lines(f"{IGNORED}\n{CRASH}\n{IGNORED}"))
    assert [each.ignored for each in found] == [True, False, True]


def test_an_exception_at_exit_is_marked() -> None:
    at_exit = IGNORED.replace("in: <function Node.__del__", "in atexit callback: <function goodbye")
    found = find_tracebacks(lines(f"{IGNORED}\n{at_exit}\n{CRASH}"))
    assert [(each.ignored, each.at_exit) for each in found] == [(True, False), (True, True), (False, False)]


def test_an_exception_without_header_after_an_ignored_one_is_not_ignored() -> None:
    assert [each.ignored for each in find_tracebacks(lines(f"{IGNORED}\n{crash('if x')}"))] == [True, False]


def test_the_last_traceback_is_not_an_ignored_one_if_there_is_another() -> None:
    # What rclpy's objects write at interpreter shutdown comes after the crash, and is of no interest.
    found = last_traceback(trace(err=f"{CRASH}\n{IGNORED}"))
    assert found is not None
    assert found.type == "AttributeError"
    only = last_traceback(trace(err=IGNORED))
    assert only is not None
    assert only.ignored


def test_own_is_the_innermost_of_the_learners_frames() -> None:
    frames = (
        Frame(f"{FOLDER}/node.py", 1, "main", ""),
        Frame(f"{FOLDER}/helper/more.py", 2, "help", ""),
        Frame(f"{FOLDER}/.venv/lib/python3.12/site-packages/rclpy/node.py", 3, "spin", ""),
        Frame("/usr/lib/python3.12/threading.py", 4, "run", ""),
    )
    text = "\n".join(f'  File "{f.path}", line {f.line}, in {f.function}\n    code' for f in frames)
    (found,) = find_tracebacks(lines(f"{HEADER}\n{text}\nValueError: x"))
    for folder in (FOLDER, FOLDER + "/"):
        mine = found.own(folder)
        assert mine is not None
        assert mine.line == 2
    assert found.own("/home/me/w") is None
    assert found.own("") is None
    assert own_frame(reversed(frames), FOLDER) == frames[1]
    assert own_frame((), FOLDER) is None


@pytest.mark.process
@pytest.mark.parametrize(
    ("source", "raised"),
    [
        (b"x = 1\ny = '\xff'\n", "SyntaxError: Non-UTF-8 code"),
        ("x = 1\n".encode("utf-16"), "SyntaxError: Non-UTF-8 code"),
        (b"# coding: no-such\n", "SyntaxError: encoding problem: no-such"),
        (b"x = str('')" + b".strip()" * 100_000, "RecursionError: maximum recursion depth exceeded during compilation"),
        (b"x = " + b"-" * 100_000 + b"1", "MemoryError: Parser stack overflowed"),
        (b"\0", "SyntaxError: source code cannot contain null bytes"),
    ],
)
def test_a_file_that_python_cannot_compile(source: bytes, raised: str, tmp_path: Path) -> None:
    path = tmp_path / "node.py"
    path.write_bytes(source)
    found = find_tracebacks(lines(subprocess.run([sys.executable, path], capture_output=True, text=True).stderr))
    assert len(found) == 1
    assert found[0].raised.startswith(raised)
    assert not found[0].frames or found[0].own(str(tmp_path)) == found[0].frames[0]


def test_a_stack_dump_of_all_threads() -> None:
    text = f"""Fatal Python error: Aborted

Thread 0x00007f1 (most recent call first):
  File "/usr/lib/python3.12/threading.py", line 359 in wait
  File "{FOLDER}/node.py", line 20 in <module>

Current thread 0x00007f2 (most recent call first):
  File "{FOLDER}/node.py", line 12 in tick
"""
    frames = dumped_frames(lines(text))
    assert [(f.path.rpartition("/")[2], f.line, f.function) for f in frames] == [
        ("threading.py", 359, "wait"),
        ("node.py", 20, "<module>"),
        ("node.py", 12, "tick"),
    ]
    assert dumped_frames(lines(text, "stdout")) == ()
    assert find_tracebacks(lines(text)) == ()  # a dump is not an exception
    assert dumped_frames(lines(CRASH)) == ()


def test_only_stderr_counts() -> None:
    assert find_tracebacks(lines(CRASH, "stdout")) == ()


def test_colours_do_not_hide_a_traceback() -> None:
    def coloured(text: str) -> str:
        return "\n".join(f"\x1b[1;31m{line}\x1b[0m" if line else line for line in text.split("\n"))

    assert find_tracebacks(lines(coloured(CRASH))) == find_tracebacks(lines(CRASH))
    assert find_tracebacks(lines(f"\x1b[33m[WARN] [1.5] [node]: hot\x1b[0m\n{CRASH}")) == find_tracebacks(lines(CRASH))


@given(st.integers(0, CRASH.count("\n")), st.sampled_from(["[INFO] [1.5] [node]: tick 3", "[node]: a: b", "", "=> 3"]))
def test_a_log_line_in_the_middle_does_not_hide_a_traceback(where: int, text: str) -> None:
    # A log message of another thread may come between any two lines that Python writes.
    crash_lines = CRASH.split("\n")
    (found,) = find_tracebacks(lines("\n".join([*crash_lines[:where], text, *crash_lines[where:]])))
    assert found.type == "AttributeError"


ordinary = st.sampled_from(
    [
        "[INFO] [1763716000.125] [node]: 23.5 °C",
        "[ERROR] [1763716000.125] [node]: division by zero",
        "done: yes",
        "ValueError: only printed",
        "   indented: text",
        "",
        "File node.py, line 3",
        "^^^^",
    ]
)


@given(st.lists(ordinary))
def test_ordinary_output_is_not_a_traceback(text: list[str]) -> None:
    output = lines("\n".join(text))
    assert find_tracebacks(output) == ()
    assert list(lines_without_tracebacks(output)) == [line.text for line in output]


@given(st.lists(ordinary), st.lists(ordinary))
def test_surrounding_output_does_not_change_a_traceback(before: list[str], after: list[str]) -> None:
    text = "\n".join([*before, CRASH, *after])
    assert find_tracebacks(lines(text)) == find_tracebacks(lines(CRASH))


@given(st.lists(st.builds(OutputLine, st.sampled_from(["stdout", "stderr"]), st.text(), st.just(0.0))))
def test_any_output_can_be_parsed(output: list[OutputLine]) -> None:
    find_tracebacks(output)
    dumped_frames(output)
    assert len(lines_without_tracebacks(output)) <= len(output)


def test_lines_without_tracebacks_keep_the_exception_and_drop_the_source() -> None:
    source = "publish_rate = 0.0\nraise ValueError('publish_rate is bad')"
    text = "before\n" + crash(source) + "after\n  indented"
    assert lines_without_tracebacks(lines(text)) == ("before", "ValueError: publish_rate is bad", "after", "  indented")
    assert lines_without_tracebacks(lines("publish_rate", "stdout")) == ("publish_rate",)


def test_a_traceback_interleaved_with_the_other_stream_is_found_once() -> None:
    mixed = [line for pair in zip(lines(CRASH), lines(CRASH, "stdout"), strict=True) for line in pair]
    assert len(find_tracebacks(mixed)) == 1


def test_lines_without_tracebacks_drop_the_link_between_chained_exceptions() -> None:
    chain = "During handling of the above exception, another exception occurred:"
    one = 'Traceback (most recent call last):\n  File "/a/node.py", line 1, in main\n    spin()\nKeyboardInterrupt'
    assert lines_without_tracebacks(lines(f"{one}\n\n{chain}\n\n{one}")) == (
        "KeyboardInterrupt",
        "",
        "",
        "KeyboardInterrupt",
    )
