"""Extracting the commands from a lesson's text."""

from __future__ import annotations

from tutor.tui.lesson_commands import command_at, commands_in

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
