"""What is said of a bad definition: the file, the line and the reason."""

from __future__ import annotations

from pathlib import Path

import pytest

from tutor.interfaces.definitions import definition_of, problems_of


def _why_not(owner: str, name: str) -> str:
    known = {"": ["Ding"], "std_msgs": ["Header"]}
    return "" if name in known.get(owner, []) else f"no {owner}/{name}"


def _problems(folder: Path, text: str, name: str = "Bell.msg") -> list[tuple[int | None, str]]:
    file = folder / name
    file.write_text(text)
    return [(problem.line, problem.reason) for problem in problems_of("bell_interfaces", file, _why_not)]


@pytest.mark.parametrize(
    "text",
    [
        "",
        "# nothing\n",
        "float64 volume\n",
        'string name "a bell"   # a default\nuint8 LOUD=1\nuint8 loudness 1\n',
        "float64[3] position\nfloat64[] times\nstring<=10 name\nstring<=10[<=5] list\n",
        "std_msgs/Header header\nDing[] dings\n",
        "# a comment\n\n   # an indented one\nint32 count -3\nint32[] some [1, 2]\n",
        "string TEXT=a#b\n",
    ],
)
def test_a_good_message_has_no_problems(tmp_path: Path, text: str) -> None:
    assert _problems(tmp_path, text) == []


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("double volume", "there is no type double in a definition; it is float64"),
        ("float volume", "it is float32"),
        ("String name", "it is string"),
        ("Header header", "it is std_msgs/Header"),
        ("time stamp", "it is builtin_interfaces/Time"),
        ("flaot64 volume", "is it float64?"),
        ("float64", "followed by no name"),
        ("float64 Volume", "lower_snake_case"),
        ("float64 volume_", "lower_snake_case"),
        ("float64 from", "from is a keyword of Python"),
        ("int32 register", "register is a keyword of C++"),
        ("float64 volume;", "without a semicolon"),
        ("volume: float64", "its type, a space and its name"),
        ("float64 volume = 1.0", "with an =, the line is a constant"),
        ("  float64 volume", "is indented"),
        ("uint8 volume 300", "300"),
        ("std_msgs/msg/Header header", "without the folder: std_msgs/Header"),
        ("std_msgs/Headr header", "no std_msgs/Headr"),
        ("Dong dong", "no /Dong"),
        ("int32<=5 count", "only a string has a length"),
        ("float64[0] volume", "'float64[0]'"),
        ("---", "a message has only one part"),
        ("int32 a  # from 0 */ int x;", "a comment becomes one of C++"),
        ("# on\\", "a comment becomes one of C++"),
    ],
)
def test_a_bad_line_is_named_with_its_reason(tmp_path: Path, line: str, says: str) -> None:
    (number, reason), *others = _problems(tmp_path, f"# Rings.\nint32 count\n{line}\n")
    assert (number, others) == (3, [])
    assert says in reason


def test_a_name_twice_is_said_with_the_first_line(tmp_path: Path) -> None:
    assert _problems(tmp_path, "int32 a\nint32 b\nint32 a\n") == [(3, "the name a is already used in line 1")]


def test_each_part_of_a_service_has_names_of_its_own(tmp_path: Path) -> None:
    assert _problems(tmp_path, "int32 a\n---\nint32 a\n", "Ring.srv") == []


@pytest.mark.parametrize(("name", "text"), [("Ring.srv", "int32 a\n"), ("Ring.action", "int32 a\n---\nint32 b\n")])
def test_a_missing_separator_is_said(tmp_path: Path, name: str, text: str) -> None:
    ((_, reason),) = _problems(tmp_path, text, name)
    assert "---" in reason


def test_the_name_of_a_file_is_that_of_a_type(tmp_path: Path) -> None:
    assert _problems(tmp_path, "int32 a\n", "big_bell.msg") == [
        (None, "a type's name is in CamelCase, and so is its file's: BigBell.msg")
    ]


def test_a_definition_has_fields_and_neither_constants_nor_defaults(tmp_path: Path) -> None:
    file = tmp_path / "Ring.srv"
    file.write_text("# how\nuint8 LOUD=1\nuint8  loudness 1 # or 2\n---\nbool done\n")
    assert definition_of(file) == ("uint8 loudness", "---", "bool done")
