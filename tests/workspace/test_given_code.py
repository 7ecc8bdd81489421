"""Whether a learner has rewritten the code that the skeleton gives."""

from __future__ import annotations

from pathlib import Path

import pytest

from tutor.content import load_course
from tutor.judge.submission import Submission
from tutor.workspace import solution
from tutor.workspace.given_code import given_criteria, is_still_given

COURSE = load_course()
SKELETON = COURSE.find("i1.1").files[0].skeleton.read_text()
MAIN = SKELETON[SKELETON.index("def main") :]


def still_given(text: str) -> bool:
    return is_still_given("main", SKELETON.encode(), text.encode())


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {
            "TemperaturePublisher": "Thermometer",
            "    node = ": "    sensor = ",
            "(node)": "(sensor)",
            " node.d": " sensor.d",
        },
        {"Run the node until Ctrl+C. This part is complete.": "Run.", "        pass\n": "        pass  # the end\n"},
        {"main()": "run()"},
        {"    rclpy.init()\n": '    rclpy.init()\n    print("hello")\n'},
        {"        pass\n": '        print("bye")\n'},
        {"        node.destroy_node()\n": "        if node is not None:\n            node.destroy_node()\n"},
        {"rclpy.spin(node)": "rclpy.spin(node, executor=None)"},
        {"(KeyboardInterrupt, ExternalShutdownException)": "(\n  KeyboardInterrupt, ExternalShutdownException,\n)"},
    ],
)
def test_names_comments_and_additions_leave_it_as_given(changes: dict[str, str]) -> None:
    text = SKELETON
    for old, new in changes.items():
        assert old in text
        text = text.replace(old, new)
    assert still_given(text)


@pytest.mark.parametrize(
    "main",
    [
        "def main():\n    rclpy.init()\n    rclpy.spin(TemperaturePublisher())\n",
        MAIN.replace("        node.destroy_node()\n", ""),
        MAIN.replace("(KeyboardInterrupt, ExternalShutdownException)", "KeyboardInterrupt"),
        MAIN.replace("rclpy.try_shutdown()", "if rclpy.ok():\n            rclpy.shutdown()"),
        "with suppress(KeyboardInterrupt, ExternalShutdownException), rclpy.init() as context:\n    run(context)\n",
    ],
)
def test_another_ending_is_the_learners_own(main: str) -> None:
    assert not still_given(SKELETON.replace(MAIN, main))


def test_a_file_that_python_cannot_read_has_nothing_of_its_own() -> None:
    assert still_given(SKELETON + "(")
    assert still_given("\0")


def test_of_a_function_without_try_every_statement_counts() -> None:
    skeleton = b"def beep():\n    print('beep')\n    wait(1)\n"
    assert is_still_given("beep", skeleton, b"def beep():\n    print('beep')\n    wait(1)\n    wait(2)\n")
    assert not is_still_given("beep", skeleton, b"def beep():\n    print('boop')\n    wait(1)\n")


@pytest.mark.parametrize("exercise", ["i1.1", "i1.2", "i1.3", "i2.1"])
def test_a_skeletons_shutdown_is_given(exercise: str) -> None:
    lesson = COURSE.find(exercise)
    skeleton = Submission(exercise, {file.name: file.skeleton for file in lesson.files})
    assert given_criteria(lesson, skeleton) == ("shutdown",)


def test_i2_3_gives_nothing() -> None:
    lesson = COURSE.find("i2.3")
    assert given_criteria(lesson, solution(lesson)) == ()


def test_a_missing_file_has_nothing_of_its_own(tmp_path: Path) -> None:
    lesson = COURSE.find("i1.3")
    name = lesson.files[0].name
    assert given_criteria(lesson, Submission("i1.3", {name: tmp_path / name})) == ("shutdown",)
    assert given_criteria(lesson, Submission("i1.3", {})) == ("shutdown",)
