"""Which commands a lesson has, and when their output is as it shows."""

from __future__ import annotations

from tests.ros2cli.lesson_commands import Command, commands

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


def test_commands_may_take_several_lines() -> None:
    assert list(commands(LESSON)) == [
        Command("ros2 topic hz /chatter", ("average rate: 2.000",)),
        Command('ros2 topic pub --once /chatter \\\n    "{data: hi}"', ("...", "response: ok")),
        Command("for b in 1 2; do\n    echo $b\ndone", ()),
        Command("ros2 topic list   # all of them", ()),
    ]


def test_output_is_compared_line_by_line_but_for_what_varies() -> None:
    rate, call = list(commands(LESSON))[:2]
    assert rate.shows("average rate: 1.873\n\tmin: 0.1\n")
    assert not rate.shows("WARNING\naverage rate: 1.873\n")
    assert not rate.shows("average rate: none\n")
    assert call.shows("one\ntwo\nresponse: ok\n")
    assert not call.shows("one\nresponse: not ok\n")
    assert Command("x", ("failed: must be ...",)).shows("failed: must be above 0\n")
    assert not Command("x", ("sum=15",)).shows("sum=16\n")
