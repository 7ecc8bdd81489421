"""Filling messages from YAML."""

from __future__ import annotations

from typing import Any

import pytest
import yaml

from tutor.bundled_ros.ros2.yaml_input import message_from_yaml
from tutor.errors import CommandError
from tutor.ros.fields import set_fields
from tutor.ros.interfaces import find_interface


def parse_message(type_name: str, text: str) -> Any:
    message = find_interface(type_name, "msg")()
    set_fields(message, yaml.safe_load(text))
    return message


@pytest.mark.parametrize(
    ("type_name", "text", "field", "value"),
    [
        ("std_msgs/msg/String", "data: 5", "data", "5"),
        ("std_msgs/msg/Float64", "data: 1", "data", 1.0),
        ("std_msgs/msg/Int32", "data: 1.5", "data", 1),
        ("std_msgs/msg/Bool", "data: yes", "data", True),
        ("std_msgs/msg/Int32MultiArray", "data: [1, 2]", "data", [1, 2]),
        ("std_msgs/msg/Float64MultiArray", "data: [1, 2]", "data", [1.0, 2.0]),
        ("sensor_msgs/msg/JointState", "name: [a, b]", "name", ["a", "b"]),
    ],
)
def test_values_are_converted_to_the_type_of_the_field(type_name: str, text: str, field: str, value: object) -> None:
    found = getattr(parse_message(type_name, text), field)
    assert (list(found) if isinstance(value, list) else found) == value


def test_nested_messages_and_lists_of_them() -> None:
    twist = parse_message("geometry_msgs/msg/Twist", "{linear: {x: 2}, angular: {z: 1.8}}")
    assert (twist.linear.x, twist.linear.y, twist.angular.z) == (2.0, 0.0, 1.8)
    polygon = parse_message("geometry_msgs/msg/Polygon", "points: [{x: 1.0}, {y: 2}]")
    assert [(point.x, point.y) for point in polygon.points] == [(1.0, 0.0), (0.0, 2.0)]
    pose = parse_message("geometry_msgs/msg/PoseWithCovariance", f"covariance: {[0.5] * 36}")
    assert list(pose.covariance) == [0.5] * 36


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ("dat: hi", "'String' object has no attribute 'dat'"),
        ("hello", "Value 'hello' is expected to be a dictionary but is a str"),
        ("[1, 2]", "Value '[1, 2]' is expected to be a dictionary but is a list"),
    ],
)
def test_values_that_do_not_fit_are_reported(text: str, error: str) -> None:
    with pytest.raises((AttributeError, TypeError)) as caught:
        parse_message("std_msgs/msg/String", text)
    assert str(caught.value) == error


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ("{data: null}", "Value 'None' is expected to be a dictionary but is a NoneType"),
        ("{data: [1]}", "Value '[1]' is expected to be a dictionary but is a list"),
        ("{data: {x: 1}}", "'int' object has no attribute 'x'"),
        ("{data: ten}", "invalid literal for int() with base 10: 'ten'"),
    ],
)
def test_invalid_numbers_are_reported_as_by_rosidl_runtime_py(text: str, error: str) -> None:
    from std_msgs.msg import Int64

    with pytest.raises(CommandError) as caught:
        message_from_yaml(Int64, text, failed="Failed: {}")
    assert str(caught.value) == f"Failed: {error}"


def test_invalid_yaml_is_reported_in_one_line() -> None:
    from std_msgs.msg import Int64

    with pytest.raises(CommandError, match=r"^The passed value is not YAML: expected ',' or '}'.*$"):
        message_from_yaml(Int64, "{data: 1", failed="Failed: {}")
