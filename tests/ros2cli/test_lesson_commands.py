"""Finding the commands of a lesson, and matching their output."""

from __future__ import annotations

from tests.ros2cli.lesson_commands import Command, find_commands

LESSON = """
```console
$ ros2 topic hz /chatter
average rate: 2.000
$ ros2 topic pub --once /chatter \\
    "{data: hi}"
...
response: ok
```
```bash
for b in 1 2; do
    echo $b
done
ros2 topic list   # all of them
```
```python
no = "command"
```
"""


def test_commands_may_span_several_lines() -> None:
    assert list(find_commands(LESSON)) == [
        Command("ros2 topic hz /chatter", ("average rate: 2.000",)),
        Command('ros2 topic pub --once /chatter \\\n    "{data: hi}"', ("...", "response: ok")),
        Command("for b in 1 2; do\n    echo $b\ndone", ()),
        Command("ros2 topic list   # all of them", ()),
    ]


def test_output_is_matched_line_by_line_apart_from_volatile_text() -> None:
    rate, call = list(find_commands(LESSON))[:2]
    assert rate.matches("average rate: 1.873\n\tmin: 0.1\n")
    assert not rate.matches("WARNING\naverage rate: 1.873\n")
    assert not rate.matches("average rate: none\n")
    assert call.matches("one\ntwo\nresponse: ok\n")
    assert not call.matches("one\nresponse: not ok\n")
    assert Command("x", ("failed: must be ...",)).matches("failed: must be above 0\n")
    assert not Command("x", ("sum=15",)).matches("sum=16\n")
