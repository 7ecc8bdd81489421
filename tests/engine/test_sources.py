"""Which of a learner's files the diagnosis reads."""

from __future__ import annotations

import os
import time
from pathlib import Path

import pytest

from tutor.engine.source import add_source_lines, launch_arguments, read_sources, uncalled_main
from tutor.judge.tracebacks import Frame


def test_files_named_in_a_launch_file_are_read(tmp_path: Path) -> None:
    (tmp_path / "my_launch.py").write_text(
        "import helper\n\n\ndef generate_launch_description():\n"
        "    return [Node(package='my_package', executable='speaker'), include('more.launch.py')]\n"
    )
    for name in ("helper", "speaker", "more.launch", "other"):
        (tmp_path / f"{name}.py").write_text("x = 'other'\n")
    assert set(read_sources(tmp_path / "my_launch.py")) == {"my_launch.py", "helper.py", "speaker.py", "more.launch.py"}


def test_files_whose_names_a_launch_file_puts_together_are_read(tmp_path: Path) -> None:
    (tmp_path / "my_launch.py").write_text(
        "def generate_launch_description():\n    return [start('my_' + role + '_node.py') for role in ('pub', 'sub')]\n"
    )
    for name in ("my_pub_node", "my_sub_node", "other"):
        (tmp_path / f"{name}.py").write_text("x = 1\n")
    assert set(read_sources(tmp_path / "my_launch.py")) == {"my_launch.py", "my_pub_node.py", "my_sub_node.py"}


def test_a_string_in_a_node_is_not_taken_as_a_file_name(tmp_path: Path) -> None:
    (tmp_path / "talker.py").write_text("topic = 'chatter'\n")
    (tmp_path / "chatter.py").write_text("x = 1\n")
    assert set(read_sources(tmp_path / "talker.py")) == {"talker.py"}


REFUSED = {
    "null bytes": b"x = '\0'\n",
    "not UTF-8": b"x = '\xff'\n",
    "no such encoding": b"# coding: no-such\nx = 1\n",
    "an encoding of no text": b"# coding: rot13\nk = 1\n",
    "surrogates": b"# coding: unicode_escape\nx = '\\ud800'\n",
}
TOO_MUCH = {
    "9 MB": b"x = [\n" + b"    1,\n" * 1_300_000 + b"]\n",
    "one long line": b"x = '" + b"x" * 10_000 + b"'\n",
    "chained calls": b"def main():\n    str('')" + b".strip()" * 200 + b"\n",
    "chained calls on lines": b"x = (str('')\n" + b"    .strip()\n" * 400 + b")\n",
    "signs": b"x = " + b"-" * 1500 + b"1\n",
    "signs beyond the parser": b"x = (\n" + b"-\n" * 40_000 + b"1)\n",
    "elif": b"if 0:\n    pass\n" + b"elif 0:\n    pass\n" * 4000,
    "nested blocks": b"".join(b" " * i + b"if 1:\n" for i in range(98)) + b" " * 98 + b"x = a.b.c.d.e\n",
}


@pytest.mark.parametrize("source", [*REFUSED.values(), *TOO_MUCH.values()], ids=[*REFUSED, *TOO_MUCH])
def test_unparsable_or_excessive_sources_are_ignored_quickly(source: bytes, tmp_path: Path) -> None:
    path = tmp_path / "talker.py"
    path.write_bytes(source)
    began, found = time.process_time(), read_sources(path)
    assert uncalled_main(path) is False
    assert launch_arguments(path) == ()
    assert not found or source in REFUSED.values()
    assert time.process_time() - began < 2


def test_only_regular_files_are_read(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "talker.py")
    (tmp_path / "zero.py").symlink_to("/dev/zero")
    (tmp_path / "node.py").write_text("import talker, zero\n")
    assert set(read_sources(tmp_path / "node.py")) == {"node.py"}
    assert read_sources(tmp_path / "talker.py") == {}


def test_a_forged_dump_may_name_any_file(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "fifo")
    (tmp_path / "node.py").write_text("a = 1\nb = 2\n")
    (tmp_path / "binary").write_bytes(b"\xff" * 100)
    named = [tmp_path / "fifo", "/dev/zero", "/proc/kcore", tmp_path, tmp_path / "none", tmp_path / "binary", "\0"]
    frames = [Frame(str(path), 1, "f", "") for path in named]
    frames += [Frame(str(tmp_path / "node.py"), line, "f", "") for line in (0, 2, 3, 999_999_999)]
    frames += [Frame(f"/none/{n}", 1, "f", "") for n in range(100)]
    assert [frame.code for frame in add_source_lines(frames) if frame.code] == ["b = 2"]
