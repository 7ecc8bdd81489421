"""Extracting the commands from a lesson's text, and running them."""

from __future__ import annotations

from pathlib import Path

from tutor.session.shell import Shell
from tutor.tui.lesson_commands import command_at, commands_in
from tutor.tui.terminal.history import History

TEXT = """\
Text with `ros2 topic list`.

```python
ros2 = "no command"
```

```bash
ros2 topic list      # every topic
# only a remark
python3 node.py --ros-args \\
    -p rate:=5.0 \\
    -p name:='a # b'
```

```console
$ ros2 topic hz /chatter
average rate: 1.000
$ ros2 topic list
```
"""


def test_commands_come_from_shell_examples_only_and_each_is_joined_into_one_line() -> None:
    assert commands_in(TEXT) == (
        "ros2 topic list",
        "python3 node.py --ros-args -p rate:=5.0 -p name:='a # b'",
        "ros2 topic hz /chatter",
    )


def test_each_line_of_an_example_maps_to_its_command() -> None:
    example = "one \\\n  more\ntwo # why\n"
    assert [command_at(example, line) for line in range(4)] == ["one more", "one more", "two", ""]


def test_output_is_not_a_command() -> None:
    assert command_at("$ one\noutput\n", 1) == ""


def test_history_goes_back_and_returns_to_the_draft() -> None:
    history = History(["a", "b"])
    history.add("b")
    assert history.entries == ["a", "b"]
    assert [history.older("draft"), history.older("b"), history.older("a")] == ["b", "a", "a"]
    assert [history.newer("a"), history.newer("b"), history.newer("draft")] == ["b", "draft", "draft"]
    assert History().older("x") == "x"


def test_programs_run_unbuffered_but_launch_files_do_not() -> None:
    shell = Shell({}, Path("/"))
    assert shell.command("python3 node.py").env["PYTHONUNBUFFERED"] == "1"
    assert shell.command("ros2 run my_package talker").env["PYTHONUNBUFFERED"] == "1"
    assert "PYTHONUNBUFFERED" not in shell.command("ros2 launch my_package my_launch.py").env
